#include "standing/damage/shell_damage.h"

namespace topple::structure {

void ShellDamage::fracture(PanelId panel, const PanelRemains& remains) {
  state_.parts.bearings.fracture(panel, remains.edge_length);
  const TributaryLoads before = state_.loads.handed(panel);
  const Eigen::MatrixXd stiffness = state_.shells.of(panel)->stiffness();
  if (state_.motion) state_.motion->remember_motion(panel);
  state_.shells.of(panel)->fracture(remains);
  state_.update_stiffness(panel, stiffness);
  state_.loads.fracture(panel, remains);
  if (state_.motion) state_.motion->update_mass(panel);
  state_.account.change(panel).lighten(panel, before, state_.loads.handed(panel));
  state_.contacts.update_loads_on(panel);
  let_go_of_bare_nodes(panel);
  state_.check_again(state_.components.of(panel));
}

/// Those of the edge at nodes of the building; what lies between them is within the panel.
void ShellDamage::lose_edge_supports(PanelId panel, int edge) {
  const auto e = static_cast<std::size_t>(edge);
  const std::vector<EdgeSupport>& supports = state_.building.edge_supports;
  const Panel& own = state_.building[panel];
  for (std::size_t s = 0; s < supports.size(); ++s) {
    if (supports[s].panel != panel || supports[s].edge != edge) continue;
    state_.parts.segments.remove_support(panel);
    std::vector<NodeId> held = own.edge_nodes[e];
    for (const std::size_t corner : {e, (e + 1) % 4}) held.push_back(own.nodes[corner]);
    for (const NodeId node : held) {
      if (state_.in_solver.holds(node))
        state_.account.change(node).lose_support(node, state_.statics.reaction(node, s));
      state_.statics.remove_support(node, s);
    }
  }
}

void ShellDamage::lose_edge(PanelId panel, int edge) {
  state_.parts.segments.break_joint(state_.building.joint(panel, edge));
  lose_edge_supports(panel, edge);
  if (state_.parts.segments.label(panel) >= 0 && state_.statics.stiff(panel)) {
    const Eigen::MatrixXd before = state_.shells.of(panel)->stiffness();
    if (state_.motion) state_.motion->remember_motion(panel);
    state_.shells.of(panel)->release_edge(edge);
    state_.update_stiffness(panel, before);
    if (state_.motion) state_.motion->update_mass(panel);
    state_.hand_on_anew(panel);
    state_.contacts.update_loads_on(panel);
    let_go_of_bare_nodes(panel);
  }
  state_.check_again(state_.components.of(panel));
}

void ShellDamage::leave(PanelId panel) {
  if (state_.statics.stiff(panel)) {
    state_.account.change(panel).lose_membrane(panel);
    state_.statics.remove_membrane(panel);
    if (state_.motion) state_.motion->update_mass(panel);
  }
  for (int edge = 0; edge < 4; ++edge) lose_edge_supports(panel, edge);
  state_.account.change(panel).hand_on(panel);
  state_.loads.remove(panel);
  for (int edge = 0; edge < 4; ++edge) state_.joints.lose(state_.building.joint(panel, edge));
  let_go_of_bare_nodes(panel);
  state_.check_again(state_.components.of(panel));
}

/// Where nothing of the panel is left it holds nothing together; nodes without anything else leave the solver, which
/// has no stiffness for them.
void ShellDamage::let_go_of_bare_nodes(PanelId panel) {
  const std::vector<NodeId> nodes = state_.building[panel].all_nodes();
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (state_.statics.stiff(panel) && state_.shells.of(panel)->stands_at(n)) continue;
    state_.parts.segments.detach(panel, nodes[n]);
    if (!state_.in_solver.holds(nodes[n]) || state_.parts.segments.degree(nodes[n]) > 0) continue;
    departures_.lay_bare(nodes[n]);
  }
}

}  // namespace topple::structure
