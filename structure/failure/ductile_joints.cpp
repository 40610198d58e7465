#include "failure/ductile_joints.h"

#include <algorithm>
#include <cmath>

#include "model/beam_load_sums.h"
#include "model/index_of.h"
#include "model/solved_member.h"

namespace topple::structure {

DuctileJoints::DuctileJoints(const Building& building, const FrameStatics& statics, const Segmentation& segments,
                             const PanelBearings& bearings, const std::vector<std::vector<solver::BeamLoad>>& applied)
    : building_(building),
      statics_(statics),
      segments_(segments),
      bearings_(bearings),
      applied_(applied),
      hinges_(static_cast<std::size_t>(statics.components())),
      paths_(hinges_.size()) {
  bool found = false;
  for (std::size_t j = 0; j < 2 * building.members.size(); ++j) {
    const Joint& joint = building.joints[j];
    for (int axis = 3; axis < 6; ++axis) {
      const auto sense = static_cast<std::size_t>(axis + 1);
      if (!(joint.capacity.ductility[sense] > 0) || joint.capacity.value[sense] == unlimited) continue;
      if (joint.stiffness(axis) == 0) continue;  // bears nothing in this sense
      PlasticHinge hinge;
      hinge.joint = JointId(j);
      hinge.axis = axis;
      hinge.limit = joint.capacity.ductility[sense];
      hinges_[static_cast<std::size_t>(statics.component(joint.member))].push_back(hinge);
      found = true;
    }
  }
  if (!found) return;
  end_forces_.assign(building.members.size(), solver::Vec12::Zero());
  loads_.resize(building.members.size());
  displacement_.assign(building.nodes.size(), Vec6::Zero());
  plate_forces_.resize(building.panels.size());
  for (std::size_t p = 0; p < building.panels.size(); ++p)
    plate_forces_[p].assign(building.panels[p].all_nodes().size(), Vec6::Zero());
}

void DuctileJoints::lose(JointId joint, int component) {
  std::erase_if(hinges(component), [&](const PlasticHinge& hinge) { return hinge.joint == joint; });
}

void DuctileJoints::base_is_answer(int component) {
  for (MemberId member : statics_.members(component)) {
    if (segments_.label(member) < 0) continue;
    end_forces_[index_of(member)] = statics_.end_forces(member);
    loads_[index_of(member)] = applied_[index_of(member)];
  }
  for (NodeId node : statics_.nodes(component)) displacement_[index_of(node)] = statics_.displacement(node);
  for (PanelId panel : statics_.plates(component))
    if (statics_.stiff(panel)) plate_forces_[index_of(panel)] = statics_.node_forces(panel);
}

std::vector<solver::BeamLoad> DuctileJoints::mixed_loads(MemberId member, double base, double now) const {
  const auto &before = loads_[index_of(member)], &after = applied_[index_of(member)];
  std::vector<solver::BeamLoad> sum;
  if (same_loads(before, after)) {
    if (base + now != 0) add_scaled(after, base + now, sum);
    return sum;
  }
  add_scaled(before, base, sum);
  add_scaled(after, now, sum);
  return sum;
}

void DuctileJoints::move_base(int component, double part) {
  for (MemberId member : statics_.members(component)) {
    if (segments_.label(member) < 0) continue;
    solver::Vec12& force = end_forces_[index_of(member)];
    force += part * (statics_.end_forces(member) - force);
    if (part != 0 && !same_loads(loads_[index_of(member)], applied_[index_of(member)]))
      loads_[index_of(member)] = mixed_loads(member, 1 - part, part);
  }
  for (NodeId node : statics_.nodes(component)) {
    Vec6& u = displacement_[index_of(node)];
    u += part * (statics_.displacement(node) - u);
  }
  for (PanelId panel : statics_.plates(component)) {
    if (!statics_.stiff(panel)) continue;
    const std::vector<Vec6> now = statics_.node_forces(panel);
    for (std::size_t n = 0; n < now.size(); ++n) {
      Vec6& force = plate_forces_[index_of(panel)][n];
      force += part * (now[n] - force);
    }
  }
}

void DuctileJoints::move_base(int component, const std::vector<Vec6>& motion, double amount) {
  for (NodeId node : statics_.nodes(component)) displacement_[index_of(node)] += amount * motion[index_of(node)];
}

double DuctileJoints::difference_energy(int component) const {
  double energy = 0;
  for (MemberId member : statics_.members(component)) {
    if (segments_.label(member) < 0) continue;
    const solver::Vec12 force = statics_.end_forces(member) - end_forces_[index_of(member)];
    energy +=
        SolvedMember(statics_.beam(member), force, solver::Vec12::Zero(), mixed_loads(member, -1, 1)).strain_energy();
  }
  for (PanelId panel : statics_.plates(component)) {
    if (!statics_.stiff(panel)) continue;
    const std::vector<Vec6> now = statics_.node_forces(panel);
    const std::vector<NodeId> nodes = building_[panel].all_nodes();
    for (std::size_t n = 0; n < now.size(); ++n)
      energy += 0.5 * (now[n] - plate_forces_[index_of(panel)][n])
                          .dot(statics_.displacement(nodes[n]) - displacement_[index_of(nodes[n])]);
  }
  for (const NodeSupport& support : building_.supports) {
    if (statics_.component(support.node) != component || segments_.label(support.node) < 0) continue;
    const Vec6 moved = statics_.displacement(support.node) - displacement_[index_of(support.node)];
    for (int c = 0; c < 6; ++c)
      if (std::isfinite(support.stiffness(c))) energy += 0.5 * support.stiffness(c) * moved(c) * moved(c);
  }
  return energy;
}

}  // namespace topple::structure
