#pragma once
// Linear and angular momentum of bodies, measured where they are and as they move.
#include <algorithm>

#include "simulation/body.h"

namespace topple::structure {

struct Momentum {
  Vec3 about = Vec3::Zero();  ///< point of the angular momentum
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
  double linear_size = 0, angular_size = 0;  ///< sums of sizes: what an error is relative to

  void add_impulse(const Vec3& impulse, const Vec3& at) {
    add_linear(impulse);
    add_angular((at - about).cross(impulse));
  }
  /// Velocities of `state` as they stand.
  void add(const Body& body, const collision::BodyState& state) {
    const Vec3 own = body.rest.mass * state.velocity;
    add_linear(own);
    add_angular((state.pose.position - about).cross(own));
    add_angular(world_inertia(body, state.pose.orientation) * state.angular_velocity);
  }
  /// Relative to the larger of the two.
  [[nodiscard]] double error(const Momentum& other) const {
    const double size = std::max(linear_size, other.linear_size);
    const double turn = std::max(angular_size, other.angular_size);
    return std::max(size > 0 ? (linear - other.linear).norm() / size : 0,
                    turn > 0 ? (angular - other.angular).norm() / turn : 0);
  }

 private:
  void add_linear(const Vec3& momentum) {
    linear += momentum;
    linear_size += momentum.norm();
  }
  void add_angular(const Vec3& momentum) {
    angular += momentum;
    angular_size += momentum.norm();
  }
};

}  // namespace topple::structure
