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

/// A piece of debris as it lies.
struct FallenBody {
  double reach = 0;  ///< m: its farthest place beyond the building as it was
  double mass = 0;   ///< kg
  std::vector<Vec2> places;
};
/// m2: convex hull of the bodies without those that lie farthest, whole ones that together have `mass` (kg) at most.
/// The hull of all hangs on single pieces.
[[nodiscard]] double footprint_without_farthest(std::vector<FallenBody> bodies, double mass);

struct DebrisField {
  double footprint = 0;     ///< m2: convex hull of all debris
  double footprint_95 = 0;  ///< m2: the same without the farthest bodies, up to a twentieth of the mass
  double height = 0;        ///< m: highest place of debris and of members that stand, above the building's lowest node
  double reach = 0;         ///< m: farthest debris beyond the hull of the building as it was
  double outside = 0;       ///< share of the debris by mass beyond that hull
};
/// Debris is every body but projectiles; its places are the ends of its members, the corners of its panels, the
/// vertices of its chunks.
[[nodiscard]] DebrisField debris_field(const Simulation& simulation);

}  // namespace topple::structure::study
