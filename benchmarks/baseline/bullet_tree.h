#pragma once
// The scene as one of Bullet's multi-bodies (Featherstone's articulated-body algorithm): links joined rigidly along a
// tree. A frame has loops. The joints that close them are left out, because a rigid tree has no freedom left that they
// could hold; so it stands without any sag, and carries all that hangs on a link through the one joint above it.
#include <btBulletDynamicsCommon.h>

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointFeedback.h>

#include "engine.h"

namespace baseline {

class BulletTree : public Engine {
 public:
  BulletTree(const Scene& scene, const Method& method);
  ~BulletTree() override;
  BulletTree(const BulletTree&) = delete;
  BulletTree& operator=(const BulletTree&) = delete;

  void step() override;
  [[nodiscard]] double mean_roof_sag() const override;
  [[nodiscard]] std::vector<JointForce> joint_forces() const override;
  [[nodiscard]] int joints_left_out() const override;

 private:
  void grow_tree();
  void add_links();
  void push_links();

  const Scene& scene_;
  Method method_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btMultiBodyConstraintSolver solver_;
  btMultiBodyDynamicsWorld world_;
  std::vector<std::size_t> joint_of_link_;  // index of Scene::joints
  std::vector<int> link_of_body_;           // -1: the tree does not reach it
  std::unique_ptr<btMultiBody> tree_;
  std::vector<btMultiBodyJointFeedback> feedback_;
  int steps_ = 0;
};

}  // namespace baseline
