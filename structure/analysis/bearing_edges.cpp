#include "analysis/bearing_edges.h"

#include <algorithm>
#include <set>

#include "model/index_of.h"

namespace topple::structure {

namespace {

std::pair<int, int> ends_of(const Panel& panel, std::size_t edge) {
  return std::minmax(panel.nodes[edge].index, panel.nodes[(edge + 1) % 4].index);
}

}  // namespace

BearingEdges::BearingEdges(const Building& building, const Frame& frame, const EdgeMembers& members)
    : building_(building),
      frame_(frame),
      members_(members),
      panels_at_node_(frame.model.nodes.size(), 0),
      supported_(building.panels.size()) {
  for (std::size_t p = 0; p < building.panels.size(); ++p) {
    if (frame.meshes[p].elements.empty()) continue;
    std::set<int> on_edges;
    for (std::size_t edge = 0; edge < 4; ++edge) {
      ++between_[ends_of(building.panels[p], edge)];
      on_edges.insert(frame.meshes[p].edge_nodes[edge].begin(), frame.meshes[p].edge_nodes[edge].end());
    }
    for (const int node : on_edges) ++panels_at_node_[static_cast<std::size_t>(node)];
  }
  for (const EdgeSupport& support : building.edge_supports)
    supported_[index_of(support.panel)][static_cast<std::size_t>(support.edge)] = true;
}

bool BearingEdges::bears(PanelId shell, int edge) const {
  const auto e = static_cast<std::size_t>(edge);
  const Panel& panel = building_[shell];
  if (supported_[index_of(shell)][e] || !members_.of(shell, edge).empty()) return true;
  if (between_.at(ends_of(panel, e)) > 1) return true;
  // A node of the building or of another shell's edge between its corners.
  const auto& nodes = frame_.meshes[index_of(shell)].edge_nodes[e];
  return std::any_of(nodes.begin(), nodes.end(), [&](int node) {
    const auto n = static_cast<std::size_t>(node);
    const bool corner = std::find(panel.nodes.begin(), panel.nodes.end(), NodeId(n)) != panel.nodes.end();
    return !corner && (n < building_.nodes.size() || panels_at_node_[n] > 1);
  });
}

std::array<bool, 4> BearingEdges::of(PanelId shell) const {
  std::array<bool, 4> all{};
  for (int edge = 0; edge < 4; ++edge) all[static_cast<std::size_t>(edge)] = bears(shell, edge);
  return all;
}

}  // namespace topple::structure
