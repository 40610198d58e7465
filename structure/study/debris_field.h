#pragma once
// Where a collapse has thrown its debris, seen from above.
#include <vector>

#include "topple/structure/simulation.h"

namespace topple::structure::study {

/// Corners of the convex hull, counter-clockwise (A. M. Andrew, Another efficient algorithm for convex hulls in two
/// dimensions, Inf. Process. Lett. 9, 1979).
[[nodiscard]] std::vector<Vec2> convex_hull(std::vector<Vec2> points);
[[nodiscard]] double area_of(const std::vector<Vec2>& hull);
/// From the nearest point of the hull; 0 inside.
[[nodiscard]] double distance_outside(const std::vector<Vec2>& hull, const Vec2& point);

struct DebrisField {
  double footprint = 0;  ///< m2: convex hull of all debris
  double reach = 0;      ///< m: farthest debris beyond the hull of the building as it was
  double outside = 0;    ///< share of the debris by mass beyond that hull
};
/// Debris is every body but projectiles; its places are the ends of its members, the corners of its panels, the
/// vertices of its chunks.
[[nodiscard]] DebrisField debris_field(const Simulation& simulation);

}  // namespace topple::structure::study
