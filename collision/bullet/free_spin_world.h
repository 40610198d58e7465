#pragma once
// Bullet's world with a rotation that keeps angular momentum, and a record of what the solver did to each body.
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <functional>
#include <vector>

#include "solver/cable.h"

namespace topple::collision {

/// Where the constraint solver saw a body, and its velocities at the step's beginning (before gravity) and after the
/// solver. With velocities read at mid-step, minus J (before + after)/2 is exactly the energy that an impulse J takes
/// out of a body whose gravity work is m g dx: the two halves of gravity's kick cancel.
struct SolverVelocities {
  btTransform pose = btTransform::getIdentity();
  btVector3 linear_before{0, 0, 0}, angular_before{0, 0, 0};
  btVector3 linear_after{0, 0, 0}, angular_after{0, 0, 0};
};

class FreeSpinWorld : public btDiscreteDynamicsWorld {
 public:
  using btDiscreteDynamicsWorld::btDiscreteDynamicsWorld;

  /// Of a body in the last step; all zero for one that did not move in it. Owned by the caller through the user pointer
  /// of the body: see Body in bullet_world.h.
  using Record = SolverVelocities& (*)(btRigidBody&);
  void record_with(Record record) { record_ = record; }
  /// Cables that the world holds taut when its solver is done.
  void hold_after_solving(Cable* cable) { cables_.push_back(cable); }
  void let_go(Cable* cable) { std::erase(cables_, cable); }
  /// Contacts that Bullet foresaw for fast bodies stay until the next step, whether or not the bodies do.
  void forget_foreseen_contacts() { releasePredictiveContacts(); }
  [[nodiscard]] const btAlignedObjectArray<btPersistentManifold*>& foreseen_contacts() const {
    return m_predictiveManifolds;
  }

  /// Called in each step when contacts have been found, before bodies are gathered in islands and solved for.
  void before_solving(std::function<void()> call) { before_solving_ = std::move(call); }

 protected:
  void calculateSimulationIslands() override {
    if (before_solving_) before_solving_();
    btDiscreteDynamicsWorld::calculateSimulationIslands();
  }
  void predictUnconstraintMotion(btScalar time_step) override;
  /// Turns each body as a free one (free_rotation.h). Bullet's own rotation stops at 45 degrees a step, and its
  /// gyroscopic terms keep neither momentum nor energy.
  void integrateTransforms(btScalar time_step) override;

 private:
  Record record_ = nullptr;
  std::function<void()> before_solving_;
  std::vector<Cable*> cables_;
};

}  // namespace topple::collision
