#pragma once
// How the area of a panel is shared out to its edges: the geometry of load handed to edge members, in the panel's
// plane. Every rule here moves area so that total and first moments stay: two-way because the roof over a polygon has
// integral(z grad z) = 0 when z is 0 on the boundary, strips because each point's share follows the lever rule.
#include <array>
#include <vector>

#include "topple/structure/building.h"

namespace topple::structure {

/// Area handed to a stretch of an edge: area per length of edge, linear from `first` at the distance `from` of the
/// edge's first corner to `last` at `to`.
struct TributaryStrip {
  double from = 0, to = 0, first = 0, last = 0;
};
using TributaryAreas = std::array<std::vector<TributaryStrip>, 4>;

/// Convex quadrilateral, corners counter-clockwise; edge i runs from corner i to i + 1. Openings lie inside and carry
/// nothing.
struct PanelOutline {
  std::array<Vec2, 4> corner;
  std::vector<std::vector<Vec2>> openings;

  [[nodiscard]] const Vec2& at(std::size_t i) const { return corner[i % 4]; }
  [[nodiscard]] double length(std::size_t edge) const { return (at(edge + 1) - at(edge)).norm(); }
  [[nodiscard]] Vec2 along(std::size_t edge) const { return (at(edge + 1) - at(edge)) / length(edge); }
  [[nodiscard]] Vec2 middle(std::size_t edge) const { return 0.5 * (at(edge) + at(edge + 1)); }
  [[nodiscard]] double size() const;
};

/// Each point goes to the edge nearest to it (45 degree lines in a rectangle, bisectors in other quadrilaterals),
/// straight across it. Openings are not looked at.
[[nodiscard]] TributaryAreas two_way_areas(const PanelOutline& outline);

/// Parallel strips along `direction` between whichever edges they end on; each point by the lever rule.
[[nodiscard]] TributaryAreas strip_areas(const PanelOutline& outline, const Vec2& direction);

/// Strips between an edge and its opposite alone, ending at equal fractions of both; each point by the lever rule.
/// `edge` is 0 or 1.
[[nodiscard]] TributaryAreas edge_pair_areas(const PanelOutline& outline, std::size_t edge);

/// Area straight above or below one edge along `up`; what lies beyond the edge's ends is told apart.
struct VerticalAreas {
  std::vector<TributaryStrip> on_edge;
  double area_beyond = 0;
  /// First moment of area that is missing when `area_beyond` is spread evenly over the edge.
  Vec2 moment_missing = Vec2::Zero();
};
[[nodiscard]] VerticalAreas vertical_areas(const PanelOutline& outline, std::size_t edge, const Vec2& up);

}  // namespace topple::structure
