// Shell panels in a standing frame: one element between four corners, with the stiffness of the panel's superelement.
#include <algorithm>

#include "index_of.h"
#include "panel_demand.h"
#include "placed_load.h"
#include "standing_state.h"

namespace topple::structure {

PlacedLoad StandingFrame::State::place(const ContactPlace& place, const Vec3& force, const Vec3& moment) const {
  if (place.panel.valid() && !bearings.serves(place.panel)) return place_on_shell(place, force);
  return place_load(building, bearings, place, force, moment);
}

/// What the corners get of a force on the panel; the panel's own give is that with its corners held.
PlacedLoad StandingFrame::State::place_on_shell(const ContactPlace& place, const Vec3& force) const {
  const PanelSuperelement& shell = *shells.of(place.panel);
  PanelLoading loading;
  loading.forces.push_back({place.point, force});
  PlacedLoad placed;
  placed.panel = place.panel;
  placed.on_shell = {place.point, force};
  const std::array<Vec6, 4> corners = shell.corner_loads(loading);
  for (std::size_t corner = 0; corner < 4; ++corner)
    placed.nodes.emplace_back(building[place.panel].nodes[corner], corners[corner]);
  placed.bending_compliance = shell.compliance(loading.forces.front());
  return placed;
}

/// All that acts on a panel now.
PanelLoading StandingFrame::State::loading(PanelId panel) const {
  PanelLoading loading;
  loading.traction = loads.traction(panel);
  for (const auto& [key, contact] : contacts)
    if (contact.place.panel == panel) loading.forces.push_back({contact.place.point, contact.force});
  return loading;
}

std::array<Vec6, 4> StandingFrame::State::corner_displacements(PanelId panel) const {
  std::array<Vec6, 4> corners;
  for (std::size_t n = 0; n < 4; ++n) corners[n] = statics.displacement(building[panel].nodes[n]);
  return corners;
}

std::array<Vec6, 4> StandingFrame::State::shell_edge_demands(PanelId panel, const std::array<Vec6, 4>& corners,
                                                             const PanelLoading& loading) const {
  std::array<double, 4> length;
  for (int edge = 0; edge < 4; ++edge) length[static_cast<std::size_t>(edge)] = bearings.intact_length(panel, edge);
  return shells.of(panel)->edge_demands(corners, loading, length);
}

std::optional<PanelStress> StandingFrame::State::stress(PanelId panel) const {
  if (!stands(panel) || !statics.stiff(panel)) return std::nullopt;
  if (const PanelSuperelement* shell = shells.of(panel)) {
    const PanelLoading all = bearings.serves(panel) ? PanelLoading{} : loading(panel);
    return shell->worst_stress(corner_displacements(panel), all);
  }
  return mean_membrane_stress(building, panel, statics.corner_forces(panel));
}

void StandingFrame::State::replace_stiffness(PanelId panel, const Mat24& before) {
  const Mat24 now = shells.of(panel)->stiffness();
  account.soften(panel, before - now);
  statics.set_stiffness(panel, now);
}

void StandingFrame::State::fracture_shell(PanelId panel, const PanelRemains& remains) {
  bearings.fracture(panel, remains.edge_length);
  const HandOver before = loads.handed(panel);
  const Mat24 stiffness = shells.of(panel)->stiffness();
  shells.of(panel)->fracture(remains);
  replace_stiffness(panel, stiffness);
  loads.fracture(panel, remains);
  account.lightened(panel, before, loads.handed(panel));
  place_contacts_again(panel);
  drop_bare_corners(panel);
  to_check[static_cast<std::size_t>(statics.component(building[panel].nodes[0]))] = 1;
  std::vector<JointId> bare;
  for (int edge = 0; edge < 4; ++edge)
    if (holds(building.joint(panel, edge)) && remains.edge_length[static_cast<std::size_t>(edge)] <= 0)
      bare.push_back(building.joint(panel, edge));
  break_joints(bare, BreakCause::impact);
}

/// A supported edge lets go of its supports.
void StandingFrame::State::lose_shell_edge(PanelId panel, int edge) {
  segments.break_joint(building.joint(panel, edge));
  for (const EdgeSupport& support : building.edge_supports) {
    if (support.panel != panel || support.edge != edge) continue;
    segments.remove_support(panel);
    const Mat24 before = shells.of(panel)->stiffness();
    shells.of(panel)->release_edge(edge);
    replace_stiffness(panel, before);
    for (const int corner : {edge, (edge + 1) % 4}) {
      const NodeId node = building[panel].nodes[static_cast<std::size_t>(corner)];
      if (node_solved[index_of(node)]) account.lose_support(node);
      statics.remove_support(node);
    }
    hand_on_anew(panel);
  }
  to_check[static_cast<std::size_t>(statics.component(building[panel].nodes[0]))] = 1;
}

/// The panel stands no more: its stiffness and its load go with it.
void StandingFrame::State::leave_shell(PanelId panel) {
  if (statics.stiff(panel)) {
    account.lose_membrane(panel);
    statics.remove_membrane(panel);
  }
  account.hand_on(panel);
  loads.remove(panel);
  for (int edge = 0; edge < 4; ++edge) joints.lose(building.joint(panel, edge));
  drop_bare_corners(panel);
  to_check[static_cast<std::size_t>(statics.component(building[panel].nodes[0]))] = 1;
}

/// Corners at which nothing of the panel is left, nor anything else: the solver has no stiffness for them.
void StandingFrame::State::drop_bare_corners(PanelId panel) {
  for (int corner = 0; corner < 4; ++corner) {
    const NodeId node = building[panel].nodes[static_cast<std::size_t>(corner)];
    const bool here = segments.label(panel) >= 0 && shells.of(panel)->corner_stands(corner);
    if (here || !node_solved[index_of(node)]) continue;
    int others = segments.degree(node);
    for (int edge = 0; edge < 4; ++edge)
      if ((edge == corner || (edge + 1) % 4 == corner) && segments.holds(building.joint(panel, edge))) --others;
    if (others > 0) continue;
    account.drop(node);
    drop_node(node);
  }
}

}  // namespace topple::structure
