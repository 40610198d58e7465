#pragma once
// Local damage: the hole that a hit tears into a panel, and the spider's web of cracks in it.
#include <cstdint>
#include <vector>

#include "topple/fracture/panel_settings.h"
#include "topple/fracture/polygon.h"

namespace topple::fracture {

/// What a hit does to an endless panel.
struct LocalDamage {
  /// Distance and direction of the corners as they were drawn, counter-clockwise around the hit. No gap exceeds 180
  /// degrees, so that the hit lies inside.
  Polygon corners;
  /// The convex outline that is left when every concave corner is closed by a triangle.
  Polygon outline;
  /// Convex cells that tile the outline: first those around the hit, ring by ring in each sector, then the triangles of
  /// closed corners.
  std::vector<Polygon> cells;
};

/// Throws std::invalid_argument when a setting is out of range.
void check(const LocalDamageSettings& settings);

/// Corner i of n lies at (i/n + random(-1/2n, 1/2n)) x 360 degrees, drawn again when a gap exceeds 180, at a random
/// length within the bounds, times `scale`. Rings are cut between the distances `nearest` and `farthest` from the hit
/// (m), where the panel is. The same seed gives the same damage.
[[nodiscard]] LocalDamage local_damage(const Vec2& hit, double scale, const LocalDamageSettings& settings,
                                       std::uint64_t seed, double nearest, double farthest);

}  // namespace topple::fracture
