#include "standing/joint_answers.h"

#include <algorithm>
#include <utility>

#include "failure/panel_demand.h"
#include "standing/joint_watch.h"
#include "standing/shell_reading.h"

namespace topple::structure {

JointAnswers::JointAnswers(StructuralState& state, const YieldingWay& yielding)
    : state_(state),
      yielding_(yielding),
      edge_loads_(state.building, state.parts.bearings, state.loads),
      demands_behind_(state.components.joints.size(), 0) {}

std::optional<FrameMechanism> JointAnswers::solve(int c) {
  if (!may_restrict(c)) {
    auto mechanism = state_.statics.solve(c);
    if (!mechanism) read(c, false);
    return mechanism;
  }
  state_.response.forget_bounds(c);
  Watch watch(*this);
  auto mechanism = state_.statics.solve(c, watch);
  if (!mechanism) {
    demands_behind_[static_cast<std::size_t>(c)] = state_.statics.partial(c);
    read_edges(c, false);
  }
  return mechanism;
}

std::optional<FrameMechanism> JointAnswers::solve_slow(int c) {
  if (!may_restrict(c)) {
    auto mechanism = state_.statics.solve(c);
    if (!mechanism) read(c, true);
    return mechanism;
  }
  state_.response.forget_bounds(c);
  Watch watch(*this, true);
  auto mechanism = state_.statics.solve(c, watch);
  if (mechanism) return mechanism;
  state_.statics.complete(c, watch);
  read_edges(c, true);
  return std::nullopt;
}

/// A way on which joints yield needs all of an answer, as do shells, whose edges bear what all of their nodes do; where
/// few nodes stand, telling apart what may matter costs more than a whole answer.
bool JointAnswers::may_restrict(int c) const {
  const FrameStatics& statics = state_.statics;
  return static_cast<int>(statics.nodes(c).size()) >= selective_from_ && !state_.rules.second_order &&
         !yielding_.any(c) && statics.shells(c).empty() && state_.parts.one_segment(statics.members(c));
}

void JointAnswers::complete(int c) {
  if (!state_.statics.partial(c)) return;
  demands_behind_[static_cast<std::size_t>(c)] = 0;
  Watch watch(*this);
  state_.statics.complete(c, watch);
  read_edges(c, false);
  remember(c);
}

void JointAnswers::evaluate_demands() {
  for (int c = 0; c < state_.statics.components(); ++c) {
    if (!std::exchange(demands_behind_[static_cast<std::size_t>(c)], 0)) continue;
    read(c, false);
    remember(c);
  }
}

void JointAnswers::remember(int c) {
  for (const JointId joint : state_.components.joints[static_cast<std::size_t>(c)])
    if (state_.parts.standing(joint)) (void)state_.joints.check(joint);
}

void JointAnswers::references_moved(int c) {
  if (state_.rules.sudden != 1) state_.statics.forget_references(c);
}

bool JointAnswers::bears(int c) const {
  const std::vector<JointId>& all = state_.components.joints[static_cast<std::size_t>(c)];
  return std::none_of(all.begin(), all.end(), [&](JointId joint) {
    return state_.parts.standing(joint) && state_.joints.utilisation(joint).value > 1;
  });
}

void JointAnswers::read(int c, bool slow) {
  const FrameStatics& statics = state_.statics;
  JointStates& joints = state_.joints;
  state_.response.forget_bounds(c);
  MemberId member_read;
  solver::Vec12 end_forces;
  for (JointId joint : state_.components.joints[static_cast<std::size_t>(c)]) {
    const Joint& own = state_.building[joint];
    if (!own.member.valid() || !state_.parts.standing(joint)) continue;
    if (own.member != member_read) end_forces = statics.end_forces(own.member);
    member_read = own.member;
    const Vec6 demand = member_joint_demand(end_forces, own.end);
    slow ? joints.set_slow_demand(joint, demand) : joints.set_demand(joint, demand);
  }
  for (const PanelId panel : statics.membranes(c))
    if (state_.parts.bearings.membrane(panel)) edge_loads_.set_corner_forces(panel, statics.corner_forces(panel));
  read_edges(c, slow);
}

void JointAnswers::read_edges_in_motion(int c) {
  for (const PanelId panel : state_.statics.membranes(c))
    if (state_.parts.bearings.membrane(panel))
      edge_loads_.set_corner_forces(panel, state_.motion->corner_forces(panel));
  read_edges(c, false, true);
}

/// Loads that panels hand on change without anything moving. Shells are read from what their corners do.
void JointAnswers::read_edges(int c, bool slow, bool in_motion) {
  PanelId panel_read;
  std::array<Vec6, 4> shell;
  const std::array<Vec6, 4>* of_edges = nullptr;
  for (JointId joint : state_.components.edges[static_cast<std::size_t>(c)]) {
    const Joint& own = state_.building[joint];
    if (own.panel != panel_read) {
      of_edges = nullptr;
      if (!state_.parts.bearings.tracks(own.panel)) {
        of_edges = &(shell = edge_demands(own.panel, in_motion));
      } else if (edge_loads_.changed(own.panel)) {
        of_edges = &edge_loads_.read(own.panel);
      }
    }
    panel_read = own.panel;
    if (of_edges == nullptr || !state_.parts.standing(joint)) continue;
    const Vec6& demand = (*of_edges)[static_cast<std::size_t>(own.end)];
    slow ? state_.joints.set_slow_demand(joint, demand) : state_.joints.set_demand(joint, demand);
  }
}

Vec6 JointAnswers::demand(JointId joint) const {
  if (!state_.parts.standing(joint)) return Vec6::Zero();
  return state_.building[joint].capacity.breakable ? state_.joints.demand(joint) : solved_demand(joint);
}

Vec6 JointAnswers::solved_demand(JointId joint) const {
  const Joint& own = state_.building[joint];
  if (own.member.valid()) return member_joint_demand(state_.statics.end_forces(own.member), own.end);
  return edge_demands(own.panel)[static_cast<std::size_t>(own.end)];
}

std::array<Vec6, 4> JointAnswers::edge_demands(PanelId panel, bool in_motion) const {
  const PanelBearings& bearings = state_.parts.bearings;
  if (!bearings.tracks(panel)) {
    const Panel& own = state_.building[panel];
    return shell_edge_demands(
        *state_.shells.of(panel), bearings, panel,
        in_motion ? node_displacements(own, *state_.motion) : node_displacements(own, state_.statics),
        state_.loading(panel));
  }
  return panel_edge_demands(
      state_.building, bearings, state_.loads, panel,
      bearings.membrane(panel) ? std::optional(state_.statics.corner_forces(panel)) : std::nullopt);
}

}  // namespace topple::structure
