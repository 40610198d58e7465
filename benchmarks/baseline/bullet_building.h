#pragma once
// The scene in Bullet: one rigid body for each part, one fixed constraint for each joint, contacts and sleeping off.
#include <btBulletDynamicsCommon.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "engine.h"

class btMLCPSolver;
class btMLCPSolverInterface;

namespace baseline {

class BulletBuilding : public Engine {
 public:
  BulletBuilding(const Scene& scene, const Method& method);
  ~BulletBuilding() override;
  BulletBuilding(const BulletBuilding&) = delete;
  BulletBuilding& operator=(const BulletBuilding&) = delete;

  void step() override;
  [[nodiscard]] double mean_roof_sag() const override;
  [[nodiscard]] std::vector<JointForce> joint_forces() const override;
  [[nodiscard]] int silent_fallbacks() const override;

 private:
  void add_body(const SceneBody& body);
  void add_joint(const SceneJoint& joint, double compliance);
  void push_bodies();
  void gather_forces();

  const Scene& scene_;
  Method method_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  std::unique_ptr<btMLCPSolverInterface> direct_;
  std::unique_ptr<btConstraintSolver> solver_;
  btMLCPSolver* mlcp_ = nullptr;
  std::unique_ptr<btDiscreteDynamicsWorld> world_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btTypedConstraint>> joints_;
  std::vector<btJointFeedback> feedback_;
  std::vector<btTransform> at_solve_;  // poses that the forces of the step belong to
  std::vector<JointForce> forces_;
  int steps_ = 0;
};

}  // namespace baseline
