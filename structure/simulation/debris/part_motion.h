#pragma once
// How a standing part moves as a rigid body, from how its nodes do.
#include "simulation/debris/part.h"
#include "topple/structure/standing_frame.h"

namespace topple::structure {

/// About a place of the undeformed building: m and rad, or m/s and rad/s, global axes.
struct PartMotion {
  Vec3 moved = Vec3::Zero(), turned = Vec3::Zero();
};
template <class Archive>
void serialize(Archive& archive, PartMotion& motion) {
  auto& [moved, turned] = motion;
  archive(moved, turned);
}

/// Displacement of a standing part about `at`: of the rigid motions the one nearest to those of its nodes that
/// stand and that it still holds on to.
[[nodiscard]] PartMotion rigid_displacement(const StandingFrame& frame, Part part, const Vec3& at);
/// The same of its velocity.
[[nodiscard]] PartMotion rigid_velocity(const StandingFrame& frame, Part part, const Vec3& at);
/// And of its acceleration through the next substep (StandingFrame::foreseen_acceleration()).
[[nodiscard]] PartMotion foreseen_acceleration(StandingFrame& frame, Part part, const Vec3& at);

}  // namespace topple::structure
