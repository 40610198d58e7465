#include "standing/damage/departures.h"

namespace topple::structure {

void Departures::follow(const PanelBearings::Changes& changes, std::vector<Detached>* leaving) {
  for (PanelId panel : changes.lost_membrane) {
    state_.account.change(panel).lose_membrane(panel);
    state_.statics.remove_membrane(panel);
  }
  for (PanelId panel : changes.lost_edge) {
    lose_edges(panel);
    state_.contacts.update_loads_on(panel);
  }
  for (PanelId panel : changes.fell) {
    lose_edges(panel);
    state_.contacts.drop(panel);
    detached_.emplace_back().panels.push_back(panel);
    if (state_.motion) detached_.back().motion = state_.motion_of(detached_.back());
  }
  for (const auto& [panel, part] : changes.carried_off) {
    state_.hand_on_anew(panel);
    state_.contacts.drop(panel);
    (*leaving)[static_cast<std::size_t>(part)].panels.push_back(panel);
  }
}

void Departures::lose_edges(PanelId panel) {
  state_.hand_on_anew(panel);
  for (int edge = 0; edge < 4; ++edge)
    if (!state_.parts.bearings.holds(panel)[static_cast<std::size_t>(edge)])
      state_.joints.lose(state_.building.joint(panel, edge));
  state_.check_again(state_.components.of(panel));
}

void Departures::lay_bare(NodeId node) {
  follow(state_.parts.bearings.bare(node));
  if (!state_.in_solver.holds(node)) return;
  state_.account.change(node).drop(node);
  state_.drop(node);
}

}  // namespace topple::structure
