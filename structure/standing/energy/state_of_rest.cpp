#include "standing/energy/state_of_rest.h"

#include <cmath>

#include "model/index_of.h"

namespace topple::structure {

StateOfRest::StateOfRest(const SolvedFrame& now)
    : now_(now),
      members_(now.building.members.size()),
      nodes_(now.building.nodes.size()),
      springs_(static_cast<std::size_t>(now.statics.components())) {}

void StateOfRest::record(int component) {
  for (NodeId node : now_.statics.nodes(component)) {
    OfNode& at_rest = nodes_[index_of(node)];
    at_rest.stands = now_.solved(node);
    if (at_rest.stands) at_rest.displacement = now_.statics.displacement(node);
  }
  for (MemberId member : now_.statics.members(component)) {
    OfMember& at_rest = members_[index_of(member)];
    at_rest.stands = now_.stands(member);
    if (!at_rest.stands) continue;
    at_rest.end_forces = now_.statics.end_forces(member);
    at_rest.elastic_end_forces = now_.statics.elastic_end_forces(member);
    if (const solver::Vec12 plastic_rotations = now_.statics.plastic_rotations(member); !plastic_rotations.isZero(0))
      plastic_rotations_[member] = plastic_rotations;
    else
      plastic_rotations_.erase(member);
    at_rest.stiffness = now_.statics.stiffness(member);
  }
  std::vector<Spring>& springs = springs_[static_cast<std::size_t>(component)];
  springs.clear();
  for (const solver::Support& support : now_.statics.supports(component))
    if ((support.stiffness.array() > 0 && support.stiffness.array() < unlimited).any())
      springs.push_back({now_.statics.nodes(component)[static_cast<std::size_t>(support.node)], support.stiffness});
  record_contacts(component);
}

void StateOfRest::record_loads(MemberId member) {
  OfMember& at_rest = members_[index_of(member)];
  at_rest.loads = now_.applied[index_of(member)];
  at_rest.own_loads = now_.loads.own_and_handed(member).size();
}

void StateOfRest::record_loads(NodeId node) {
  OfNode& at_rest = nodes_[index_of(node)];
  at_rest.loads = now_.loads.own_and_handed(node);
  at_rest.event_loads = now_.loads.event_load(node);
}

void StateOfRest::record_contacts(int component) {
  const auto& contacts = now_.loads.contacts();
  std::erase_if(contacts_, [&](const auto& contact) {
    return now_.component(contact.second) == component && !contacts.contains(contact.first);
  });
  for (const auto& [key, placed] : contacts) {
    if (now_.component(placed) != component) continue;
    const auto [at_rest, made] = contacts_.try_emplace(key, placed);
    if (!made && !same_load(at_rest->second, placed)) at_rest->second = placed;
  }
}

void StateOfRest::lose_joint(JointId joint) {
  const Joint& own = now_.building[joint];
  members_[index_of(own.member)].holds[static_cast<std::size_t>(own.end)] = false;
}

const Vec6& StateOfRest::displacement(NodeId node) const { return nodes_[index_of(node)].displacement; }
const solver::Vec12& StateOfRest::end_forces(MemberId member) const { return members_[index_of(member)].end_forces; }
bool StateOfRest::stands(MemberId member) const { return members_[index_of(member)].stands; }
double StateOfRest::stiffness(MemberId member) const { return members_[index_of(member)].stiffness; }
const std::vector<solver::BeamLoad>& StateOfRest::loads(MemberId member) const {
  return members_[index_of(member)].loads;
}

solver::Vec12 StateOfRest::plastic_rotations(MemberId member) const {
  const auto found = plastic_rotations_.find(member);
  return found == plastic_rotations_.end() ? solver::Vec12::Zero() : found->second;
}

solver::Beam StateOfRest::beam(MemberId member) const {
  const OfMember& at_rest = members_[index_of(member)];
  solver::Beam beam = now_.statics.beam(member);
  const double stiffer = at_rest.stiffness / now_.statics.stiffness(member);
  beam.youngs_modulus *= stiffer;
  beam.shear_modulus *= stiffer;
  for (const std::size_t end : {0u, 1u})
    beam.end_stiffness[end] = at_rest.holds[end]
                                  ? now_.building[now_.building.joint(member, static_cast<int>(end))].stiffness
                                  : Vec6(Vec6::Zero());
  return beam;
}

SolvedMember StateOfRest::shape(MemberId member) const {
  const OfMember& at_rest = members_[index_of(member)];
  const auto& nodes = now_.building[member].nodes;
  const solver::Vec12 at =
      now_.rigid_ends(member, displacement(nodes[0]), displacement(nodes[1])) - plastic_rotations(member);
  return {beam(member), at_rest.elastic_end_forces, at, at_rest.loads};
}

PanelAtRest StateOfRest::panel(PanelId panel) const {
  const std::vector<NodeId> nodes = now_.building[panel].all_nodes();
  std::vector<Vec6> displacements;
  for (NodeId node : nodes) displacements.push_back(displacement(node));
  PanelAtRest at_rest;
  at_rest.forces = now_.statics.node_forces(panel, displacements);
  for (std::size_t n = 0; n < nodes.size(); ++n) at_rest.energy += 0.5 * at_rest.forces[n].dot(displacements[n]);
  return at_rest;
}

LoadWork StateOfRest::load_work(int component) const {
  LoadWork sum;
  for (MemberId member : now_.statics.members(component)) {
    const OfMember& at_rest = members_[index_of(member)];
    if (!at_rest.stands || at_rest.own_loads == 0) continue;
    sum += shape(member).work(std::span(at_rest.loads).first(at_rest.own_loads), now_.local_gravity(member));
  }
  for (NodeId node : now_.statics.nodes(component)) {
    const OfNode& at_rest = nodes_[index_of(node)];
    if (!at_rest.stands) continue;
    sum += work(at_rest.loads, at_rest.displacement, now_.gravity);
    sum.other += at_rest.event_loads.dot(at_rest.displacement);
  }
  return sum;
}

double StateOfRest::contact_work(int component) const {
  double sum = 0;
  for (const auto& [key, placed] : contacts_) {
    if (now_.component(placed) != component) continue;
    for (const auto& [member, load] : placed.members)
      if (members_[index_of(member)].stands) sum += shape(member).work({&load, 1}, now_.local_gravity(member)).sum();
    for (const auto& [node, load] : placed.nodes)
      if (nodes_[index_of(node)].stands) sum += load.dot(displacement(node));
  }
  return sum;
}

double StateOfRest::elastic(int component, const std::map<PanelId, PanelAtRest>& changed) const {
  double sum = 0;
  for (MemberId member : now_.statics.members(component))
    if (members_[index_of(member)].stands) sum += shape(member).strain_energy();
  for (const auto& [panel, at_rest] : changed) sum += at_rest.energy;
  for (PanelId panel : now_.statics.plates(component))
    if (now_.statics.stiff(panel) && !changed.contains(panel)) sum += this->panel(panel).energy;
  for (const Spring& spring : springs_[static_cast<std::size_t>(component)])
    for (int c = 0; c < 6; ++c)
      if (std::isfinite(spring.stiffness(c)))
        sum += 0.5 * spring.stiffness(c) * std::pow(displacement(spring.node)(c), 2);
  return sum;
}

}  // namespace topple::structure
