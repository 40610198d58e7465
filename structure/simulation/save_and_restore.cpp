// Snapshots: what was done, and doing it again. Capacities that a host gives are part of what was done.
#include <utility>

#include "simulation/call_checks.h"
#include "simulation/scene_hash.h"
#include "simulation/simulation_state.h"
#include "simulation/step_clock.h"
#include "topple/structure/error.h"
#include "topple/structure/number_range.h"

namespace topple::structure {

void Simulation::set_capacities(std::span<const std::pair<JointId, JointCapacity>> capacities) {
  require_capacities(state_->scene.building, capacities);
  state_->actions.push_back({state_->scene.step, CapacityChange{{capacities.begin(), capacities.end()}}});
  for (const auto& [joint, capacity] : capacities) {
    JointCapacity& own = state_->scene.building.joints[static_cast<std::size_t>(joint.index)].capacity;
    state_->given_capacities.try_emplace(joint, own);
    const JointCapacity before = std::exchange(own, capacity);
    // Hinges are made where a ductile sense has a capacity from the start; one that gets it later breaks at once.
    for (std::size_t sense = 0; sense < 7; ++sense)
      if (before.value[sense] == unlimited) own.ductility[sense] = 0;
    state_->scene.frame->capacity_changed(joint);
  }
}

Building Simulation::State::building_at_start() const {
  Building start = scene.building;
  for (const auto& [joint, capacity] : given_capacities)
    start.joints[static_cast<std::size_t>(joint.index)].capacity = capacity;
  return start;
}

Snapshot Simulation::save() const {
  return {state_->scene.step, hash(), scene_hash(state_->building_at_start(), state_->scene.scenario), state_->actions};
}

/// Steps over idle time at once, but no farther than `last`.
void Simulation::run_to(std::int64_t last) {
  while (state_->scene.step < last) {
    skip_idle_before(last);
    step();
  }
}

void Simulation::restore(const Snapshot& snapshot) {
  State& now = *state_;
  require_in({0, 1e15}, static_cast<double>(snapshot.step), "the snapshot's step");
  // What another building would refuse by a crash is refused here by its name.
  for (const Snapshot::Action& action : snapshot.actions) now.require_parts(action);
  Building start = now.building_at_start();
  if (snapshot.scene != scene_hash(start, now.scene.scenario))
    throw InputError("the snapshot is of another scene: its model, its scenario or what was tuned in them differs");
  auto listeners = now.log.take_listeners();
  std::unique_ptr<State> left = std::move(state_);
  try {
    state_ = std::make_unique<State>(std::move(start), left->scene.scenario, left->scene.options);
    for (const Snapshot::Action& action : snapshot.actions) {
      run_to(action.step);
      if (const Tool* tool = std::get_if<Tool>(&action.what))
        apply(*tool);
      else if (const auto* change = std::get_if<CapacityChange>(&action.what))
        set_capacities(change->joints);
      else
        touch(std::get<HostContact>(action.what));
    }
    run_to(snapshot.step);
    if (hash() != snapshot.hash)
      throw InputError("the snapshot does not lead to the state that it was taken in, at step " +
                       std::to_string(snapshot.step) + ": another program made it");
  } catch (...) {
    state_ = std::move(left);
    state_->log.set_listeners(std::move(listeners));
    throw;
  }
  state_->log.set_listeners(std::move(listeners));
}

namespace {

template <class Id>
void require(const std::vector<Id>& ids, std::size_t count) {
  for (const Id id : ids)
    if (!id.valid() || static_cast<std::size_t>(id.index) >= count)
      throw InputError("the snapshot is not of this model: it names parts that the model does not have");
}

}  // namespace

void Simulation::State::require_parts(const Snapshot::Action& action) const {
  const std::size_t members = scene.building.members.size(), panel_count = scene.building.panels.size();
  const std::size_t joints = scene.building.joints.size(), nodes = scene.building.nodes.size();
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
