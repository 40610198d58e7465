#pragma once
// What a point mass adds to an inertia tensor.
#include "topple/structure/building.h"

namespace topple::structure {

/// m (r.r 1 - r r'), kg m2 for kg and m.
[[nodiscard]] inline Mat3 point_inertia(double mass, const Vec3& r) {
  return mass * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
}

}  // namespace topple::structure
