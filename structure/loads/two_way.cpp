#include <algorithm>

#include "chords.h"
#include "panel_plane.h"

namespace topple::structure {

namespace {

/// Distance from the line of an edge, inwards positive: a linear function of the point.
struct Line {
  Vec2 point, inward, along;
  [[nodiscard]] double distance(const Vec2& p) const { return inward.dot(p - point); }
};

/// The part of a convex polygon where the linear function `value` is not negative.
template <class Value>
std::vector<Vec2> clip(const std::vector<Vec2>& polygon, Value value) {
  std::vector<Vec2> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double va = value(a), vb = value(b);
    if (va >= 0) kept.push_back(a);
    if ((va > 0 && vb < 0) || (va < 0 && vb > 0)) kept.push_back(a + (b - a) * (va / (va - vb)));
  }
  return kept;
}

}  // namespace

void two_way(const PanelPlane& plane, const Vec3& traction, EdgeForces& out) {
  std::array<Line, 4> line;
  for (std::size_t e = 0; e < 4; ++e) {
    const Vec2 along = (plane.corner[(e + 1) % 4] - plane.corner[e]).normalized();
    line[e] = {plane.corner[e], Vec2(-along.y(), along.x()), along};
  }
  for (std::size_t e = 0; e < 4; ++e) {
    std::vector<Vec2> nearest(plane.corner.begin(), plane.corner.end());
    for (std::size_t other = 0; other < 4; ++other)
      if (other != e)
        nearest = clip(nearest, [&](const Vec2& p) { return line[other].distance(p) - line[e].distance(p); });
    // In the edge's coordinates: how deep the nearest part reaches in from each point of the edge.
    const double length = (plane.corner[(e + 1) % 4] - plane.corner[e]).norm();
    for (Vec2& p : nearest) p = Vec2(line[e].along.dot(p - line[e].point), line[e].distance(p));
    const std::vector<double> at = abscissae({nearest}, 0, length, 1e-12 * length);
    for (std::size_t k = 0; k + 1 < at.size(); ++k) {
      const std::vector<Crossing> c = crossings(nearest, at[k], at[k + 1]);
      if (c.size() < 2) continue;
      const Crossing &low = c.front(), &high = c.back();
      out.push_back({static_cast<int>(e), at[k], at[k + 1], traction * (high.at_start - low.at_start),
                     traction * (high.at_end - low.at_end)});
    }
  }
}

}  // namespace topple::structure
