#pragma once
// What a blow must know of the structure before it can push: found at the pace of the budget while its body waits where
// it touches, and used in the step in which it is known.
#include <optional>
#include <vector>

#include "simulation/simulation_state.h"

namespace topple::structure {

struct Simulation::State::AskedResponse {
  /// As sensed when it was asked for: what is sensed of them later differs by rounding.
  std::vector<collision::Contact> contacts;
  std::vector<ContactPlace> places;
  std::vector<Vec3> normals;
  /// As far as known.
  std::optional<StandingFrame::CoupledResponse> near, full;
  double critical_energy = 0;  ///< the least of the places'; known with `near`
};

}  // namespace topple::structure
