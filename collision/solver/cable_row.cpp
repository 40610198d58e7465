#include "solver/cable_row.h"

#include <algorithm>

namespace topple::collision {

void CableRow::hold(const SolverBody& of, double h, const Motion6& displacement, Motion6& velocity, Motion6& changed) {
  const Vec3 arm = of.at.position + of.linear(displacement) - anchor;
  const double reach = arm.norm();
  if (reach == 0) return;  // a body at the anchor itself is held in no direction yet
  direction_ = arm / reach;
  const Vec3 &direction = direction_, now = of.linear(velocity);
  const double outward = direction.dot(now), across = (now - outward * direction).squaredNorm();
  const double limit = (std::sqrt(std::max(0.0, length * length - h * h * across)) - reach) / h;
  if (outward <= limit) return;
  const double change = (outward - limit) / of.inverse_root_mass;
  for (int i = 0; i < 3; ++i) {
    velocity.linear[i] -= change * direction[i];
    changed.linear[i] -= change * direction[i];
  }
  const double size = change / of.inverse_root_mass;
  impulse -= size * direction;
  pulled += size;
}

RestJoint CableRow::at_rest(const SolverBody& of, double dt) const {
  RestJoint joint;
  joint.first = body;
  joint.pulls_only = true;
  const Vec3 arm = of.at.position - anchor;
  if (arm.norm() < (1 - 1e-6) * length) return joint;  // slack
  joint.on_first.row(0).head<3>() = -of.inverse_root_mass * arm.normalized();
  joint.stiffness(0, 0) = 1 / (of.inverse_root_mass * of.inverse_root_mass);
  joint.start[0] = pulled / dt;
  return joint;
}

void CableRow::store_rest(double tension, double dt) {
  pulled = tension * dt;
  impulse = -pulled * direction_;
}

}  // namespace topple::collision
