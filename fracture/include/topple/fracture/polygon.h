#pragma once
// Plane polygons: area, centroid, clipping. Vertices go counter-clockwise. Lengths in m (any unit).
#include <Eigen/Core>
#include <vector>

namespace topple::fracture {

using Vec2 = Eigen::Vector2d;
using Polygon = std::vector<Vec2>;

/// Signed area: positive for counter-clockwise vertices.
[[nodiscard]] double area(const Polygon& polygon);
/// Centre of area. The polygon must have an area.
[[nodiscard]] Vec2 centroid(const Polygon& polygon);
/// True for a point inside a convex polygon or on its border.
[[nodiscard]] bool contains(const Polygon& convex, const Vec2& point);

/// True for a point inside a simple polygon or on its border, convex or not, whichever way it goes. Exact for any
/// coordinates.
[[nodiscard]] bool encloses(const Polygon& polygon, const Vec2& point);
/// True when no two edges meet but neighbours in their common vertex. Exact; the cost is quadratic.
[[nodiscard]] bool is_simple(const Polygon& polygon);

/// A convex polygon each of whose edges says what it came from: edge i runs from vertex i to vertex i + 1.
struct LabelledPolygon {
  Polygon vertices;         ///< convex, counter-clockwise
  std::vector<int> labels;  ///< one for each edge
};

/// Keeps the part of a convex polygon with normal . (p - point) <= 0; the new edge gets the label. Empty when nothing
/// is left. Returns whether anything was cut off. A vertex on the line stays, and makes no second one. A crossing is
/// computed from the end that is kept, so that two polygons that share the edge get the same point.
bool clip(LabelledPolygon& polygon, const Vec2& point, const Vec2& normal, int label);

}  // namespace topple::fracture
