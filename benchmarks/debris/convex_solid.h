#pragma once
// Convex solids of the scenes, with what measures need of them: corners, axes that may part two of them, mass
// properties.
#include <Eigen/Core>
#include <vector>

namespace topple::bench {

/// Corners are about the centre of mass. SI.
struct ConvexSolid {
  std::vector<Eigen::Vector3d> corners;
  std::vector<Eigen::Vector3d> normals, edges;        ///< unit, each direction once
  bool box = false;                                   ///< of these half extents, along its axes
  Eigen::Vector3d half = Eigen::Vector3d::Zero();     ///< of a box
  double volume = 0;                                  ///< m3
  double reach = 0;                                   ///< m: of the farthest corner
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about the centre of mass, for a density of one
};

[[nodiscard]] ConvexSolid box_solid(const Eigen::Vector3d& half);
/// A frustum: the convex polygon `base` (anticlockwise seen from above), `thick` high, on top shrunk to `taper` of it.
[[nodiscard]] ConvexSolid frustum(const std::vector<Eigen::Vector2d>& base, double thick, double taper);

}  // namespace topple::bench
