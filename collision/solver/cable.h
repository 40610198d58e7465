#pragma once
// A cable from a point in space to a body's centre, as one row of Bullet's solver.
//
// Velocities are those of the middle of the step, so the pull along the cable's direction at the step's beginning, of
// the size that puts the centre on the sphere at its end, is the SHAKE scheme (Ryckaert, Ciccotti and Berendsen, J.
// Comput. Phys. 23, 1977): second order, symplectic, and the length is met to rounding, with nothing that drifts.
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

namespace topple::collision {

class Cable final : public btTypedConstraint {
 public:
  Cable(btRigidBody& body, const btVector3& anchor, double length);

  void getInfo1(btConstraintInfo1* info) override;
  void getInfo2(btConstraintInfo2* info) override;
  void setParam(int, btScalar, int) override {}
  [[nodiscard]] btScalar getParam(int, int) const override { return 0; }

  /// After the solver: takes out what is left of the outward velocity. Contacts may have pushed the body on.
  void hold(double time_step);
  /// What the cable did to the body in this step, N s, towards the anchor.
  [[nodiscard]] double impulse() const { return impulse_; }
  [[nodiscard]] const btVector3& anchor() const { return anchor_; }
  [[nodiscard]] const btVector3& direction() const { return direction_; }
  [[nodiscard]] const btRigidBody& body() const { return m_rbA; }
  void slacken() { impulse_ = 0; }

 private:
  /// Largest speed away from the anchor, when the body moves across at this velocity.
  [[nodiscard]] double speed_limit(const btVector3& velocity, double time_step) const;

  btVector3 anchor_, direction_{0, 0, 1};
  double length_, reach_ = 0, impulse_ = 0;
};

}  // namespace topple::collision
