#pragma once
// A panel's geometry in its own plane, and what its action puts on its edges.
#include <array>
#include <vector>

#include "topple/structure/frame.h"

namespace topple::structure {

/// The panel in local x, y from its node 1. Corners go counter-clockwise.
struct PanelPlane {
  std::array<Vec2, 4> corner;
  std::vector<std::vector<Vec2>> openings;
  Vec3 normal;
  Mat3 axes;
};
[[nodiscard]] PanelPlane panel_plane(const Building& building, const Panel& panel);

/// Force along a stretch of one edge: per length, linear from `first` to `last`; where from == to, a point force
/// `first`. Distances from the edge's first node; global components.
struct EdgeForce {
  int edge = 0;
  double from = 0, to = 0;
  Vec3 first = Vec3::Zero(), last = Vec3::Zero();
};
using EdgeForces = std::vector<EdgeForce>;

/// Strips between edge `first_edge` and its opposite: each strip joins the points at equal shares of the two edges, and
/// each point of it goes to its ends by the lever rule, so that force and all moments are kept. Openings carry nothing.
void one_way(const PanelPlane& plane, int first_edge, const Vec3& traction, EdgeForces& out);

/// Every point goes straight to the nearest edge: the bisectors of the corners (45 degrees in a rectangle) part the
/// panel. No openings.
void two_way(const PanelPlane& plane, const Vec3& traction, EdgeForces& out);

/// Strips along the traction, which lies in the plane, down to one edge. Where the edge does not reach under all of the
/// panel, the linear distribution over it that has the same force and moment.
void along_plane(const PanelPlane& plane, int edge, const Vec3& traction, EdgeForces& out);

/// Edge (0 or 1) that with its opposite makes the shorter span, by the distance of midpoints.
[[nodiscard]] int shorter_span(const PanelPlane& plane);

}  // namespace topple::structure
