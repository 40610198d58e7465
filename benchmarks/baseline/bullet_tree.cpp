#include "bullet_tree.h"

#include <stdexcept>

namespace baseline {

namespace {

btVector3 vector(const Vec3& v) { return {btScalar(v[0]), btScalar(v[1]), btScalar(v[2])}; }

btQuaternion orientation(const SceneBody& body) {
  const auto& q = body.orientation;
  return {btScalar(q[1]), btScalar(q[2]), btScalar(q[3]), btScalar(q[0])};
}

}  // namespace

BulletTree::BulletTree(const Scene& scene, const Method& method)
    : scene_(scene),
      method_(method),
      dispatcher_(&configuration_),
      world_(&dispatcher_, &broadphase_, &solver_, &configuration_) {
  world_.setGravity({0, 0, btScalar(-scene.gravity)});
  world_.getSolverInfo().m_jointFeedbackInWorldSpace = true;
  grow_tree();
  add_links();
}

BulletTree::~BulletTree() { world_.removeMultiBody(tree_.get()); }

/// The first joint in the scene's order that reaches a body from what is already held.
void BulletTree::grow_tree() {
  link_of_body_.assign(scene_.bodies.size(), -1);
  for (bool grown = true; grown;) {
    grown = false;
    for (std::size_t j = 0; j < scene_.joints.size(); ++j) {
      const SceneJoint& joint = scene_.joints[j];
      const bool held = joint.other < 0 || link_of_body_[static_cast<std::size_t>(joint.other)] >= 0;
      int& link = link_of_body_[static_cast<std::size_t>(joint.body)];
      if (!held || link >= 0) continue;
      link = static_cast<int>(joint_of_link_.size());
      joint_of_link_.push_back(j);
      grown = true;
    }
  }
  for (const int link : link_of_body_) {
    if (link < 0) throw std::runtime_error("featherstone: a body does not hang on the ground by any chain of joints");
  }
}

void BulletTree::add_links() {
  const int links = static_cast<int>(joint_of_link_.size());
  tree_ = std::make_unique<btMultiBody>(links, btScalar(0), btVector3(0, 0, 0), true, false);
  feedback_.resize(joint_of_link_.size());
  for (int i = 0; i < links; ++i) {
    const SceneJoint& joint = scene_.joints[joint_of_link_[static_cast<std::size_t>(i)]];
    const SceneBody& body = scene_.bodies[static_cast<std::size_t>(joint.body)];
    const bool on_ground = joint.other < 0;
    const SceneBody* parent = on_ground ? nullptr : &scene_.bodies[static_cast<std::size_t>(joint.other)];
    const btQuaternion parent_turn = on_ground ? btQuaternion::getIdentity() : orientation(*parent);
    const btVector3 parent_centre = on_ground ? btVector3(0, 0, 0) : vector(parent->centre);
    const btBoxShape shape(vector(body.half_extents));
    btVector3 inertia;
    shape.calculateLocalInertia(btScalar(body.mass), inertia);
    const btVector3 to_pivot = quatRotate(parent_turn.inverse(), vector(joint.point) - parent_centre);
    const btVector3 to_centre = quatRotate(orientation(body).inverse(), vector(body.centre) - vector(joint.point));
    tree_->setupFixed(i, btScalar(body.mass), inertia,
                      on_ground ? -1 : link_of_body_[static_cast<std::size_t>(joint.other)],
                      orientation(body).inverse() * parent_turn, to_pivot, to_centre);
    tree_->getLink(i).m_jointFeedback = &feedback_[static_cast<std::size_t>(i)];
  }
  tree_->finalizeMultiDof();
  tree_->setLinearDamping(0);
  tree_->setAngularDamping(0);
  world_.addMultiBody(tree_.get());
}

void BulletTree::step() {
  for (int i = 0; i < method_.substeps; ++i) {
    push_links();
    world_.stepSimulation(btScalar(method_.step / method_.substeps), 0);
  }
  ++steps_;
}

void BulletTree::push_links() {
  for (const ScenePush& push : scene_.pushes) {
    const int link = link_of_body_[static_cast<std::size_t>(push.body)];
    const btVector3 force = vector(push.force) * btScalar(push_factor(steps_));
    const btVector3 arm = vector(push.point) - vector(scene_.bodies[static_cast<std::size_t>(push.body)].centre);
    tree_->addLinkForce(link, force);
    tree_->addLinkTorque(link, arm.cross(force));
  }
}

double BulletTree::mean_roof_sag() const {
  double sum = 0;
  for (const RoofPoint& roof : scene_.roof) {
    const auto body = static_cast<std::size_t>(roof.body);
    const btTransform start(orientation(scene_.bodies[body]), vector(scene_.bodies[body].centre));
    const btVector3 now =
        tree_->getLink(link_of_body_[body]).m_cachedWorldTransform * (start.inverse() * vector(roof.point));
    sum += roof.point[2] - double(now.z());
  }
  return sum / static_cast<double>(scene_.roof.size());
}

std::vector<JointForce> BulletTree::joint_forces() const {
  std::vector<JointForce> forces(scene_.joints.size());
  for (std::size_t i = 0; i < joint_of_link_.size(); ++i) {
    const SceneJoint& joint = scene_.joints[joint_of_link_[i]];
    const btSpatialForceVector& told = feedback_[i].m_reactionForces;
    // Bullet's force is in the top and its moment about the centre of mass in the bottom.
    const btVector3 force = told.m_topVec, centre = vector(scene_.bodies[static_cast<std::size_t>(joint.body)].centre);
    const btVector3 moment = told.m_bottomVec - (vector(joint.point) - centre).cross(force);
    for (int c = 0; c < 3; ++c) {
      forces[joint_of_link_[i]][static_cast<std::size_t>(c)] = double(force[c]);
      forces[joint_of_link_[i]][static_cast<std::size_t>(c + 3)] = double(moment[c]);
    }
  }
  return forces;
}

int BulletTree::joints_left_out() const {
  return static_cast<int>(scene_.joints.size()) - static_cast<int>(joint_of_link_.size());
}

}  // namespace baseline
