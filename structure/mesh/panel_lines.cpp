#include "mesh/panel_lines.h"

#include <algorithm>
#include <numeric>

namespace topple::structure {

namespace {

/// A node off an edge's line by less than this share of its length lies on it.
constexpr double on_line = 1e-6;

/// Adds a value unless a line is there already.
bool add_line(std::vector<double>& lines, double value) {
  const auto next = std::lower_bound(lines.begin(), lines.end(), value);
  if (next != lines.end() && *next - value < same_line) return false;
  if (next != lines.begin() && value - *(next - 1) < same_line) return false;
  lines.insert(next, value);
  return true;
}

/// Points sorted along global x, with the panel that brings each (or -1: a node of the building).
class Points {
 public:
  void add(const Vec3& place, int owner) { points_.push_back({place, owner}); }
  void sort() {
    std::sort(points_.begin(), points_.end(), [](const Point& a, const Point& b) {
      return std::make_tuple(a.place.x(), a.place.y(), a.place.z(), a.owner) <
             std::make_tuple(b.place.x(), b.place.y(), b.place.z(), b.owner);
    });
  }
  /// Calls take(along, owner) for each point on the line between a and b, ends included.
  template <class Take>
  void on(const Vec3& a, const Vec3& b, Take take) const {
    const Vec3 edge = b - a;
    const double length = edge.norm(), off = on_line * length;
    const double low = std::min(a.x(), b.x()) - off, high = std::max(a.x(), b.x()) + off;
    auto at =
        std::lower_bound(points_.begin(), points_.end(), low, [](const Point& p, double x) { return p.place.x() < x; });
    for (; at != points_.end() && at->place.x() <= high; ++at) {
      const Vec3 away = at->place - a;
      const double along = away.dot(edge) / (length * length);
      if (along < -on_line || along > 1 + on_line || (away - along * edge).norm() > off) continue;
      take(along, at->owner);
    }
  }

 private:
  struct Point {
    Vec3 place;
    int owner;
  };
  std::vector<Point> points_;
};

Points building_nodes(const Building& building) {
  Points points;
  for (const Node& node : building.nodes) points.add(node.position, -1);
  points.sort();
  return points;
}

/// The mesh's points on the edges of all panels.
Points edge_points(const Building& building, const std::vector<PanelLines>& all) {
  Points points;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const PanelSurface surface(building, building[all[k].panel]);
    for (std::size_t edge = 0; edge < 4; ++edge)
      for (const double line : all[k].at[edge % 2])
        points.add(surface.at(PanelSurface::on_edge(edge, PanelSurface::line_of(edge, line))), static_cast<int>(k));
  }
  points.sort();
  return points;
}

bool add_points(const PanelSurface& surface, const Points& points, PanelLines& lines) {
  bool changed = false;
  for (std::size_t edge = 0; edge < 4; ++edge)
    points.on(surface.corner(edge), surface.corner(edge + 1), [&](double along, int) {
      changed = add_line(lines.at[edge % 2], PanelSurface::line_of(edge, along)) || changed;
    });
  return changed;
}

/// First what cannot be moved, then the regular divisions.
PanelLines own_lines(const Building& building, PanelId id, const Points& nodes) {
  const Panel& panel = building[id];
  const PanelSurface surface(building, panel);
  PanelLines lines{id, {std::vector<double>{0, 1}, std::vector<double>{0, 1}}};
  add_points(surface, nodes, lines);
  for (const auto& opening : panel.openings)
    for (const Vec2& vertex : opening) {
      const Vec2 st = surface.parameters(vertex);
      for (int direction = 0; direction < 2; ++direction)
        if (st(direction) > 0 && st(direction) < 1)
          add_line(lines.at[static_cast<std::size_t>(direction)], st(direction));
    }
  for (std::size_t direction = 0; direction < 2; ++direction)
    for (int i = 1; i < panel.mesh[direction]; ++i)
      add_line(lines.at[direction], static_cast<double>(i) / panel.mesh[direction]);
  return lines;
}

}  // namespace

std::vector<PanelLines> panel_lines(const Building& building) {
  std::vector<PanelLines> all;
  const Points nodes = building_nodes(building);
  for (std::size_t p = 0; p < building.panels.size(); ++p)
    if (building.panels[p].model == PanelModel::shell) all.push_back(own_lines(building, PanelId(p), nodes));
  // Ends when no panel has a line that its neighbour lacks: lines only grow, and no nearer than same_line.
  for (bool changed = true; changed;) {
    changed = false;
    const Points points = edge_points(building, all);
    for (PanelLines& lines : all)
      changed = add_points(PanelSurface(building, building[lines.panel]), points, lines) || changed;
  }
  return all;
}

std::vector<int> connected_panels(const Building& building, const std::vector<PanelLines>& lines) {
  std::vector<int> parent(lines.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto find = [&](int v) {
    while (parent[static_cast<std::size_t>(v)] != v) v = parent[static_cast<std::size_t>(v)];
    return v;
  };
  const Points points = edge_points(building, lines);
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const PanelSurface surface(building, building[lines[k].panel]);
    for (std::size_t edge = 0; edge < 4; ++edge)
      points.on(surface.corner(edge), surface.corner(edge + 1), [&](double, int owner) {
        const int a = find(static_cast<int>(k)), b = find(owner);
        parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
      });
  }
  std::vector<int> number(lines.size());
  for (std::size_t k = 0; k < lines.size(); ++k) number[k] = find(static_cast<int>(k));
  return number;
}

}  // namespace topple::structure
