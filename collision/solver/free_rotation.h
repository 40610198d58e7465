#pragma once
// Rotation of a free rigid body over one step.
#include "topple/collision/world.h"

namespace topple::collision {

struct FreeRotation {
  Eigen::Quaterniond orientation;  ///< of the principal axes
  Vec3 spin;                       ///< rad/s, global axes
};

/// The free rotation of a body with these principal moments of inertia (kg m2) over `time` (s): Euler's equations split
/// into rotations about the principal axes, each done exactly, composed symmetrically (Dullweber, Leimkuhler and
/// McLachlan, J. Chem. Phys. 107, 1997). The angular momentum is kept to rounding; the energy is not lost or gained
/// over time, but swings about its value with the square of the largest turn in a part of the step, which is kept below
/// 0.05 rad. A slender body makes this matter: its moments differ by a factor of hundreds, so that a small error in the
/// direction of its axis would turn a tumbling into a spin with many times the energy.
[[nodiscard]] FreeRotation rotated_freely(const FreeRotation& now, const Vec3& inertia, double time);

}  // namespace topple::collision
