#pragma once
// Regions of the triangulation as few convex polygons.
#include <vector>

#include "topple/fracture/panel.h"
#include "triangulation.h"

namespace topple::fracture {

/// The given triangles, all of one label, as convex chunks: S. Hertel and K. Mehlhorn, "Fast triangulation of simple
/// polygons" (1983): a side between two of them is taken out where both its ends stay convex. At most four times as
/// many as the best, and one where the region is convex. A corner may lie inside the straight line by the tolerance.
[[nodiscard]] std::vector<Chunk> convex_pieces(const Triangulation& triangulation, const std::vector<int>& triangles);

}  // namespace topple::fracture
