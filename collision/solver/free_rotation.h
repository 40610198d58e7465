#pragma once
// Rotation of a free rigid body over one step, by the splitting of free_spin.h.
#include "topple/collision/world.h"

namespace topple::collision {

struct FreeRotation {
  Eigen::Quaterniond orientation;  ///< of the principal axes
  Vec3 spin;                       ///< rad/s, global axes
};

/// Euler's equations for these principal moments (kg m2) over `time` (s): momentum to rounding, energy within the
/// square of the largest turn in a part (0.05 rad) and without drift.
[[nodiscard]] FreeRotation rotated_freely(const FreeRotation& now, const Vec3& inertia, double time);

}  // namespace topple::collision
