#pragma once
// How fast places of a rigid body move, and how unit forces at some of them speed up the others.
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "topple/structure/building.h"

namespace topple::structure {

/// Where two things meet: a point and the unit normal from the first into the second, global axes.
struct ImpactPlace {
  Vec3 point = Vec3::Zero(), normal = Vec3::Zero();
};

/// One that is free to move. Global axes.
struct RigidMotion {
  double inverse_mass = 0;              ///< 1/kg; 0: it does not move, whatever pushes it
  Mat3 inverse_inertia = Mat3::Zero();  ///< about the centre
  Vec3 centre = Vec3::Zero(), velocity = Vec3::Zero(), spin = Vec3::Zero();

  [[nodiscard]] Vec3 velocity_at(const Vec3& point) const { return velocity + spin.cross(point - centre); }
  void push(const Vec3& impulse, const Vec3& point) {
    velocity += inverse_mass * impulse;
    spin += inverse_inertia * (point - centre).cross(impulse);
  }
};

/// J M^-1 J' of the places along their normals, 1/kg.
[[nodiscard]] inline Eigen::MatrixXd mobility(const RigidMotion& body, const std::vector<ImpactPlace>& places) {
  const auto n = static_cast<Eigen::Index>(places.size());
  Eigen::Matrix<double, Eigen::Dynamic, 3> normals(n, 3), levers(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    const ImpactPlace& place = places[static_cast<std::size_t>(i)];
    normals.row(i) = place.normal;
    levers.row(i) = (place.point - body.centre).cross(place.normal);
  }
  return body.inverse_mass * normals * normals.transpose() + levers * body.inverse_inertia * levers.transpose();
}

/// Speeds at which the first comes upon the second at each place, m/s.
[[nodiscard]] inline Eigen::VectorXd closing_speeds(const RigidMotion& first, const RigidMotion& second,
                                                    const std::vector<ImpactPlace>& places) {
  Eigen::VectorXd speeds(static_cast<Eigen::Index>(places.size()));
  for (std::size_t i = 0; i < places.size(); ++i)
    speeds(static_cast<Eigen::Index>(i)) =
        (first.velocity_at(places[i].point) - second.velocity_at(places[i].point)).dot(places[i].normal);
  return speeds;
}

}  // namespace topple::structure
