// The budget of predicted operations: what it leaves undone waits for the next step, what was spent beyond it is owed.
// No clock has a say, so that a replay does the same.
#include <algorithm>

#include "simulation/simulation_state.h"

namespace topple::structure {

/// Called once in each step, after its impacts. One solve is never cut in two: it may take more than a step's budget,
/// and as many steps then pass without any as it took budgets.
bool Simulation::State::may_compute() {
  if (!scenario.operations_budget) return true;
  const double spent = frame->counters().operations;
  operations_owed = std::max(0.0, operations_owed + spent - operations_booked - *scenario.operations_budget);
  operations_booked = spent;
  return operations_owed == 0;
}

}  // namespace topple::structure
