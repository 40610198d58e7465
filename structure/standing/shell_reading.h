#pragma once
// What a shell panel's edges bear, read from what its nodes do.
#include <array>
#include <vector>

#include "failure/panel_bearings.h"
#include "standing/panel_superelement.h"

namespace topple::structure {

/// Of a panel's nodes (Panel::all_nodes()), by an answer or a response.
template <class Answer>
[[nodiscard]] std::vector<Vec6> node_displacements(const Panel& panel, const Answer& answer) {
  std::vector<Vec6> all;
  for (const NodeId node : panel.all_nodes()) all.push_back(answer.displacement(node));
  return all;
}

/// Per length of what is left of each edge, in its axes; `at_nodes` as above, `loading`: what acts on the panel itself.
[[nodiscard]] inline std::array<Vec6, 4> shell_edge_demands(const PanelSuperelement& shell,
                                                            const PanelBearings& bearings, PanelId panel,
                                                            const std::vector<Vec6>& at_nodes,
                                                            const PanelLoading& loading) {
  std::array<double, 4> length;
  for (int edge = 0; edge < 4; ++edge) length[static_cast<std::size_t>(edge)] = bearings.intact_length(panel, edge);
  return shell.edge_demands(at_nodes, loading, length);
}

}  // namespace topple::structure
