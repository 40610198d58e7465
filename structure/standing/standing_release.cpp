// What hangs on nothing leaves a standing frame: parts without a support, members that can swing by themselves, posts
// without bracing, and the part of a mechanism that moves.
#include <algorithm>

#include "model/index_of.h"
#include "standing/standing_state.h"

namespace topple::structure {

void StandingFrame::State::release() {
  do {
    take_unanchored();
  } while (release_loose_members() || snap_unbraced());
}

void StandingFrame::State::take_unanchored() {
  const std::vector<Segmentation::Part> loose = parts.segments.take_unanchored();
  if (loose.empty()) return;
  std::vector<Detached> leaving(loose.size());
  const auto in = [](const auto& list, auto id) { return std::binary_search(list.begin(), list.end(), id); };
  const auto hang = [&](JointId joint) {
    const Joint& own = building[joint];
    const NodeId rigid_end = building[own.member].nodes[static_cast<std::size_t>(own.end)];
    for (std::size_t p = 0; p < loose.size(); ++p)
      if (in(loose[p].members, own.member) || in(loose[p].nodes, rigid_end)) {
        leaving[p].hinges.push_back(joint);
        return true;
      }
    return false;  // not yet
  };
  std::erase_if(hanging, hang);
  PanelBearings::Left left;
  for (std::size_t p = 0; p < loose.size(); ++p) {
    leaving[p].members = loose[p].members;
    leaving[p].nodes = loose[p].nodes;
    leaving[p].panels = loose[p].panels;
    for (MemberId member : loose[p].members) {
      left.members.emplace_back(member, static_cast<int>(p));
      leaving[p].mechanism = leaving[p].mechanism || in_mechanism[index_of(member)];
      if (const auto cut = cut_inside.extract(member)) leaving[p].cut = cut.mapped();
      contacts.drop(member);
      account.change(member).leave(member);
      statics.remove(member);
      for (int end = 0; end < 2; ++end) yielding.lose(building.joint(member, end), statics.component(member));
      to_check[static_cast<std::size_t>(statics.component(member))] = 1;
    }
    for (NodeId node : loose[p].nodes) {
      left.nodes.emplace_back(node, static_cast<int>(p));
      if (node_solved[index_of(node)]) account.change(node).leave(node);
      drop_node(node);
    }
  }
  for (const Segmentation::Part& part : loose)
    for (PanelId panel : part.panels) {
      contacts.drop(panel);
      leave_shell(panel);
    }
  take(parts.bearings.leave(left), &leaving);
  for (Detached& part : leaving) {
    std::sort(part.panels.begin(), part.panels.end());
    if (motion) part.motion = motion_of(part);
    detached.push_back(std::move(part));
  }
}

/// True when one was found: it is free now.
bool StandingFrame::State::release_loose_members() {
  std::sort(half_held.begin(), half_held.end());
  half_held.erase(std::unique(half_held.begin(), half_held.end()), half_held.end());
  bool found = false;
  for (MemberId member : std::exchange(half_held, {})) {
    if (!hangs_loose(building, parts.segments, member)) continue;
    in_mechanism[index_of(member)] = 1;
    const JointId first = building.joint(member, 0), second = building.joint(member, 1);
    let_hang(parts.segments.holds(first) ? first : second);
    found = true;
  }
  return found;
}

bool StandingFrame::State::snap_unbraced() {
  std::sort(unbraced.begin(), unbraced.end());
  unbraced.erase(std::unique(unbraced.begin(), unbraced.end()), unbraced.end());
  bool found = false;
  for (JointId joint : std::exchange(unbraced, {})) {
    if (!parts.standing(joint)) continue;
    break_joint(joint, BreakCause::bracing);
    found = true;
  }
  return found;
}

/// A joint by which what moves still hangs: the frame lets go of it. By the rule it goes on as a hinge, or breaks.
void StandingFrame::State::let_hang(JointId joint) {
  const Joint& own = building[joint];
  const bool turns = own.member.valid() && (own.stiffness.array() == 0).any() && (own.stiffness.array() != 0).any();
  if (rules.mechanism != MechanismRule::hinge || !turns) return break_joint(joint, BreakCause::overload);
  if (!parts.standing(joint)) return;
  hanging.push_back(joint);
  damage(joint, -1);
}

void StandingFrame::State::release_mechanism(const FrameMechanism& mechanism) {
  const MovingPart part = find_moving_part(building, parts.segments, mechanism);
  for (MemberId member : part.members) in_mechanism[index_of(member)] = 1;
  for (JointId joint : part.holds) let_hang(joint);
  release_moving_shells(part.nodes);
  for (NodeId node : part.nodes) {
    if (node_solved[index_of(node)]) account.change(node).lose_support(node);
    parts.segments.remove_support(node);
    statics.remove_support(node);
  }
}

}  // namespace topple::structure
