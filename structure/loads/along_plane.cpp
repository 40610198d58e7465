#include <algorithm>
#include <cmath>

#include "chords.h"
#include "panel_plane.h"

namespace topple::structure {

namespace {

/// Area and first moments of a polygon, positive for either sense of rotation.
struct Moments {
  double area = 0;
  Vec2 first = Vec2::Zero();
};
Moments moments(const std::vector<Vec2>& polygon) {
  Moments m;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double twice = p.x() * q.y() - p.y() * q.x();
    m.area += twice / 2;
    m.first += twice * (p + q) / 6;
  }
  if (m.area < 0) return {-m.area, -m.first};
  return m;
}

double chord_at(const std::vector<Crossing>& c, bool end) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < c.size(); i += 2)
    sum += end ? c[i + 1].at_end - c[i].at_end : c[i + 1].at_start - c[i].at_start;
  return sum;
}

}  // namespace

void along_plane(const PanelPlane& plane, int edge, const Vec3& traction, EdgeForces& out) {
  const double size = traction.norm();
  if (size == 0) return;
  const Vec2 down = (plane.axes * traction).head<2>().normalized();
  // Across the strips, along the strips.
  const auto turned = [&](const Vec2& p) { return Vec2(down.x() * p.y() - down.y() * p.x(), down.dot(p)); };
  const auto turned_all = [&](const auto& polygon) {
    std::vector<Vec2> all;
    for (const Vec2& p : polygon) all.push_back(turned(p));
    return all;
  };
  const std::vector<Vec2> border = turned_all(plane.corner);
  std::vector<std::vector<Vec2>> openings;
  for (const auto& opening : plane.openings) openings.push_back(turned_all(opening));

  const auto e = static_cast<std::size_t>(edge);
  const double length = (plane.corner[(e + 1) % 4] - plane.corner[e]).norm();
  const double start = border[e].x(), end = border[(e + 1) % 4].x();
  double low = start, high = start;
  for (const Vec2& p : border) {
    low = std::min(low, p.x());
    high = std::max(high, p.x());
  }
  const double slope = (end - start) / length;  // strips' width per length of edge
  const double tolerance = 1e-9 * (high - low);
  const bool under_all = std::min(start, end) <= low + tolerance && std::max(start, end) >= high - tolerance;
  if (!under_all || std::abs(slope) < 1e-9) {
    Moments net = moments(border);
    for (const auto& opening : openings) {
      const Moments hole = moments(opening);
      net.area -= hole.area;
      net.first -= hole.first;
    }
    // Where the strips run along the edge there is no place at which they end: the force is spread evenly.
    const double offset = std::abs(slope) < 1e-9 ? 0 : (net.first.x() / net.area - start) / slope - length / 2;
    const Vec3 mean = traction * (net.area / length);
    out.push_back({edge, 0, length, mean * (1 - 6 * offset / length), mean * (1 + 6 * offset / length)});
    return;
  }
  std::vector<std::vector<Vec2>> all = openings;
  all.push_back(border);
  const std::vector<double> at = abscissae(all, low, high, 1e-12 * (high - low));
  for (std::size_t k = 0; k + 1 < at.size(); ++k) {
    const std::vector<Crossing> whole = crossings(border, at[k], at[k + 1]);
    double at_start = chord_at(whole, false), at_end = chord_at(whole, true);
    for (const auto& opening : openings) {
      const std::vector<Crossing> hole = crossings(opening, at[k], at[k + 1]);
      at_start -= chord_at(hole, false);
      at_end -= chord_at(hole, true);
    }
    EdgeForce force{edge, (at[k] - start) / slope, (at[k + 1] - start) / slope, traction * (std::abs(slope) * at_start),
                    traction * (std::abs(slope) * at_end)};
    if (force.from > force.to) {
      std::swap(force.from, force.to);
      std::swap(force.first, force.last);
    }
    force.from = std::clamp(force.from, 0.0, length);
    force.to = std::clamp(force.to, 0.0, length);
    out.push_back(force);
  }
}

}  // namespace topple::structure
