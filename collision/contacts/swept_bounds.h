#pragma once
#include <LinearMath/btAabbUtil2.h>

#include "contacts/first_touch.h"

namespace topple::collision {

/// m.
struct Bounds {
  btVector3 low, high;
  [[nodiscard]] bool meets(const Bounds& other) const { return TestAabbAgainstAabb2(low, high, other.low, other.high); }
};

/// Bounds of a part over its whole path: those at both ends, and how far the path can leave the straight line between.
[[nodiscard]] Bounds swept_bounds(const SolidPart& part, const Motion& motion, double dt);

}  // namespace topple::collision
