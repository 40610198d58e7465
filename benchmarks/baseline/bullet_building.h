#pragma once
// The scene in Bullet: one rigid body for each part, one fixed constraint for each joint, contacts and sleeping off.
#include <btBulletDynamicsCommon.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "scene.h"

class btMLCPSolver;
class btMLCPSolverInterface;

namespace baseline {

struct Method {
  std::string solver = "si";  // si, nncg, pgs, dantzig, lemke
  int iterations = 10;
  int substeps = 1;  // of one step
  double step = 1.0 / 60;
  double compliance = 0;  // constraint force mixing of the joints; 0: Bullet's default
};

/// What one joint did in the last step, as SceneJoint::force: mean over its substeps.
using JointForce = std::array<double, 6>;

class BulletBuilding {
 public:
  BulletBuilding(const Scene& scene, const Method& method);
  ~BulletBuilding();
  BulletBuilding(const BulletBuilding&) = delete;
  BulletBuilding& operator=(const BulletBuilding&) = delete;

  void step();
  [[nodiscard]] double mean_roof_sag() const;
  [[nodiscard]] std::vector<JointForce> joint_forces() const;
  /// Steps (substeps) in which a direct MLCP solver failed and Bullet went on with sequential impulse by itself.
  [[nodiscard]] int silent_fallbacks() const;
  [[nodiscard]] bool finite() const;

 private:
  void add_body(const SceneBody& body);
  void add_joint(const SceneJoint& joint, double compliance);
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
};

}  // namespace baseline
