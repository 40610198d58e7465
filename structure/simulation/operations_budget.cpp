// The budget of predicted operations: what it leaves undone waits for the next step, what was spent beyond it is owed.
// No clock has a say, so that a replay does the same.
//
// A blow that waits is one whose body stands still where it touches for the rest of the step, with the speed that it
// has left; in the next step it touches at once, and the push goes on. Others may slow it down meanwhile. What would
// drive it on is borne by what it stands against: on a body that does not give way, the weight of a heap would do work
// without end. It falls no way, so that gravity does no work on it.
#include <algorithm>

#include "simulation/impact/strike.h"
#include "simulation/simulation_state.h"

namespace topple::structure {

/// Steps that were passed over pay as well.
void Simulation::State::begin_budget() {
  if (!scenario.operations_budget) return;
  const double budget = *scenario.operations_budget, steps = static_cast<double>(step - budget_step);
  frame->allow(budget_step < 0 ? budget : std::min(budget, frame->allowance() + steps * budget));
  budget_step = step;
}

/// What was refused in an earlier step comes before what was not, so that none of them waits for ever.
bool Simulation::State::may_compute(Work work) {
  if (!scenario.operations_budget || (work == Work::blows && host_strikes)) return true;
  // What an answer under way stands for is no place to strike: it comes before all blows.
  const bool answering = frame->answering();
  wait_for_turn(work);
  Turn& own = turns[static_cast<std::size_t>(work)];
  const std::int64_t since = own.waits_since;
  const bool turn = std::none_of(turns.begin(), turns.end(), [&](const Turn& other) {
    const bool blows = &other == &turns[static_cast<std::size_t>(Work::blows)];
    return !(blows && answering) && other.waits_since >= 0 && other.waits_since < since && other.asked >= step - 1;
  });
  const bool may = turn && frame->allowance() > 0 && !(work == Work::blows && answering);
  if (may) own.waits_since = -1;
  return may;
}

void Simulation::State::wait_for_turn(Work work) {
  Turn& own = turns[static_cast<std::size_t>(work)];
  if (own.waits_since < 0 || own.asked < step - 1) own.waits_since = step;
  own.asked = step;
}

bool Simulation::State::waits_for_turn(Work work) const {
  const Turn& one = turns[static_cast<std::size_t>(work)];
  return one.waits_since >= 0 && one.asked >= step - 1;
}

/// Without end to the budget, after what the frame is at work on; what both take is owed.
void Simulation::State::at_once(const std::function<void()>& work) {
  const double left = frame->allowance(), before = frame->counters().operations;
  frame->allow(unlimited);
  (void)frame->go_on();
  work();
  frame->allow(left - (frame->counters().operations - before));
}

void Simulation::State::spend_on_debris(double operations) {
  debris_operations += operations;
  frame->allow(frame->allowance() - operations);
}

/// To cut a panel anew, and each chunk: its outline, mesh, shape and body.
void Simulation::State::spend_on_chunks(std::size_t count) {
  constexpr double cut = 1e6, chunk = 3e5;
  spend_on_debris(cut + chunk * static_cast<double>(count));
}

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
    const Mat3 inertia = world_inertia(*one, state.pose.orientation);
    const double measured =
        (one->rest.mass * state.velocity.squaredNorm() + state.angular_velocity.dot(inertia * state.angular_velocity)) /
        2;
    const double more = one->rest.mass * state.velocity.dot(moving.velocity) +
                        state.angular_velocity.dot(inertia * moving.angular_velocity);
    bodies.motion(id).asleep = false;
    if (measured + more > 0) {
      // What it stands against bears that.
      ledger.lost_in_contacts += measured;
      state.velocity = moving.velocity;
      state.angular_velocity = moving.angular_velocity;
    } else {
      ledger.lost_in_contacts -= more;
      state.velocity += moving.velocity;
      state.angular_velocity += moving.angular_velocity;
    }
    state.asleep = false;
    world->set_state({id}, state);
  }
  held_back.clear();
}

}  // namespace topple::structure
