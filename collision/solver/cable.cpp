#include "solver/cable.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <cmath>

namespace topple::collision {

Cable::Cable(btRigidBody& body, const btVector3& anchor, double length)
    : btTypedConstraint(MAX_CONSTRAINT_TYPE, body), anchor_(anchor), length_(length) {}

double Cable::speed_limit(const btVector3& velocity, double time_step) const {
  const btVector3 across = velocity - direction_ * direction_.dot(velocity);
  const double free = length_ * length_ - time_step * time_step * across.length2();
  return (std::sqrt(std::max(0.0, free)) - reach_) / time_step;
}

void Cable::getInfo1(btConstraintInfo1* info) {
  const btVector3 arm = m_rbA.getCenterOfMassPosition() - anchor_;
  reach_ = arm.length();
  // A body at the anchor itself is held in no direction yet.
  if (reach_ > 0) direction_ = arm / reach_;
  info->m_numConstraintRows = reach_ > 0 ? 1 : 0;
  info->nub = 0;
}

void Cable::getInfo2(btConstraintInfo2* info) {
  const double time_step = 1 / info->fps;
  for (int i = 0; i < 3; ++i) info->m_J1linearAxis[i] = direction_[i];
  const btVector3 velocity = m_rbA.getLinearVelocity() + m_rbA.getTotalForce() * (m_rbA.getInvMass() * time_step);
  info->m_constraintError[0] = speed_limit(velocity, time_step);
  info->cfm[0] = 0;
  info->m_lowerLimit[0] = -SIMD_INFINITY;
  info->m_upperLimit[0] = 0;
}

void Cable::hold(double time_step) {
  impulse_ = std::max(0.0, -double(getAppliedImpulse()));
  const double outward = direction_.dot(m_rbA.getLinearVelocity());
  const double limit = speed_limit(m_rbA.getLinearVelocity(), time_step);
  if (reach_ == 0 || outward <= limit) return;
  m_rbA.setLinearVelocity(m_rbA.getLinearVelocity() - direction_ * (outward - limit));
  impulse_ += (outward - limit) / m_rbA.getInvMass();
}

}  // namespace topple::collision
