#pragma once
#include <Eigen/Geometry>

#include "simulation/debris/part_motion.h"
#include "topple/collision/world.h"

namespace topple::structure {

/// Where a place `at` of the undeformed building is, and how it is turned, after that displacement about it.
[[nodiscard]] inline collision::Pose moved_pose(const Vec3& at, const PartMotion& shift) {
  collision::Pose pose;
  pose.position = at + shift.moved;
  const double angle = shift.turned.norm();
  if (angle > 0) pose.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(angle, shift.turned / angle));
  return pose;
}

}  // namespace topple::structure
