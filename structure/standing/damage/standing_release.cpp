#include "standing/damage/standing_release.h"

#include <algorithm>
#include <utility>

#include "failure/moving_part.h"
#include "loads/placed_load.h"
#include "model/index_of.h"

namespace topple::structure {

void StandingRelease::release() {
  do {
    extract_unanchored();
  } while (release_loose_members() || snap_unbraced());
}

void StandingRelease::extract_unanchored() {
  StructuralState& state = to_.state;
  const std::vector<Segmentation::Part> loose = state.parts.segments.extract_unanchored();
  if (loose.empty()) return;
  std::vector<Detached> leaving(loose.size());
  const auto in = [](const auto& list, auto id) { return std::binary_search(list.begin(), list.end(), id); };
  const auto hang = [&](JointId joint) {
    const Joint& own = state.building[joint];
    const NodeId rigid_end = state.building[own.member].nodes[static_cast<std::size_t>(own.end)];
    for (std::size_t p = 0; p < loose.size(); ++p)
      if (in(loose[p].members, own.member) || in(loose[p].nodes, rigid_end)) {
        leaving[p].hinges.push_back(joint);
        return true;
      }
    return false;  // not yet
  };
  std::erase_if(hanging_, hang);
  leave(loose, leaving);
  for (Detached& part : leaving) {
    std::sort(part.panels.begin(), part.panels.end());
    if (state.motion) part.motion = state.motion_of(part);
    to_.departures.add(std::move(part));
  }
}

/// `leaving`: what is handed out of each part.
void StandingRelease::leave(const std::vector<Segmentation::Part>& loose, std::vector<Detached>& leaving) {
  StructuralState& state = to_.state;
  PanelBearings::Left left;
  for (std::size_t p = 0; p < loose.size(); ++p) {
    leaving[p].members = loose[p].members;
    leaving[p].nodes = loose[p].nodes;
    leaving[p].panels = loose[p].panels;
    for (MemberId member : loose[p].members) {
      left.members.emplace_back(member, static_cast<int>(p));
      leaving[p].mechanism = leaving[p].mechanism || in_mechanism_[index_of(member)];
      if (const auto cut = cut_inside_.extract(member)) leaving[p].cut = cut.mapped();
      state.contacts.drop(member);
      state.account.change(member).leave(member);
      state.statics.remove(member);
      for (int end = 0; end < 2; ++end)
        to_.yielding.lose(state.building.joint(member, end), state.statics.component(member));
      state.check_again(state.statics.component(member));
    }
    for (NodeId node : loose[p].nodes) {
      left.nodes.emplace_back(node, static_cast<int>(p));
      if (state.in_solver.holds(node)) state.account.change(node).leave(node);
      state.drop(node);
    }
  }
  for (const Segmentation::Part& part : loose)
    for (PanelId panel : part.panels) {
      state.contacts.drop(panel);
      to_.shells.leave(panel);
    }
  to_.departures.follow(state.parts.bearings.leave(left), &leaving);
}

/// True when one was found: it is free now.
bool StandingRelease::release_loose_members() {
  const StructuralState& state = to_.state;
  bool found = false;
  for (MemberId member : to_.damage.extract_half_held()) {
    if (!hangs_loose(state.building, state.parts.segments, member)) continue;
    in_mechanism_[index_of(member)] = 1;
    const JointId first = state.building.joint(member, 0), second = state.building.joint(member, 1);
    let_hang(state.parts.segments.holds(first) ? first : second);
    found = true;
  }
  return found;
}

bool StandingRelease::snap_unbraced() {
  bool found = false;
  for (JointId joint : to_.damage.extract_unbraced()) {
    if (!to_.state.parts.standing(joint)) continue;
    to_.damage.break_joint(joint, BreakCause::bracing);
    found = true;
  }
  return found;
}

/// A joint by which what moves still hangs: the frame lets go of it. By the rule it goes on as a hinge, or breaks.
void StandingRelease::let_hang(JointId joint) {
  const Joint& own = to_.state.building[joint];
  const bool turns = own.member.valid() && (own.stiffness.array() == 0).any() && (own.stiffness.array() != 0).any();
  if (to_.state.rules.mechanism != MechanismRule::hinge || !turns)
    return to_.damage.break_joint(joint, BreakCause::overload);
  if (!to_.state.parts.standing(joint)) return;
  hanging_.push_back(joint);
  to_.damage.let_go(joint);
}

void StandingRelease::cut_free(const FrameMechanism& mechanism) {
  StructuralState& state = to_.state;
  const MovingPart part = find_moving_part(state.building, state.parts.segments, mechanism);
  for (MemberId member : part.members) in_mechanism_[index_of(member)] = 1;
  for (JointId joint : part.holds) let_hang(joint);
  release_moving_shells(part.nodes);
  for (NodeId node : part.nodes) {
    if (state.in_solver.holds(node)) state.account.change(node).lose_support(node);
    state.parts.segments.remove_support(node);
    state.statics.remove_support(node);
  }
}

/// A shell between what moves and what stands lets go of what moves; one of which all moves lets go of what stands.
void StandingRelease::release_moving_shells(const std::vector<NodeId>& moving) {
  const StructuralState& state = to_.state;
  const Building& building = state.building;
  std::vector<char> moves(building.nodes.size(), 0);
  for (const NodeId node : moving) moves[index_of(node)] = 1;
  for (std::size_t p = 0; p < building.panels.size(); ++p) {
    const PanelId panel(p);
    if (state.parts.bearings.tracks(panel) || state.parts.segments.label(panel) < 0) continue;
    const std::vector<NodeId> nodes = building.panels[p].all_nodes();
    bool any = false, all = true;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      if (!state.shells.of(panel)->stands_at(n)) continue;
      any = any || moves[index_of(nodes[n])];
      all = all && moves[index_of(nodes[n])];
    }
    if (!any) continue;
    for (int edge = 0; edge < 4; ++edge) {
      const auto e = static_cast<std::size_t>(edge);
      std::vector<NodeId> on_edge = building.panels[p].edge_nodes[e];
      for (const std::size_t corner : {e, (e + 1) % 4}) on_edge.push_back(building.panels[p].nodes[corner]);
      if (std::any_of(on_edge.begin(), on_edge.end(), [&](NodeId node) { return (moves[index_of(node)] != 0) != all; }))
        to_.damage.break_joint(building.joint(panel, edge), BreakCause::overload);
    }
    if (!all) continue;
    for (const EdgeSupport& support : building.edge_supports)  // what moves stands on nothing
      if (support.panel == panel) to_.damage.break_joint(building.joint(panel, support.edge), BreakCause::overload);
  }
}

void StandingRelease::cut_in_two(MemberId post, double inside) {
  const StructuralState& state = to_.state;
  if (!state.stands(post)) return;
  JointBreak broken;
  broken.joint = state.building.joint(post, 0);
  broken.cause = BreakCause::buckling;
  broken.position = on_axis(state.building, post, inside * state.building[post].length);
  broken.inside = inside;
  int line = static_cast<int>(to_.breaks.size());
  to_.breaks.add(broken);
  cut_inside_[post] = inside;
  for (int end = 0; end < 2; ++end) {
    const JointId joint = state.building.joint(post, end);
    if (!state.parts.holds(joint)) continue;
    hanging_.push_back(joint);
    to_.damage.let_go(joint, std::exchange(line, -1));  // what the other end frees is counted with it
  }
}

}  // namespace topple::structure
