#include "mesh/panel_cells.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mesh/point_index.h"

namespace topple::structure {

namespace {

using Polygon = std::vector<Vec2>;  ///< convex, counter-clockwise, local x and y

/// Lengths below this share of the panel's size are rounding.
constexpr double rounding = 1e-9;

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

Vec2 centroid(const Polygon& polygon) {
  Vec2 sum = Vec2::Zero();
  double area = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const double part = cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
    sum += part * (polygon[0] + polygon[i] + polygon[i + 1]) / 3;
    area += part;
  }
  return sum / area;
}

bool inside(const Polygon& opening, const Vec2& p) {
  bool in = false;
  for (std::size_t i = 0; i < opening.size(); ++i) {
    const Vec2 &a = opening[i], &b = opening[(i + 1) % opening.size()];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) in = !in;
  }
  return in;
}

bool open_at(const Panel& panel, const Polygon& polygon) {
  const Vec2 middle = centroid(polygon);
  return std::any_of(panel.openings.begin(), panel.openings.end(),
                     [&](const Polygon& opening) { return inside(opening, middle); });
}

struct Chord {
  Vec2 from, to;
};

/// The part of a side that runs through a polygon's interior; none when it only touches or follows its border.
std::optional<Chord> chord(const Polygon& polygon, const Vec2& a, const Vec2& b, double off) {
  const Vec2 along = b - a;
  double first = 0, last = 1, deepest = 1e300;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2& corner = polygon[i];
    const Vec2 border = polygon[(i + 1) % polygon.size()] - corner;
    const Vec2 inwards = Vec2(-border.y(), border.x()).normalized();
    const double at_a = inwards.dot(a - corner), slope = inwards.dot(along);
    if (slope > 0) first = std::max(first, -at_a / slope);
    if (slope < 0) last = std::min(last, -at_a / slope);
    if (slope == 0 && at_a <= 0) return std::nullopt;
  }
  if ((last - first) * along.norm() <= off) return std::nullopt;
  const Vec2 middle = a + 0.5 * (first + last) * along;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 border = polygon[(i + 1) % polygon.size()] - polygon[i];
    deepest = std::min(deepest, cross(border, middle - polygon[i]) / border.norm());
  }
  if (deepest <= off) return std::nullopt;
  return Chord{a + first * along, a + last * along};
}

template <class Act>
void for_each_side(const Panel& panel, Act act) {
  for (const auto& opening : panel.openings)
    for (std::size_t i = 0; i < opening.size(); ++i) act(opening[i], opening[(i + 1) % opening.size()]);
}

/// The two parts of a convex polygon on either side of a chord from border to border.
std::array<Polygon, 2> split(const Polygon& polygon, const Chord& cut, double off) {
  const Vec2 along = (cut.to - cut.from).normalized();
  std::vector<double> height;
  for (const Vec2& p : polygon) {
    const double h = cross(along, p - cut.from);
    height.push_back(std::abs(h) <= off ? 0 : h);
  }
  std::array<Polygon, 2> parts;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::size_t next = (i + 1) % polygon.size();
    if (height[i] >= 0) parts[0].push_back(polygon[i]);
    if (height[i] <= 0) parts[1].push_back(polygon[i]);
    if (height[i] * height[next] < 0) {
      const Vec2 p = polygon[i] + height[i] / (height[i] - height[next]) * (polygon[next] - polygon[i]);
      parts[0].push_back(p);
      parts[1].push_back(p);
    }
  }
  return parts;
}

/// No corner of an opening lies inside of a cell, so a side runs from border to border.
std::vector<Polygon> cut_cell(const Panel& panel, const Polygon& cell, double off) {
  std::vector<Polygon> parts{cell};
  for_each_side(panel, [&](const Vec2& a, const Vec2& b) {
    std::vector<Polygon> next;
    for (const Polygon& part : parts) {
      const auto cut = chord(part, a, b, off);
      if (!cut) {
        next.push_back(part);
        continue;
      }
      for (Polygon& half : split(part, *cut, off)) next.push_back(std::move(half));
    }
    parts = std::move(next);
  });
  return parts;
}

class Cutter {
 public:
  explicit Cutter(const PanelSurface& surface) : surface_(surface), index_(rounding) {}

  void whole(const std::array<Vec2, 4>& st) {
    std::array<int, 4> nodes;
    for (std::size_t i = 0; i < 4; ++i) nodes[i] = point(st[i]);
    result.quadrilaterals.push_back(nodes);
  }

  /// One quadrilateral at each corner, between the middles of its sides and the centre.
  void divided(const Polygon& polygon) {
    const int centre = point(surface_.parameters(centroid(polygon)));
    const std::size_t n = polygon.size();
    std::vector<int> corner, middle;
    for (std::size_t i = 0; i < n; ++i) {
      corner.push_back(point(surface_.parameters(polygon[i])));
      middle.push_back(point(surface_.parameters(0.5 * (polygon[i] + polygon[(i + 1) % n]))));
    }
    for (std::size_t i = 0; i < n; ++i)
      result.quadrilaterals.push_back({corner[i], middle[i], centre, middle[(i + n - 1) % n]});
  }

  PanelCells result;

 private:
  int point(const Vec2& st) {
    const Vec3 place(st.x(), st.y(), 0);
    int found = index_.nearest(place, rounding);
    if (found < 0) {
      found = static_cast<int>(result.points.size());
      result.points.push_back(st);
      index_.add(place, found);
    }
    return found;
  }

  const PanelSurface& surface_;
  PointIndex index_;
};

template <class Act>
void for_each_cell(const PanelLines& lines, Act act) {
  const auto &s = lines.at[0], &t = lines.at[1];
  for (std::size_t j = 0; j + 1 < t.size(); ++j)
    for (std::size_t i = 0; i + 1 < s.size(); ++i)
      act(std::array<Vec2, 4>{Vec2(s[i], t[j]), Vec2(s[i + 1], t[j]), Vec2(s[i + 1], t[j + 1]), Vec2(s[i], t[j + 1])});
}

Polygon outline(const PanelSurface& surface, const std::array<Vec2, 4>& st) {
  Polygon polygon;
  for (const Vec2& corner : st) polygon.push_back(surface.local(corner));
  return polygon;
}

}  // namespace

bool cuts_cells(const PanelSurface& surface, const Panel& panel, const PanelLines& lines) {
  bool cuts = false;
  for_each_cell(lines, [&](const std::array<Vec2, 4>& st) {
    const Polygon cell = outline(surface, st);
    for_each_side(panel, [&](const Vec2& a, const Vec2& b) {
      cuts = cuts || chord(cell, a, b, rounding * surface.size()).has_value();
    });
  });
  return cuts;
}

PanelCells panel_cells(const PanelSurface& surface, const Panel& panel, const PanelLines& lines, bool halved) {
  Cutter cutter(surface);
  for_each_cell(lines, [&](const std::array<Vec2, 4>& st) {
    const Polygon cell = outline(surface, st);
    if (!halved) {
      if (!open_at(panel, cell)) cutter.whole(st);
      return;
    }
    for (const Polygon& part : cut_cell(panel, cell, rounding * surface.size()))
      if (!open_at(panel, part)) cutter.divided(part);
  });
  return std::move(cutter.result);
}

}  // namespace topple::structure
