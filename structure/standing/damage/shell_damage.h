#pragma once
// Damage to shell panels of a standing frame: one element between the nodes that a panel hangs on, with the stiffness
// of its superelement.
#include "standing/damage/departures.h"

namespace topple::structure {

class ShellDamage {
 public:
  /// Both must outlive it.
  ShellDamage(StructuralState& state, Departures& departures) : state_(state), departures_(departures) {}

  /// Only this remains of a shell that stands.
  void fracture(PanelId panel, const PanelRemains& remains);
  /// An edge lets go of its supports, and of the members and panels along it.
  void lose_edge(PanelId panel, int edge);
  /// The panel stands no more: its stiffness and its load go with it.
  void leave(PanelId panel);

 private:
  void lose_edge_supports(PanelId panel, int edge);
  void let_go_of_bare_nodes(PanelId panel);

  StructuralState& state_;
  Departures& departures_;
};

}  // namespace topple::structure
