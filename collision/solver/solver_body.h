#pragma once
// A body as the step's solver sees it: its principal axes and where it is when the step begins. Rows act on scaled
// velocities (contact_packs.h).
#include <cmath>

#include "contacts/manifold.h"
#include "solver/contact_packs.h"

namespace topple::collision {

struct SolverBody {
  Placement at;                  ///< principal axes
  double inverse_root_mass = 0;  ///< 1/sqrt(kg)
  Vec3 inverse_root_moments = Vec3::Zero();
  /// Of what joints alone hold to, instead of both: lower triangular, times its transpose its mobility
  /// (ObstacleMotion::mobility). It must live for the step. Null: those.
  const Mat6* root_mobility = nullptr;
  Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();                      ///< stored ones (BodyState), global
  Vec3 acceleration = Vec3::Zero(), angular_acceleration = Vec3::Zero();  ///< contacts and joints apart
  Vec3 moved = Vec3::Zero(), turned = Vec3::Zero();                       ///< by the step: m, rad about global axes

  /// The angular part of a row of moment m per unit impulse.
  [[nodiscard]] Vec3 scaled_moment(const Vec3& moment) const {
    return inverse_root_moments.cwiseProduct(at.turn.transpose() * moment);
  }
  /// Global, kg m2.
  [[nodiscard]] Mat3 inertia() const {
    return at.turn * inverse_root_moments.cwiseAbs2().cwiseInverse().asDiagonal() * at.turn.transpose();
  }
  /// The row of a unit impulse with this moment about the body's place.
  [[nodiscard]] Eigen::Matrix<double, 1, 6> row(const Vec3& along, const Vec3& moment) const {
    Eigen::Matrix<double, 6, 1> row;
    row << along, moment;
    if (root_mobility != nullptr) return (root_mobility->transpose() * row).transpose();
    row.head<3>() = inverse_root_mass * along;
    row.tail<3>() = scaled_moment(moment);
    return row.transpose();
  }
  [[nodiscard]] Vec3 linear(const Motion6& scaled) const {
    if (root_mobility != nullptr) return motion(scaled).head<3>();
    return inverse_root_mass * Vec3(scaled.linear[0], scaled.linear[1], scaled.linear[2]);
  }
  [[nodiscard]] Vec3 angular(const Motion6& scaled) const {
    if (root_mobility != nullptr) return motion(scaled).tail<3>();
    return at.turn * inverse_root_moments.cwiseProduct(Vec3(scaled.angular[0], scaled.angular[1], scaled.angular[2]));
  }
  void set(const Vec3& linear_motion, const Vec3& angular_motion, Motion6& scaled) const {
    if (root_mobility != nullptr) {
      Eigen::Matrix<double, 6, 1> motion;
      motion << linear_motion, angular_motion;
      root_mobility->triangularView<Eigen::Lower>().solveInPlace(motion);
      Eigen::Map<Eigen::Matrix<double, 6, 1>>(scaled.linear) = motion;
      return;
    }
    const Vec3 turn = (at.turn.transpose() * angular_motion).cwiseQuotient(inverse_root_moments);
    for (int i = 0; i < 3; ++i) {
      scaled.linear[i] = linear_motion[i] / inverse_root_mass;
      scaled.angular[i] = turn[i];
    }
  }

 private:
  [[nodiscard]] Eigen::Matrix<double, 6, 1> motion(const Motion6& scaled) const {
    return *root_mobility * Eigen::Map<const Eigen::Matrix<double, 6, 1>>(scaled.linear);
  }
};

}  // namespace topple::collision
