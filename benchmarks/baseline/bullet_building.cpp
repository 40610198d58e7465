#include "bullet_building.h"

#include <BulletDynamics/ConstraintSolver/btNNCGConstraintSolver.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btLemkeSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <BulletDynamics/MLCPSolvers/btSolveProjectedGaussSeidel.h>

#include <cmath>
#include <stdexcept>

namespace baseline {

namespace {

btVector3 vector(const Vec3& v) { return {btScalar(v[0]), btScalar(v[1]), btScalar(v[2])}; }

btTransform start_of(const SceneBody& body) {
  const auto& q = body.orientation;
  const btQuaternion rotation{btScalar(q[1]), btScalar(q[2]), btScalar(q[3]), btScalar(q[0])};
  return btTransform(rotation, vector(body.centre));
}

std::unique_ptr<btMLCPSolverInterface> make_direct(const std::string& name) {
  if (name == "pgs") return std::make_unique<btSolveProjectedGaussSeidel>();
  if (name == "dantzig") return std::make_unique<btDantzigSolver>();
  if (name == "lemke") return std::make_unique<btLemkeSolver>();
  return nullptr;
}

}  // namespace

BulletBuilding::BulletBuilding(const Scene& scene, const Method& method)
    : scene_(scene), method_(method), dispatcher_(&configuration_), direct_(make_direct(method.solver)) {
  if (direct_) {
    auto mlcp = std::make_unique<btMLCPSolver>(direct_.get());
    mlcp_ = mlcp.get();
    solver_ = std::move(mlcp);
  } else if (method.solver == "nncg") {
    solver_ = std::make_unique<btNNCGConstraintSolver>();
  } else if (method.solver == "si") {
    solver_ = std::make_unique<btSequentialImpulseConstraintSolver>();
  } else {
    throw std::runtime_error("solver " + method.solver + "; accepted are si, nncg, pgs, dantzig, lemke, featherstone");
  }
  world_ = std::make_unique<btDiscreteDynamicsWorld>(&dispatcher_, &broadphase_, solver_.get(), &configuration_);
  world_->setGravity({0, 0, btScalar(-scene.gravity)});
  world_->getSolverInfo().m_numIterations = method.iterations;
  // Direct solvers want all constraints in one system, not in batches.
  if (direct_) world_->getSolverInfo().m_minimumSolverBatchSize = 1;
  for (const SceneBody& body : scene.bodies) add_body(body);
  feedback_.resize(scene.joints.size());
  at_solve_.resize(scene.bodies.size());
  forces_.resize(scene.joints.size());
  for (const SceneJoint& joint : scene.joints) add_joint(joint, method.compliance);
}

BulletBuilding::~BulletBuilding() {
  for (auto& joint : joints_) world_->removeConstraint(joint.get());
  for (auto& body : bodies_) world_->removeRigidBody(body.get());
}

void BulletBuilding::add_body(const SceneBody& body) {
  shapes_.push_back(std::make_unique<btBoxShape>(vector(body.half_extents)));
  btVector3 inertia;
  shapes_.back()->calculateLocalInertia(btScalar(body.mass), inertia);
  btRigidBody::btRigidBodyConstructionInfo info(btScalar(body.mass), nullptr, shapes_.back().get(), inertia);
  info.m_startWorldTransform = start_of(body);
  bodies_.push_back(std::make_unique<btRigidBody>(info));
  bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
  world_->addRigidBody(bodies_.back().get(), btBroadphaseProxy::DefaultFilter, 0);  // meets nothing: contacts are off
}

void BulletBuilding::add_joint(const SceneJoint& joint, double compliance) {
  btRigidBody& body = *bodies_[static_cast<std::size_t>(joint.body)];
  btRigidBody& other =
      joint.other < 0 ? btTypedConstraint::getFixedBody() : *bodies_[static_cast<std::size_t>(joint.other)];
  const btTransform frame(btQuaternion::getIdentity(), vector(joint.point));
  auto fixed = std::make_unique<btFixedConstraint>(body, other, body.getWorldTransform().inverse() * frame,
                                                   other.getWorldTransform().inverse() * frame);
  if (compliance > 0) {
    for (int axis = 0; axis < 6; ++axis) fixed->setParam(BT_CONSTRAINT_STOP_CFM, btScalar(compliance), axis);
  }
  fixed->setJointFeedback(&feedback_[joints_.size()]);
  world_->addConstraint(fixed.get(), true);
  joints_.push_back(std::move(fixed));
}

void BulletBuilding::step() {
  for (JointForce& force : forces_) force.fill(0);
  for (int i = 0; i < method_.substeps; ++i) {
    for (std::size_t b = 0; b < bodies_.size(); ++b) at_solve_[b] = bodies_[b]->getWorldTransform();
    push_bodies();
    world_->stepSimulation(btScalar(method_.step / method_.substeps), 0);
    gather_forces();
  }
  ++steps_;
}

void BulletBuilding::push_bodies() {
  for (const ScenePush& push : scene_.pushes) {
    btRigidBody& body = *bodies_[static_cast<std::size_t>(push.body)];
    const btVector3 at_rest =
        start_of(scene_.bodies[static_cast<std::size_t>(push.body)]).inverse() * vector(push.point);
    const btVector3 arm = body.getWorldTransform().getBasis() * at_rest;
    body.applyForce(vector(push.force) * btScalar(push_factor(steps_)), arm);
  }
}

void BulletBuilding::gather_forces() {
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const SceneJoint& joint = scene_.joints[j];
    const auto body = static_cast<std::size_t>(joint.body);
    // Bullet's torque is about the centre of mass; turn it about the joint's point, which went along with the body.
    const btTransform start(
        btQuaternion(btScalar(scene_.bodies[body].orientation[1]), btScalar(scene_.bodies[body].orientation[2]),
                     btScalar(scene_.bodies[body].orientation[3]), btScalar(scene_.bodies[body].orientation[0])),
        vector(scene_.bodies[body].centre));
    const btVector3 arm = at_solve_[body].getBasis() * (start.inverse() * vector(joint.point));
    const btVector3 force = feedback_[j].m_appliedForceBodyA;
    const btVector3 moment = feedback_[j].m_appliedTorqueBodyA - arm.cross(force);
    for (int c = 0; c < 3; ++c) {
      forces_[j][static_cast<std::size_t>(c)] += double(force[c]) / method_.substeps;
      forces_[j][static_cast<std::size_t>(c + 3)] += double(moment[c]) / method_.substeps;
    }
  }
}

std::vector<JointForce> BulletBuilding::joint_forces() const { return forces_; }

double BulletBuilding::mean_roof_sag() const {
  double sum = 0;
  for (const RoofPoint& roof : scene_.roof) {
    const auto body = static_cast<std::size_t>(roof.body);
    const btTransform start = start_of(scene_.bodies[body]);
    const btVector3 now = bodies_[body]->getWorldTransform() * (start.inverse() * vector(roof.point));
    sum += roof.point[2] - double(now.z());
  }
  return sum / static_cast<double>(scene_.roof.size());
}

int BulletBuilding::silent_fallbacks() const { return mlcp_ ? mlcp_->getNumFallbacks() : 0; }

}  // namespace baseline
