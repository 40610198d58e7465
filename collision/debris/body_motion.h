#pragma once
// The motion of one free body through a step, and its energy.
#include "debris/debris_parts.h"

namespace topple::collision {

/// A body that nothing touches, through `dt`: exactly.
void fly(DebrisBody& one, const Vec3& gravity, double dt);
/// As a free body that has the momentum with which the step ended, and by what its contacts turned it otherwise: the
/// momentum stays, to rounding.
void turn(DebrisBody& one, const Vec3& turned, double dt);
/// Kinetic and of height. Velocities are those of mid-step.
[[nodiscard]] double energy(const DebrisBody& one, const Vec3& gravity, double dt);

}  // namespace topple::collision
