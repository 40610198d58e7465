#pragma once
// A frame that moves: the solver's arrays of what stands, with mass.
#include <vector>

#include "topple/solver/frame_dynamics.h"
#include "topple/structure/building.h"

namespace topple::structure {

struct MovingFrame {
  solver::FrameModel model;
  solver::MassModel masses;
  std::vector<std::vector<solver::BeamLoad>> beam_loads;  ///< per beam
  std::vector<Vec6> node_loads;
};

/// Masses that the model gives beside its weight: of nodes, of members (half at either node), and of load cases that
/// the combination does not have anyway. Per node of the building: mass, and the inertias given.
[[nodiscard]] std::vector<solver::NodeMass> given_masses(const Building& building, CombinationId combination);

/// Mass of a member as great as what presses it down, over gravity; where that is nothing, its material's.
[[nodiscard]] double moving_mass(const Building& building, const Member& member,
                                 const std::vector<solver::BeamLoad>& loads);

}  // namespace topple::structure
