// Shell panels in a standing frame: one element between the nodes that a panel hangs on, with the stiffness of its
// superelement.
#include <algorithm>

#include "failure/panel_demand.h"
#include "loads/placed_load.h"
#include "model/index_of.h"
#include "standing/shell_reading.h"
#include "standing/standing_state.h"

namespace topple::structure {

/// All that acts on a panel now.
PanelLoading StandingFrame::State::loading(PanelId panel) const {
  PanelLoading loading;
  loading.traction = loads.traction(panel);
  for (const auto& [key, contact] : contacts.all())
    if (contact.place.panel == panel) loading.forces.push_back({contact.place.point, contact.force});
  return loading;
}

std::optional<PanelStress> StandingFrame::State::stress(PanelId panel) const {
  if (!stands(panel) || !statics.stiff(panel)) return std::nullopt;
  const bool in_motion = moves(components.of(panel));
  if (const PanelSuperelement* shell = shells.of(panel)) {
    const PanelLoading all = parts.bearings.serves(panel) ? PanelLoading{} : loading(panel);
    return shell->worst_stress(
        in_motion ? node_displacements(building[panel], *motion) : node_displacements(building[panel], statics), all);
  }
  return mean_membrane_stress(building, panel, in_motion ? motion->corner_forces(panel) : statics.corner_forces(panel));
}

void StandingFrame::State::replace_stiffness(PanelId panel, const Eigen::MatrixXd& before) {
  const Eigen::MatrixXd now = shells.of(panel)->stiffness();
  account.change(panel).soften(panel, before - now);
  statics.set_stiffness(panel, now);
}

void StandingFrame::State::fracture_shell(PanelId panel, const PanelRemains& remains) {
  parts.bearings.fracture(panel, remains.edge_length);
  const TributaryLoads before = loads.handed(panel);
  const Eigen::MatrixXd stiffness = shells.of(panel)->stiffness();
  if (motion) motion->remember_motion(panel);
  shells.of(panel)->fracture(remains);
  replace_stiffness(panel, stiffness);
  loads.fracture(panel, remains);
  if (motion) motion->update_mass(panel);
  account.change(panel).lighten(panel, before, loads.handed(panel));
  contacts.place_again(panel);
  let_go_of_bare_nodes(panel);
  to_check[static_cast<std::size_t>(components.of(panel))] = 1;
  break_bare_edges(panel, remains);
}

/// Those of the edge at nodes of the building; what lies between them is within the panel.
void StandingFrame::State::lose_edge_supports(PanelId panel, int edge) {
  const auto e = static_cast<std::size_t>(edge);
  for (std::size_t s = 0; s < building.edge_supports.size(); ++s) {
    if (building.edge_supports[s].panel != panel || building.edge_supports[s].edge != edge) continue;
    parts.segments.remove_support(panel);
    std::vector<NodeId> held = building[panel].edge_nodes[e];
    for (const std::size_t corner : {e, (e + 1) % 4}) held.push_back(building[panel].nodes[corner]);
    for (const NodeId node : held) {
      if (node_solved[index_of(node)]) account.change(node).lose_support(node, statics.reaction(node, s));
      statics.remove_support(node, s);
    }
  }
}

/// An edge lets go of its supports, and of the members and panels along it.
void StandingFrame::State::lose_shell_edge(PanelId panel, int edge) {
  parts.segments.break_joint(building.joint(panel, edge));
  lose_edge_supports(panel, edge);
  if (parts.segments.label(panel) >= 0 && statics.stiff(panel)) {
    const Eigen::MatrixXd before = shells.of(panel)->stiffness();
    if (motion) motion->remember_motion(panel);
    shells.of(panel)->release_edge(edge);
    replace_stiffness(panel, before);
    if (motion) motion->update_mass(panel);
    hand_on_anew(panel);
    contacts.place_again(panel);
    let_go_of_bare_nodes(panel);
  }
  to_check[static_cast<std::size_t>(components.of(panel))] = 1;
}

/// The panel stands no more: its stiffness and its load go with it.
void StandingFrame::State::leave_shell(PanelId panel) {
  if (statics.stiff(panel)) {
    account.change(panel).lose_membrane(panel);
    statics.remove_membrane(panel);
    if (motion) motion->update_mass(panel);
  }
  for (int edge = 0; edge < 4; ++edge) lose_edge_supports(panel, edge);
  account.change(panel).hand_on(panel);
  loads.remove(panel);
  for (int edge = 0; edge < 4; ++edge) joints.lose(building.joint(panel, edge));
  let_go_of_bare_nodes(panel);
  to_check[static_cast<std::size_t>(components.of(panel))] = 1;
}

/// Where nothing of the panel is left it holds nothing together; nodes without anything else leave the solver, which
/// has no stiffness for them.
void StandingFrame::State::let_go_of_bare_nodes(PanelId panel) {
  const std::vector<NodeId> nodes = building[panel].all_nodes();
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (statics.stiff(panel) && shells.of(panel)->stands_at(n)) continue;
    parts.segments.detach(panel, nodes[n]);
    if (!node_solved[index_of(nodes[n])] || parts.segments.degree(nodes[n]) > 0) continue;
    take(parts.bearings.bare(nodes[n]), nullptr);
    account.change(nodes[n]).drop(nodes[n]);
    drop_node(nodes[n]);
  }
}

/// A shell between what moves and what stands lets go of what moves; one of which all moves lets go of what stands.
void StandingFrame::State::release_moving_shells(const std::vector<NodeId>& moving) {
  std::vector<char> moves(building.nodes.size(), 0);
  for (const NodeId node : moving) moves[index_of(node)] = 1;
  for (std::size_t p = 0; p < building.panels.size(); ++p) {
    const PanelId panel(p);
    if (parts.bearings.serves(panel) || parts.segments.label(panel) < 0) continue;
    const std::vector<NodeId> nodes = building.panels[p].all_nodes();
    bool any = false, all = true;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      if (!shells.of(panel)->stands_at(n)) continue;
      any = any || moves[index_of(nodes[n])];
      all = all && moves[index_of(nodes[n])];
    }
    if (!any) continue;
    for (int edge = 0; edge < 4; ++edge) {
      const auto e = static_cast<std::size_t>(edge);
      std::vector<NodeId> on_edge = building.panels[p].edge_nodes[e];
      for (const std::size_t corner : {e, (e + 1) % 4}) on_edge.push_back(building.panels[p].nodes[corner]);
      if (std::any_of(on_edge.begin(), on_edge.end(), [&](NodeId node) { return (moves[index_of(node)] != 0) != all; }))
        break_joint(building.joint(panel, edge), BreakCause::overload);
    }
    if (!all) continue;
    for (const EdgeSupport& support : building.edge_supports)  // what moves stands on nothing
      if (support.panel == panel) break_joint(building.joint(panel, support.edge), BreakCause::overload);
  }
}

}  // namespace topple::structure
