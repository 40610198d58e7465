#pragma once
// Closing the openings that a cut leaves.
#include <array>
#include <vector>

#include "topple/fracture/mesh.h"

namespace topple::fracture {

/// Edges (pairs of welded positions) that are used more often in one direction than in the other, in the direction that
/// a lid needs, as often as it needs them.
[[nodiscard]] std::vector<std::array<int, 2>> lid_edges(const std::vector<std::array<int, 3>>& triangles);

/// Triangles between points in a plane whose border is the given directed edges, the inside on their left: a
/// constrained Delaunay triangulation of which the triangles with a positive winding number are kept.
[[nodiscard]] std::vector<std::array<int, 3>> lid(const std::vector<Vec2>& points,
                                                  const std::vector<std::array<int, 2>>& edges);

}  // namespace topple::fracture
