// Snapshots: what was done, and doing it again.
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
  state_->actions.give(capacities);
}

Snapshot Simulation::save() const {
  return {state_->scene.step, hash(), scene_hash(state_->actions.building_at_start(), state_->scene.scenario),
          state_->actions.all()};
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
  for (const Snapshot::Action& action : snapshot.actions) require_parts(now.scene.building, action);
  Building start = now.actions.building_at_start();
  if (snapshot.scene != scene_hash(start, now.scene.scenario))
    throw InputError("the snapshot is of another scene: its model, its scenario or what was tuned in them differs");
  auto listeners = now.log.extract_listeners();
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

}  // namespace topple::structure
