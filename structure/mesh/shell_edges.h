#pragma once
// Where a shell panel hangs: by each edge on the nodes that it shares there (join_shells.h) and on the edge's corners.
#include <algorithm>
#include <vector>

#include "topple/structure/building.h"

namespace topple::structure {

/// Two shells with two corners of an edge in common share it, whatever their mesh.
[[nodiscard]] inline bool borders_shell(const Building& building, PanelId panel, int edge) {
  const auto& own = building[panel].nodes;
  const auto e = static_cast<std::size_t>(edge);
  for (std::size_t p = 0; p < building.panels.size(); ++p) {
    if (PanelId(p) == panel || building.panels[p].model != PanelModel::shell) continue;
    const auto& nodes = building.panels[p].nodes;
    const auto has = [&](NodeId node) { return std::find(nodes.begin(), nodes.end(), node) != nodes.end(); };
    if (has(own[e]) && has(own[(e + 1) % 4])) return true;
  }
  return false;
}

/// A support, a member or another shell lies along an edge of a shell.
[[nodiscard]] inline bool edge_bears(const Building& building, PanelId panel, int edge) {
  return building[panel].joined[static_cast<std::size_t>(edge)] ||
         std::any_of(building.edge_supports.begin(), building.edge_supports.end(),
                     [&](const EdgeSupport& support) { return support.panel == panel && support.edge == edge; });
}

/// Nodes that a shell hangs on by the joint of this edge. A corner belongs to those of its two edges that something
/// lies along, to both where that is so for neither.
[[nodiscard]] inline std::vector<NodeId> nodes_of_edge(const Building& building, PanelId panel, int edge) {
  const Panel& own = building[panel];
  std::vector<NodeId> nodes;
  const auto add_corner = [&](int corner, int other) {
    if (edge_bears(building, panel, edge) || !edge_bears(building, panel, other))
      nodes.push_back(own.nodes[static_cast<std::size_t>(corner)]);
  };
  add_corner(edge, (edge + 3) % 4);
  add_corner((edge + 1) % 4, (edge + 1) % 4);
  const auto& inside = own.edge_nodes[static_cast<std::size_t>(edge)];
  nodes.insert(nodes.end(), inside.begin(), inside.end());
  return nodes;
}

/// The share of an edge in what a node on it does to the panel: a corner belongs to those of its two edges that
/// something lies along (`bears`), to both equally where that is so for both or for neither.
[[nodiscard]] inline double edge_share(const Panel& panel, const std::array<bool, 4>& bears, std::size_t edge,
                                       NodeId node) {
  for (const std::size_t corner : {edge, (edge + 1) % 4}) {
    if (node != panel.nodes[corner]) continue;
    const std::size_t other = corner == edge ? (edge + 3) % 4 : (edge + 1) % 4;
    return bears[edge] == bears[other] ? 0.5 : bears[edge] ? 1.0 : 0.0;
  }
  return bears[edge] ? 1 : 0;
}

}  // namespace topple::structure
