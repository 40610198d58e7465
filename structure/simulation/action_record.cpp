#include "simulation/action_record.h"

#include "model/index_of.h"
#include "topple/structure/error.h"

namespace topple::structure {

void ActionRecord::give(std::span<const std::pair<JointId, JointCapacity>> capacities) {
  all_.push_back({scene_.step, CapacityChange{{capacities.begin(), capacities.end()}}});
  for (const auto& [joint, capacity] : capacities) {
    JointCapacity& own = scene_.building.joints[index_of(joint)].capacity;
    given_.try_emplace(joint, own);
    const JointCapacity before = std::exchange(own, capacity);
    // Hinges are made where a ductile sense has a capacity from the start; one that gets it later breaks at once.
    for (std::size_t sense = 0; sense < 7; ++sense)
      if (before.value[sense] == unlimited) own.ductility[sense] = 0;
    scene_.frame->capacity_changed(joint);
  }
}

Building ActionRecord::building_at_start() const {
  Building start = scene_.building;
  for (const auto& [joint, capacity] : given_) start.joints[index_of(joint)].capacity = capacity;
  return start;
}

namespace {

template <class Id>
void require(const std::vector<Id>& ids, std::size_t count) {
  for (const Id id : ids)
    if (!id.valid() || index_of(id) >= count)
      throw InputError("the snapshot is not of this model: it names parts that the model does not have");
}

}  // namespace

void require_parts(const Building& building, const Snapshot::Action& action) {
  const std::size_t members = building.members.size(), panel_count = building.panels.size();
  const std::size_t joints = building.joints.size(), nodes = building.nodes.size();
  if (const auto* contact = std::get_if<HostContact>(&action.what)) {
    if (contact->member.valid()) require(std::vector{contact->member}, members);
    if (contact->panel.valid()) require(std::vector{contact->panel}, panel_count);
    return;
  }
  if (const auto* change = std::get_if<CapacityChange>(&action.what)) {
    for (const auto& [joint, capacity] : change->joints) require(std::vector{joint}, joints);
    return;
  }
  const Tool& tool = std::get<Tool>(action.what);
  if (const auto* cut = std::get_if<CutTool>(&tool)) require(cut->joints, joints);
  if (const auto* remove = std::get_if<RemoveTool>(&tool)) {
    require(remove->members, members);
    require(remove->panels, panel_count);
    require(remove->supports, nodes);
  }
  if (const auto* weaken = std::get_if<WeakenTool>(&tool)) {
    require(weaken->joints, joints);
    require(weaken->members, members);
  }
  if (const auto* load = std::get_if<LoadTool>(&tool))
    for (const NodeLoad& one : load->nodes) require(std::vector{one.node}, nodes);
}

}  // namespace topple::structure
