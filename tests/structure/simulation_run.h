#pragma once
// What tests of the running simulation do again and again.
#include <vector>

#include "topple/structure/simulation.h"

namespace topple::test {

/// To the end, idle steps passed over.
inline void run(structure::Simulation& simulation) {
  while (!simulation.finished()) {
    simulation.skip_idle();
    simulation.step();
  }
}

[[nodiscard]] inline std::vector<structure::SimulationEvent> of_kind(const structure::Simulation& simulation,
                                                                     structure::SimulationEvent::Kind kind) {
  std::vector<structure::SimulationEvent> found;
  for (const structure::SimulationEvent& event : simulation.events())
    if (event.kind == kind) found.push_back(event);
  return found;
}

}  // namespace topple::test
