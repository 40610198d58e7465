#pragma once
// The proof that a saved state is a whole one: whoever loads it goes on as the one that was saved, and that one as if
// it had not been.
#include <functional>
#include <string>
#include <vector>

#include "topple/structure/simulation.h"

namespace topple::test {

using structure::Simulation;

[[nodiscard]] std::string state_of(const Simulation& simulation);
void load(Simulation& simulation, const std::string& state);

/// All that a host can see of it, in words and numbers, every bit: events, accounts, what stands, bodies and their
/// meshes, rays, who carries what.
[[nodiscard]] std::string seen_of(const Simulation& simulation);

struct SavedRun {
  std::function<Simulation()> make;
  std::vector<double> moments;  ///< s, at which it is saved
  /// What a host does before each step; it looks at nothing but the simulation. None: idle steps are passed over by who
  /// loads a state.
  std::function<void(Simulation&)> host{};
};

/// Runs it without being saved, with being saved at all moments, and from each state: the same hash at each step, the
/// same to be seen where it is loaded and in the end.
void goes_on_alike(const SavedRun& run);

}  // namespace topple::test
