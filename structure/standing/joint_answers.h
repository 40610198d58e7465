#pragma once
// Static answers of a standing frame, component by component, and what its joints bear in them. While a collapse is
// under way an answer is brought up to date only where a joint may break next; whoever asks for more gets the rest of
// it.
#include <array>
#include <optional>
#include <vector>

#include "failure/edge_demands.h"
#include "standing/structural_state.h"
#include "standing/yielding_way.h"

namespace topple::structure {

class JointAnswers {
 public:
  /// Both must outlive it.
  JointAnswers(StructuralState& state, const YieldingWay& yielding);

  /// Components of at least this many nodes are brought up to date only where it may matter.
  void restrict_from(int nodes) { selective_from_ = nodes; }

  /// Solves where it may matter to what breaks next, and reads what the joints there bear.
  [[nodiscard]] std::optional<FrameMechanism> solve(int component);
  /// After contact loads or stiffness changed slowly; the answer is whole.
  [[nodiscard]] std::optional<FrameMechanism> solve_slow(int component);
  /// The rest of what solve() read.
  void complete(int component);
  /// For whoever asks from outside: demands that the answers of a collapse under way have left out. These go on from
  /// where they are, to the same bits.
  void evaluate_demands();
  /// Of all joints, from the answer solved last. `slow`: no sudden-loss factor acts on what has changed since.
  void read(int component, bool slow);
  /// What edges of panels bear in the motion now.
  void read_edges_in_motion(int component);
  /// The largest utilisations are remembered, for largest_utilisation_so_far().
  void remember(int component);
  /// Uses after a sudden loss count from references that have moved.
  void references_moved(int component);

  /// True when no joint of the component is over its capacity in the state solved last.
  [[nodiscard]] bool bears(int component) const;
  /// In the joint's axes; zero when it does not hold.
  [[nodiscard]] Vec6 demand(JointId joint) const;
  /// Read from the solver; the joint must hold.
  [[nodiscard]] Vec6 solved_demand(JointId joint) const;

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [state, yielding, edge_loads, demands_behind, selective_from] = *this;
    archive(edge_loads, demands_behind, selective_from);
  }

 private:
  class Watch;
  [[nodiscard]] bool may_restrict(int component) const;
  void read_edges(int component, bool slow, bool in_motion = false);
  [[nodiscard]] std::array<Vec6, 4> edge_demands(PanelId panel, bool in_motion = false) const;

  StructuralState& state_;
  const YieldingWay& yielding_;
  EdgeDemands edge_loads_;
  std::vector<char> demands_behind_;  ///< per component: those of some joints
  int selective_from_ = StandingFrame::default_selective_from;
};

}  // namespace topple::structure
