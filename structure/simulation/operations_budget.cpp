// The budget of predicted operations: what it leaves undone waits for the next step, what was spent beyond it is owed.
// No clock has a say, so that a replay does the same.
//
// A blow that waits is one whose body stands still where it touches for the rest of the step, with the speed that it
// has left; in the next step it touches at once, and the push goes on. Momentum that others give it meanwhile is its
// own; it falls no way, so that gravity does no work on it.
#include <algorithm>

#include "simulation/simulation_state.h"
#include "simulation/strike.h"

namespace topple::structure {

double Simulation::State::operations_beyond_budget() const {
  return operations_owed + frame->counters().operations - operations_booked - *scenario.operations_budget;
}

/// Called once in each step, after its impacts. One solve is never cut in two: it may take more than a step's budget,
/// and as many steps then pass without any as it took budgets.
bool Simulation::State::may_compute() {
  if (!scenario.operations_budget) return true;
  operations_owed = std::max(0.0, operations_beyond_budget());
  operations_booked = frame->counters().operations;
  return operations_owed == 0;
}

bool Simulation::State::may_push() const { return !scenario.operations_budget || operations_beyond_budget() < 0; }

/// `at`: where and how fast it is at the instant of the impact, true velocities.
void Simulation::State::hold_back(collision::BodyId id, collision::BodyState at) {
  held_back[id.value] = {reading().to_world(at.velocity), at.angular_velocity};
  // In the step to come gravity takes it to no speed at all.
  at.velocity = -gravity * scenario.step;
  at.angular_velocity.setZero();
  at.asleep = false;
  world->set_state(id, at);
}

void Simulation::State::let_go_held_back() {
  for (const auto& [id, moving] : held_back) {
    Body* one = body({id});
    if (!one) continue;
    collision::BodyState state = world->state({id});
    // The world measured what contacts did to a body that stood still; on the one that moves they did as much more.
    ledger.lost_in_contacts -=
        one->rest.mass * state.velocity.dot(moving.velocity) +
        state.angular_velocity.dot(world_inertia(*one, state.pose.orientation) * moving.angular_velocity);
    one->asleep = false;
    state.velocity += moving.velocity;
    state.angular_velocity += moving.angular_velocity;
    state.asleep = false;
    world->set_state({id}, state);
  }
  held_back.clear();
}

}  // namespace topple::structure
