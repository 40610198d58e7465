// A moment of a collapse moved on by Bullet alone, as games do it: every part a rigid body, every joint that is left a
// fixed constraint, all with contacts, what lies still asleep. Prints bodies, joints, those awake after the steps, and
// the median milliseconds of a step.
//   bench_moment SCENE [--iterations N] [--steps N]
// Parts that are joined, at one remove or more, never meet: their boxes overlap where they are joined, and Bullet would
// push them apart. That saves it work as well.
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "scene.h"

namespace {

using namespace baseline;

btVector3 vector(const Vec3& v) { return {btScalar(v[0]), btScalar(v[1]), btScalar(v[2])}; }

/// Which joined-up part of the building each body belongs to: its lowest number.
std::vector<int> joined(const Scene& scene) {
  std::vector<int> root(scene.bodies.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int i) {
    while (root[static_cast<std::size_t>(i)] != i) i = root[static_cast<std::size_t>(i)];
    return i;
  };
  for (const SceneJoint& joint : scene.joints) {
    if (joint.other < 0) continue;
    const int a = find(joint.body), b = find(joint.other);
    root[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }
  for (std::size_t i = 0; i < root.size(); ++i) root[i] = find(static_cast<int>(i));
  return root;
}

struct ApartOnly : btOverlapFilterCallback {
  bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override {
    const auto part = [](btBroadphaseProxy* proxy) {
      return static_cast<btCollisionObject*>(proxy->m_clientObject)->getUserIndex();
    };
    return part(a) != part(b);
  }
};

class Moment {
 public:
  Moment(const Scene& scene, int iterations) {
    world_.setGravity({0, 0, btScalar(-scene.gravity)});
    world_.getSolverInfo().m_numIterations = iterations;
    world_.getPairCache()->setOverlapFilterCallback(&apart_only_);
    const std::vector<int> parts = joined(scene);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) add(scene.bodies[i], parts[i]);
    for (const SceneJoint& joint : scene.joints) add(joint);
    if (scene.has_ground) {
      shapes_.push_back(std::make_unique<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(scene.ground)));
      btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, shapes_.back().get());
      bodies_.push_back(std::make_unique<btRigidBody>(info));
      bodies_.back()->setUserIndex(-1);
      world_.addRigidBody(bodies_.back().get());
    }
  }
  ~Moment() {
    for (auto& joint : joints_) world_.removeConstraint(joint.get());
    for (auto& body : bodies_) world_.removeRigidBody(body.get());
  }
  Moment(const Moment&) = delete;
  Moment& operator=(const Moment&) = delete;

  void step(double seconds) { world_.stepSimulation(btScalar(seconds), 0); }
  [[nodiscard]] int awake() const {
    return static_cast<int>(std::count_if(
        bodies_.begin(), bodies_.end(), [](const auto& body) { return !body->isStaticObject() && body->isActive(); }));
  }

 private:
  void add(const SceneBody& body, int part) {
    if (body.ball) {
      shapes_.push_back(std::make_unique<btSphereShape>(btScalar(body.half_extents[0])));
    } else {
      shapes_.push_back(std::make_unique<btBoxShape>(vector(body.half_extents)));
    }
    btVector3 inertia;
    shapes_.back()->calculateLocalInertia(btScalar(body.mass), inertia);
    btRigidBody::btRigidBodyConstructionInfo info(btScalar(body.mass), nullptr, shapes_.back().get(), inertia);
    const auto& q = body.orientation;
    info.m_startWorldTransform =
        btTransform({btScalar(q[1]), btScalar(q[2]), btScalar(q[3]), btScalar(q[0])}, vector(body.centre));
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    btRigidBody& rigid = *bodies_.back();
    rigid.setUserIndex(part);
    rigid.setLinearVelocity(vector(body.velocity));
    rigid.setAngularVelocity(vector(body.spin));
    world_.addRigidBody(&rigid);
    if (body.asleep) rigid.forceActivationState(ISLAND_SLEEPING);
  }

  void add(const SceneJoint& joint) {
    btRigidBody& body = *bodies_[static_cast<std::size_t>(joint.body)];
    btRigidBody& other =
        joint.other < 0 ? btTypedConstraint::getFixedBody() : *bodies_[static_cast<std::size_t>(joint.other)];
    const btTransform frame(btQuaternion::getIdentity(), vector(joint.point));
    joints_.push_back(std::make_unique<btFixedConstraint>(body, other, body.getWorldTransform().inverse() * frame,
                                                          other.getWorldTransform().inverse() * frame));
    world_.addConstraint(joints_.back().get(), true);
  }

  ApartOnly apart_only_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btTypedConstraint>> joints_;
};

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc < 2) throw std::runtime_error("usage: bench_moment SCENE [--iterations N] [--steps N]");
    int iterations = 10, steps = 11;
    for (int i = 2; i + 1 < argc; i += 2) {
      if (std::strcmp(argv[i], "--iterations") == 0) {
        iterations = std::atoi(argv[i + 1]);
      } else if (std::strcmp(argv[i], "--steps") == 0) {
        steps = std::atoi(argv[i + 1]);
      } else {
        throw std::runtime_error(std::string("unknown option ") + argv[i]);
      }
    }
    if (iterations < 1 || steps < 1) throw std::runtime_error("iterations and steps must be above zero");
    std::ifstream file(argv[1]);
    if (!file) throw std::runtime_error(std::string(argv[1]) + ": cannot be read");
    const Scene scene = read_scene(file);
    Moment moment(scene, iterations);
    moment.step(1.0 / 60);  // finds the pairs that touch, from nothing: not what a later step does
    const int awake = moment.awake();
    std::vector<double> milliseconds;
    for (int i = 0; i < steps; ++i) {
      const auto start = std::chrono::steady_clock::now();
      moment.step(1.0 / 60);
      milliseconds.push_back(
          std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    std::nth_element(milliseconds.begin(), milliseconds.begin() + steps / 2, milliseconds.end());
    std::cout << scene.bodies.size() << ' ' << scene.joints.size() << ' ' << awake << ' '
              << milliseconds[static_cast<std::size_t>(steps / 2)] << '\n';
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
