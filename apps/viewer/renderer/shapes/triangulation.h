#pragma once
// Triangles of a plane polygon with holes, for the caps of sections and the faces of panels.
#include <array>
#include <glm/vec2.hpp>
#include <vector>

namespace topple::viewer {

using Loop = std::vector<glm::vec2>;

/// Twice the signed area: positive when the loop runs counter-clockwise.
[[nodiscard]] float doubled_area(const Loop& loop);

/// Ear clipping; holes are first joined to the outline by bridges (D. Eberly, "Triangulation by Ear Clipping"). Loops
/// may run either way round; holes lie inside the outline and apart from each other. Indices count the outline's
/// points, then each hole's in turn; triangles run counter-clockwise. A loop's every edge is the edge of exactly one
/// triangle.
[[nodiscard]] std::vector<std::array<int, 3>> triangulate(const Loop& outline, const std::vector<Loop>& holes = {});

}  // namespace topple::viewer
