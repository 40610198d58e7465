#include "mesh/panel_lines.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace topple::structure {

namespace {

/// Adds a value unless one is there already, nearer than `apart`.
bool add_line(std::vector<double>& lines, double value, double apart = same_line) {
  const auto next = std::lower_bound(lines.begin(), lines.end(), value);
  if (next != lines.end() && *next - value < apart) return false;
  if (next != lines.begin() && value - *(next - 1) < apart) return false;
  lines.insert(next, value);
  return true;
}

/// First what cannot be moved, then the regular divisions.
PanelLines own_lines(const Building& building, const PanelEdges& edges, PanelId id) {
  const Panel& panel = building[id];
  const PanelSurface surface(building, panel);
  PanelLines lines{id, {std::vector<double>{0, 1}, std::vector<double>{0, 1}}};
  for (std::size_t edge = 0; edge < 4; ++edge)
    for (const EdgeNode& node : edges.nodes(id, edge))
      add_line(lines.at[edge % 2], PanelSurface::line_of(edge, node.at));
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

using SegmentLines = std::map<EdgeSegment, std::vector<double>>;

/// Where lines of any panel meet each segment of the edges.
SegmentLines lines_on_segments(const PanelEdges& edges, const std::vector<PanelLines>& all) {
  SegmentLines segments;
  for (const PanelLines& lines : all)
    for (std::size_t edge = 0; edge < 4; ++edge)
      for (const double line : lines.at[edge % 2]) {
        const EdgePlace place = edges.position(lines.panel, edge, PanelSurface::line_of(edge, line));
        add_line(segments[place.segment], place.at);
      }
  return segments;
}

bool adopt_lines(const PanelEdges& edges, const SegmentLines& segments, PanelLines& lines) {
  bool changed = false;
  for (std::size_t edge = 0; edge < 4; ++edge) {
    const auto& nodes = edges.nodes(lines.panel, edge);
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
      const EdgeSegment segment = std::minmax(nodes[i].node, nodes[i + 1].node);
      const auto on_it = segments.find(segment);
      if (on_it == segments.end()) continue;  // rounding put the lines at its ends on its neighbours
      for (const double at : on_it->second) {
        const double along = edges.along(lines.panel, edge, {segment, at});
        changed = add_line(lines.at[edge % 2], PanelSurface::line_of(edge, along)) || changed;
      }
    }
  }
  return changed;
}

}  // namespace

std::vector<PanelLines> panel_lines(const Building& building, const PanelEdges& edges) {
  std::vector<PanelLines> all;
  for (std::size_t p = 0; p < building.panels.size(); ++p)
    if (building.panels[p].model == PanelModel::shell) all.push_back(own_lines(building, edges, PanelId(p)));
  // Ends when no panel has a line that its neighbour lacks: lines only grow, and no nearer than same_line.
  for (bool changed = true; changed;) {
    changed = false;
    const SegmentLines segments = lines_on_segments(edges, all);
    for (PanelLines& lines : all) changed = adopt_lines(edges, segments, lines) || changed;
  }
  return all;
}

std::vector<int> connected_panels(const PanelEdges& edges, const std::vector<PanelLines>& lines) {
  std::vector<int> parent(lines.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto find = [&](int v) {
    while (parent[static_cast<std::size_t>(v)] != v) v = parent[static_cast<std::size_t>(v)];
    return v;
  };
  std::map<EdgeSegment, int> first;
  for (std::size_t k = 0; k < lines.size(); ++k)
    for (std::size_t edge = 0; edge < 4; ++edge) {
      const auto& nodes = edges.nodes(lines[k].panel, edge);
      for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
        const EdgeSegment segment = std::minmax(nodes[i].node, nodes[i + 1].node);
        const int a = find(static_cast<int>(k)), b = find(first.emplace(segment, static_cast<int>(k)).first->second);
        parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
      }
    }
  std::vector<int> number(lines.size());
  for (std::size_t k = 0; k < lines.size(); ++k) number[k] = find(static_cast<int>(k));
  return number;
}

}  // namespace topple::structure
