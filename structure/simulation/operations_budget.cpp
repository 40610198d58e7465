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

namespace {
/// Work of each kind begins in a step only while less than this share of the budget is spent in it: most of what begins
/// takes several times as much. A factor and its answer often go into one step; debris can wait.
constexpr std::array<double, 3> share_to_begin{0.12, 0.15, 0.08};
}  // namespace

/// Until no more work begins in this step.
double Simulation::State::operations_left(Work work) const {
  if (!scenario.operations_budget) return unlimited;
  if (operations_owed >= *scenario.operations_budget) return 0;
  return share_to_begin[static_cast<std::size_t>(work)] * *scenario.operations_budget -
         (operations() - operations_booked);
}

/// One solve is never cut in two: it may take more than a step's budget, and as many steps then pass without any as it
/// took budgets. Idle steps that were passed over pay as well.
void Simulation::State::begin_budget() {
  if (!scenario.operations_budget) return;
  const double spent = operations() - operations_booked, steps = static_cast<double>(step - budget_step);
  operations_owed = std::max(0.0, operations_owed + spent - steps * *scenario.operations_budget);
  operations_booked += spent;
  budget_step = step;
}

/// What was refused in an earlier step comes before what was not, so that none of them waits for ever.
bool Simulation::State::may_compute(Work work) {
  if (!scenario.operations_budget || (work == Work::blows && host_strikes)) return true;
  // What an answer under way stands for is no place to strike: it comes before all blows.
  const bool answering = frame->answering();
  Turn& own = turns[static_cast<std::size_t>(work)];
  const std::int64_t since = own.waits_since < 0 || own.asked < step - 1 ? step : own.waits_since;
  own.asked = step;
  const bool turn = std::none_of(turns.begin(), turns.end(), [&](const Turn& other) {
    const bool blows = &other == &turns[static_cast<std::size_t>(Work::blows)];
    return !(blows && answering) && other.waits_since >= 0 && other.waits_since < since && other.asked >= step - 1;
  });
  const bool may = turn && operations_left(work) > 0 && !(work == Work::blows && answering);
  own.waits_since = may ? -1 : since;
  return may;
}

/// To cut a panel anew, and each chunk: its outline, mesh, shape and body.
void Simulation::State::spend_on_chunks(std::size_t count) {
  constexpr double cut = 1e6, chunk = 3e5;
  debris_operations += cut + chunk * static_cast<double>(count);
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
