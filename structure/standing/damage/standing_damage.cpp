#include "standing/damage/standing_damage.h"

#include <algorithm>

namespace topple::structure {

namespace {

template <class Id>
std::vector<Id> in_order(std::vector<Id> ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

}  // namespace

StandingDamage::StandingDamage(const Parts& parts) : to_(parts) {
  if (to_.state.rules.bracing == BracingRule::classic) bracing_.emplace(to_.state.building);
}

void StandingDamage::break_joints(std::span<const JointId> together, BreakCause cause) {
  std::vector<JointId> broken;
  for (JointId joint : together)
    if (to_.state.parts.standing(joint)) broken.push_back(joint);
  const int first = static_cast<int>(to_.breaks.size());
  for (JointId joint : broken) to_.breaks.add(joint, cause);
  for (std::size_t i = 0; i < broken.size(); ++i) let_go(broken[i], first + static_cast<int>(i));
}

void StandingDamage::let_go(JointId joint, int line) {
  StructuralState& state = to_.state;
  const Joint& own = state.building[joint];
  if (own.member.valid()) {
    state.parts.segments.break_joint(joint);
    lose_member_joint(joint, line);
    return;
  }
  state.joints.lose(joint);
  if (state.parts.bearings.tracks(own.panel))
    to_.departures.follow(state.parts.bearings.break_edge(own.panel, own.end));
  else
    to_.shells.lose_edge(own.panel, own.end);
}

/// Everything but segmentation, which knows already.
void StandingDamage::lose_member_joint(JointId joint, int line) {
  StructuralState& state = to_.state;
  state.account.change(state.building[joint].member).lose_joint(joint, line);
  const Joint& own = state.building[joint];
  const NodeId node = state.building[own.member].nodes[static_cast<std::size_t>(own.end)];
  state.statics.break_joint(own.member, own.end);
  state.joints.lose(joint);
  to_.yielding.lose(joint, state.components.of(joint));
  state.check_again(state.components.of(joint));
  half_held_.push_back(own.member);
  if (bracing_) {
    const std::vector<JointId>& snapped = bracing_->lose(joint);
    unbraced_.insert(unbraced_.end(), snapped.begin(), snapped.end());
  }
  // A node without members: a support that bears nothing, or about to leave.
  if (state.parts.segments.degree(node) == 0) to_.departures.lay_bare(node);
}

std::vector<MemberId> StandingDamage::extract_half_held() { return in_order(std::exchange(half_held_, {})); }
std::vector<JointId> StandingDamage::extract_unbraced() { return in_order(std::exchange(unbraced_, {})); }

/// A membrane keeps what stiffness its remains have while all of its edges hold.
void StandingDamage::fracture(PanelId panel, const PanelRemains& remains) {
  StructuralState& state = to_.state;
  if (!state.parts.bearings.tracks(panel)) {
    to_.shells.fracture(panel, remains);
  } else {
    const bool membrane = state.parts.bearings.membrane(panel);
    state.parts.bearings.fracture(panel, remains.edge_length);
    const TributaryLoads before = state.loads.handed(panel);
    state.loads.fracture(panel, remains);
    state.account.change(panel).lighten(panel, before, state.loads.handed(panel));
    state.check_again(state.components.of(panel));
    if (membrane) condense(panel, remains);
  }
  break_bare_edges(panel, remains);
}

/// What is left of a membrane's stiffness.
void StandingDamage::condense(PanelId panel, const PanelRemains& remains) {
  StructuralState& state = to_.state;
  const PanelSuperelement* known = state.shells.of(panel);
  const Eigen::MatrixXd before = known ? known->stiffness() : Eigen::MatrixXd(state.statics.membrane_stiffness(panel));
  state.shells.make(panel).fracture(remains);
  state.update_stiffness(panel, before);
  to_.slow.soften();
}

/// Edges of which nothing is left let go suddenly; what changed slowly is laid before.
void StandingDamage::break_bare_edges(PanelId panel, const PanelRemains& remains) {
  std::vector<JointId> bare;
  for (int edge = 0; edge < 4; ++edge) {
    const JointId joint = to_.state.building.joint(panel, edge);
    if (to_.state.parts.holds(joint) && remains.edge_length[static_cast<std::size_t>(edge)] <= 0) bare.push_back(joint);
  }
  if (bare.empty()) return;
  to_.slow.lay();
  break_joints(bare, BreakCause::impact);
}

void StandingDamage::remove(MemberId member) {
  StructuralState& state = to_.state;
  if (!state.stands(member)) return;
  for (int end = 0; end < 2; ++end) {
    const JointId joint = state.building.joint(member, end);
    if (!state.parts.segments.holds(joint)) continue;
    state.parts.segments.break_joint(joint);
    lose_member_joint(joint, -1);
  }
  state.parts.segments.remove(member);
  state.account.change(member).leave(member);
  state.statics.remove(member);
  state.contacts.drop(member);
  to_.departures.follow(state.parts.bearings.leave({{{member, -1}}, {}}));
}

void StandingDamage::remove(PanelId panel) {
  StructuralState& state = to_.state;
  if (!state.stands(panel)) return;
  state.contacts.drop(panel);
  if (!state.parts.bearings.tracks(panel)) {
    state.parts.segments.remove(panel);
    to_.shells.leave(panel);
    return;
  }
  if (state.parts.bearings.membrane(panel)) {
    state.account.change(panel).lose_membrane(panel);
    state.statics.remove_membrane(panel);
  }
  state.parts.bearings.remove(panel);
  state.hand_on_anew(panel);
  for (int edge = 0; edge < 4; ++edge) state.joints.lose(state.building.joint(panel, edge));
  state.check_again(state.components.of(panel));
}

}  // namespace topple::structure
