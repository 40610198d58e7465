#pragma once
// Linear and angular momentum of bodies, measured where they are and as they move.
#include <algorithm>

#include "simulation/debris/body.h"

namespace topple::structure {

struct Momentum {
  Vec3 about = Vec3::Zero();  ///< point of the angular momentum
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
  double linear_size = 0, angular_size = 0;  ///< sums of sizes: what an error is relative to

  void add_impulse(const Vec3& impulse, const Vec3& at) {
    add_linear(impulse);
    add_moment(at - about, impulse);
  }
  void add_turn(const Vec3& angular_momentum) {
    angular += angular_momentum;
    angular_size += angular_momentum.norm();
  }
  /// Velocities of `state` as they stand.
  void add(const Body& body, const collision::BodyState& state) {
    const Vec3 own = body.rest.mass * state.velocity;
    add_linear(own);
    add_moment(state.pose.position - about, own);
    const Vec3 spin = world_inertia(body, state.pose.orientation) * state.angular_velocity;
    angular += spin;
    angular_size += spin.norm();
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
  /// Its size is that of the products: what points through `about` has rounding of that size and no moment.
  void add_moment(const Vec3& arm, const Vec3& momentum) {
    angular += arm.cross(momentum);
    angular_size += arm.norm() * momentum.norm();
  }
};

}  // namespace topple::structure
