// Damage to a standing frame: each change told to segmentation, parts.bearings, loads, solver and joints alike.
#include "loads/placed_load.h"
#include "model/index_of.h"
#include "standing/standing_state.h"

namespace topple::structure {

namespace {

template <class... Handlers>
struct Overloaded : Handlers... {
  using Handlers::operator()...;
};

}  // namespace

void StandingFrame::State::apply(const Change& change) {
  std::visit(Overloaded{[&](const BreakJoint& one) { break_joint(one.joint, one.cause); },
                        [&](MemberId member) { remove(member); }, [&](PanelId panel) { remove(panel); },
                        [&](const RemoveSupport& one) {
                          if (node_solved[index_of(one.node)]) account.change(one.node).lose_support(one.node);
                          parts.segments.remove_support(one.node);
                          statics.remove_support(one.node);
                        },
                        [&](const EventLoad& one) {
                          if (node_solved[index_of(one.node)]) account.change(one.node).add_load(one.node, one.load);
                          loads.add_load(one.node, one.load);
                        },
                        [&](const Gravity& one) {
                          account.turn_gravity();
                          loads.set_gravity(one.gravity);
                          account.gravity_turned(one.gravity);
                          gravity = one.gravity;
                        }},
             change);
}

void StandingFrame::State::break_joint(JointId joint, BreakCause cause) {
  const JointId one[] = {joint};
  break_joints(one, cause);
}

/// Together: each is told as it was before any of them broke.
void StandingFrame::State::break_joints(std::span<const JointId> together, BreakCause cause) {
  std::vector<JointId> broken;
  for (JointId joint : together)
    if (parts.standing(joint)) broken.push_back(joint);
  const int first = static_cast<int>(breaks.size());
  for (JointId joint : broken) tell(joint, cause);
  for (std::size_t i = 0; i < broken.size(); ++i) damage(broken[i], first + static_cast<int>(i));
}

void StandingFrame::State::tell(JointId joint, BreakCause cause) {
  const Utilisation used = joints.check(joint);
  JointBreak broken;
  broken.joint = joint;
  broken.cause = cause;
  broken.sense = used.sense;
  broken.demand = used.demand;
  broken.capacity = used.capacity;
  broken.generation = generation;
  broken.position = parts.position(joint);
  breaks.push_back(broken);
}

void StandingFrame::State::damage(JointId joint, int told) {
  const Joint& own = building[joint];
  if (own.member.valid()) {
    parts.segments.break_joint(joint);
    lose_member_joint(joint, told);
    return;
  }
  joints.lose(joint);
  if (parts.bearings.serves(own.panel))
    take(parts.bearings.break_edge(own.panel, own.end), nullptr);
  else
    lose_shell_edge(own.panel, own.end);
}

/// Everything but segmentation, which knows already.
void StandingFrame::State::lose_member_joint(JointId joint, int told) {
  account.change(building[joint].member).lose_joint(joint, told);
  const Joint& own = building[joint];
  const NodeId node = building[own.member].nodes[static_cast<std::size_t>(own.end)];
  statics.break_joint(own.member, own.end);
  joints.lose(joint);
  yielding.lose(joint, components.of(joint));
  to_check[static_cast<std::size_t>(components.of(joint))] = 1;
  half_held.push_back(own.member);
  if (bracing) {
    const std::vector<JointId>& snapped = bracing->lose(joint);
    unbraced.insert(unbraced.end(), snapped.begin(), snapped.end());
  }
  if (parts.segments.degree(node) > 0) return;
  // A node without members: a support that bears nothing, or about to leave. The solver has no stiffness for it.
  take(parts.bearings.bare(node), nullptr);
  if (!node_solved[index_of(node)]) return;
  account.change(node).drop(node);
  drop_node(node);
}

void StandingFrame::State::drop_node(NodeId node) {
  if (!node_solved[index_of(node)]) return;
  contacts.drop(node);
  node_solved[index_of(node)] = 0;
  --solved_nodes[static_cast<std::size_t>(statics.component(node))];
  statics.drop({node});
}

void StandingFrame::State::hand_on_anew(PanelId panel) {
  account.change(panel).hand_on(panel);
  loads.hand_on_anew(panel);
}

/// `leaving`: those that leave in the same change, by their numbers.
void StandingFrame::State::take(const PanelBearings::Changes& changes, std::vector<Detached>* leaving) {
  for (PanelId panel : changes.lost_membrane) {
    account.change(panel).lose_membrane(panel);
    statics.remove_membrane(panel);
  }
  const auto settle_edges = [&](PanelId panel) {
    hand_on_anew(panel);
    for (int edge = 0; edge < 4; ++edge)
      if (!parts.bearings.holds(panel)[static_cast<std::size_t>(edge)]) joints.lose(building.joint(panel, edge));
    to_check[static_cast<std::size_t>(components.of(panel))] = 1;
  };
  for (PanelId panel : changes.lost_edge) {
    settle_edges(panel);
    contacts.place_again(panel);
  }
  for (PanelId panel : changes.fell) {
    settle_edges(panel);
    contacts.drop(panel);
    detached.emplace_back().panels.push_back(panel);
    if (motion) detached.back().motion = motion_of(detached.back());
  }
  for (const auto& [panel, part] : changes.carried_off) {
    hand_on_anew(panel);
    contacts.drop(panel);
    (*leaving)[static_cast<std::size_t>(part)].panels.push_back(panel);
  }
}

/// A membrane keeps what stiffness its remains have while all of its edges hold.
void StandingFrame::State::fracture(PanelId panel, const PanelRemains& remains) {
  if (!parts.bearings.serves(panel)) return fracture_shell(panel, remains);
  const bool membrane = parts.bearings.membrane(panel);
  parts.bearings.fracture(panel, remains.edge_length);
  const TributaryLoads before = loads.handed(panel);
  loads.fracture(panel, remains);
  account.change(panel).lighten(panel, before, loads.handed(panel));
  to_check[static_cast<std::size_t>(components.of(panel))] = 1;
  if (membrane) condense(panel, remains);
  break_bare_edges(panel, remains);
}

/// What is left of a membrane's stiffness.
void StandingFrame::State::condense(PanelId panel, const PanelRemains& remains) {
  const PanelSuperelement* known = shells.of(panel);
  const Eigen::MatrixXd before = known ? known->stiffness() : Eigen::MatrixXd(statics.membrane_stiffness(panel));
  shells.make(panel).fracture(remains);
  replace_stiffness(panel, before);
  softened = true;
}

/// Edges of which nothing is left let go suddenly; what changed slowly is laid before.
void StandingFrame::State::break_bare_edges(PanelId panel, const PanelRemains& remains) {
  std::vector<JointId> bare;
  for (int edge = 0; edge < 4; ++edge)
    if (parts.holds(building.joint(panel, edge)) && remains.edge_length[static_cast<std::size_t>(edge)] <= 0)
      bare.push_back(building.joint(panel, edge));
  if (bare.empty()) return;
  lay_contacts();
  break_joints(bare, BreakCause::impact);
}

void StandingFrame::State::remove(MemberId member) {
  if (!stands(member)) return;
  for (int end = 0; end < 2; ++end) {
    const JointId joint = building.joint(member, end);
    if (!parts.segments.holds(joint)) continue;
    parts.segments.break_joint(joint);
    lose_member_joint(joint, -1);
  }
  parts.segments.remove(member);
  account.change(member).leave(member);
  statics.remove(member);
  contacts.drop(member);
  take(parts.bearings.leave({{{member, -1}}, {}}), nullptr);
}

/// The member leaves with both of its joints holding: each piece goes on hanging by one.
void StandingFrame::State::cut_in_two(MemberId post, double inside) {
  if (!stands(post)) return;
  JointBreak broken;
  broken.joint = building.joint(post, 0);
  broken.cause = BreakCause::buckling;
  broken.generation = generation;
  broken.position = on_axis(building, post, inside * building[post].length);
  broken.inside = inside;
  int told = static_cast<int>(breaks.size());
  breaks.push_back(broken);
  cut_inside[post] = inside;
  for (int end = 0; end < 2; ++end) {
    const JointId joint = building.joint(post, end);
    if (!parts.holds(joint)) continue;
    hanging.push_back(joint);
    damage(joint, std::exchange(told, -1));  // what the other end frees is counted with it
  }
}

void StandingFrame::State::remove(PanelId panel) {
  if (!stands(panel)) return;
  contacts.drop(panel);
  if (!parts.bearings.serves(panel)) {
    parts.segments.remove(panel);
    leave_shell(panel);
    return;
  }
  if (parts.bearings.membrane(panel)) {
    account.change(panel).lose_membrane(panel);
    statics.remove_membrane(panel);
  }
  parts.bearings.remove(panel);
  hand_on_anew(panel);
  for (int edge = 0; edge < 4; ++edge) joints.lose(building.joint(panel, edge));
  to_check[static_cast<std::size_t>(components.of(panel))] = 1;
}

}  // namespace topple::structure
