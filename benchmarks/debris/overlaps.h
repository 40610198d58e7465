#pragma once
// How far solids are inside each other, exactly: the least overlap over all axes that could part two convex solids.
#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "convex_solid.h"

namespace topple::bench {

/// A solid where it is: what it has, in global axes.
struct PlacedSolid {
  PlacedSolid(const ConvexSolid& solid, const Eigen::Vector3d& position, const Eigen::Quaterniond& orientation);
  std::vector<Eigen::Vector3d> corners, normals, edges;
  Eigen::Vector3d low, high;  ///< bounds
};

/// Least overlap, m, over the normals of both and the cross products of their edges; below zero when an axis parts them
/// (then not the least).
[[nodiscard]] double overlap(const PlacedSolid& first, const PlacedSolid& second);

struct Overlaps {
  int over_10_mm = 0, over_20_mm = 0;  ///< pairs
  double deepest = 0;                  ///< m
};

/// Of each body with the others, with what stands, and with the ground below z = 0 if there is one.
[[nodiscard]] Overlaps find_overlaps(std::span<const PlacedSolid> bodies, std::span<const PlacedSolid> standing,
                                     bool ground);

}  // namespace topple::bench
