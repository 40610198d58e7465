#pragma once
// Where a shell panel hangs: by each edge on the nodes that it shares there (join_shells.h) and on the edge's corners.
#include <algorithm>
#include <vector>

#include "topple/structure/building.h"

namespace topple::structure {

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

}  // namespace topple::structure
