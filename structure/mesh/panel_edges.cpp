#include "mesh/panel_edges.h"

#include <algorithm>

#include "model/index_of.h"

namespace topple::structure {

namespace {

/// A node off an edge's line by less than this share of its length lies on it.
constexpr double on_line = 1e-6;

/// Nodes at the other ends of the members and shell edges at each node.
std::vector<std::vector<int>> neighbours(const Building& building) {
  std::vector<std::vector<int>> of(building.nodes.size());
  const auto join = [&](NodeId a, NodeId b) {
    of[index_of(a)].push_back(b.index);
    of[index_of(b)].push_back(a.index);
  };
  for (const Member& member : building.members) join(member.nodes[0], member.nodes[1]);
  for (const Panel& panel : building.panels)
    if (panel.model == PanelModel::shell)
      for (std::size_t i = 0; i < 4; ++i) join(panel.nodes[i], panel.nodes[(i + 1) % 4]);
  return of;
}

/// `given`: nodes on the edge that were found before.
std::vector<EdgeNode> nodes_on(const Building& building, const std::vector<std::vector<int>>& neighbours, NodeId a,
                               NodeId b, const std::vector<NodeId>& given) {
  const Vec3 start = building[a].position, edge = building[b].position - start;
  const double length = edge.norm();
  std::vector<EdgeNode> found{{0, a.index}, {1, b.index}};
  for (const NodeId node : given)
    found.push_back({(building[node].position - start).dot(edge) / (length * length), node.index});
  for (std::size_t next = 0; next < found.size(); ++next)
    for (const int node : neighbours[static_cast<std::size_t>(found[next].node)]) {
      const auto same = [&](const EdgeNode& known) { return known.node == node; };
      if (std::any_of(found.begin(), found.end(), same)) continue;
      const Vec3 away = building.nodes[static_cast<std::size_t>(node)].position - start;
      const double at = away.dot(edge) / (length * length);
      if (at > on_line && at < 1 - on_line && (away - at * edge).norm() <= on_line * length)
        found.push_back({at, node});
    }
  std::sort(found.begin(), found.end(),
            [](const EdgeNode& x, const EdgeNode& y) { return std::pair(x.at, x.node) < std::pair(y.at, y.node); });
  return found;
}

}  // namespace

PanelEdges::PanelEdges(const Building& building) : nodes_(4 * building.panels.size()) {
  const auto joined = neighbours(building);
  for (std::size_t p = 0; p < building.panels.size(); ++p) {
    const Panel& panel = building.panels[p];
    if (panel.model != PanelModel::shell) continue;
    for (std::size_t edge = 0; edge < 4; ++edge)
      nodes_[4 * p + edge] =
          nodes_on(building, joined, panel.nodes[edge], panel.nodes[(edge + 1) % 4], panel.edge_nodes[edge]);
  }
}

EdgePlace PanelEdges::position(PanelId panel, std::size_t edge, double along) const {
  const auto& all = nodes(panel, edge);
  std::size_t i = 0;
  while (i + 2 < all.size() && all[i + 1].at <= along) ++i;
  const double within = (along - all[i].at) / (all[i + 1].at - all[i].at);
  const EdgeSegment segment{all[i].node, all[i + 1].node};
  if (segment.first < segment.second) return {segment, within};
  return {{segment.second, segment.first}, 1 - within};
}

double PanelEdges::along(PanelId panel, std::size_t edge, const EdgePlace& place) const {
  const auto& all = nodes(panel, edge);
  const auto at = [&](int node) {
    return std::find_if(all.begin(), all.end(), [&](const EdgeNode& known) { return known.node == node; })->at;
  };
  const double from = at(place.segment.first), to = at(place.segment.second);
  return from + place.at * (to - from);
}

}  // namespace topple::structure
