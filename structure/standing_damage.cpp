// Damage to a standing frame: each change told to segmentation, bearings, loads, solver and joints alike.
#include "index_of.h"
#include "placed_load.h"
#include "standing_state.h"

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
                          segments.remove_support(one.node);
                          statics.remove_support(one.node);
                        },
                        [&](const EventLoad& one) { loads.add_load(one.node, one.load); },
                        [&](const Gravity& one) { loads.set_gravity(one.gravity); }},
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
    if (holds(joint) && label(joint) >= 0) broken.push_back(joint);
  for (JointId joint : broken) tell(joint, cause);
  for (JointId joint : broken) damage(joint);
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
  broken.position = position(joint);
  breaks.push_back(broken);
}

void StandingFrame::State::damage(JointId joint) {
  const Joint& own = building[joint];
  if (own.member.valid()) {
    segments.break_joint(joint);
    lose_member_joint(joint);
    return;
  }
  joints.lose(joint);
  if (bearings.serves(own.panel))
    take(bearings.break_edge(own.panel, own.end), nullptr);
  else
    segments.break_joint(joint);
}

/// Everything but segmentation, which knows already.
void StandingFrame::State::lose_member_joint(JointId joint) {
  const Joint& own = building[joint];
  const NodeId node = building[own.member].nodes[static_cast<std::size_t>(own.end)];
  statics.break_joint(own.member, own.end);
  joints.lose(joint);
  to_check[static_cast<std::size_t>(component(joint))] = 1;
  half_held.push_back(own.member);
  if (bracing) {
    const std::vector<JointId>& snapped = bracing->lose(joint);
    unbraced.insert(unbraced.end(), snapped.begin(), snapped.end());
  }
  if (segments.degree(node) > 0) return;
  // A hub without members: a support that bears nothing, or about to leave. The solver has no stiffness for it.
  take(bearings.bare(node), nullptr);
  if (!node_solved[index_of(node)]) return;
  node_solved[index_of(node)] = 0;
  --solved_nodes[static_cast<std::size_t>(statics.component(node))];
  statics.drop({node});
}

/// `parts`: those that leave in the same change, by their numbers.
void StandingFrame::State::take(const PanelBearings::Changes& changes, std::vector<Detached>* parts) {
  for (PanelId panel : changes.lost_membrane) statics.remove_membrane(panel);
  const auto settle_edges = [&](PanelId panel) {
    loads.hand_on_anew(panel);
    for (int edge = 0; edge < 4; ++edge)
      if (!bearings.holds(panel)[static_cast<std::size_t>(edge)]) joints.lose(building.joint(panel, edge));
    to_check[static_cast<std::size_t>(statics.component(building[panel].nodes[0]))] = 1;
  };
  for (PanelId panel : changes.lost_edge) {
    settle_edges(panel);
    place_contacts_again(panel);
  }
  for (PanelId panel : changes.fell) {
    settle_edges(panel);
    drop_contacts_on(panel);
    detached.emplace_back().panels.push_back(panel);
  }
  for (const auto& [panel, part] : changes.carried_off) {
    loads.hand_on_anew(panel);
    drop_contacts_on(panel);
    (*parts)[static_cast<std::size_t>(part)].panels.push_back(panel);
  }
}

void StandingFrame::State::remove(MemberId member) {
  if (!stands(member)) return;
  for (int end = 0; end < 2; ++end) {
    const JointId joint = building.joint(member, end);
    if (!segments.holds(joint)) continue;
    segments.break_joint(joint);
    lose_member_joint(joint);
  }
  segments.remove(member);
  statics.remove(member);
  drop_contacts_on(member);
  take(bearings.leave({{{member, -1}}, {}}), nullptr);
}

void StandingFrame::State::remove(PanelId panel) {
  if (!stands(panel)) return;
  drop_contacts_on(panel);
  if (!bearings.serves(panel)) {
    segments.remove(panel);
    return;
  }
  if (bearings.membrane(panel)) statics.remove_membrane(panel);
  bearings.remove(panel);
  loads.hand_on_anew(panel);
  for (int edge = 0; edge < 4; ++edge) joints.lose(building.joint(panel, edge));
  to_check[static_cast<std::size_t>(statics.component(building[panel].nodes[0]))] = 1;
}

void StandingFrame::State::drop_contacts_on(MemberId member) {
  // A contact on a panel that also bears on this member is placed again when the panel's bearings change.
  std::erase_if(contacts, [&](const auto& contact) {
    if (contact.second.place.member != member) return false;
    loads.remove_contact(contact.first);
    return true;
  });
}

void StandingFrame::State::drop_contacts_on(PanelId panel) {
  std::erase_if(contacts, [&](const auto& contact) {
    if (contact.second.place.panel != panel) return false;
    loads.remove_contact(contact.first);
    return true;
  });
}

void StandingFrame::State::place_contacts_again(PanelId panel) {
  for (const auto& [key, contact] : contacts)
    if (contact.place.panel == panel)
      loads.set_contact(key, place_load(building, bearings, contact.place, contact.force));
}

}  // namespace topple::structure
