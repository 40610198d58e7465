#pragma once
// A member that a mesh divides, seen as one beam again.
#include <vector>

#include "topple/solver/second_order.h"
#include "topple/solver/static_analysis.h"
#include "topple/structure/frame.h"

namespace topple::structure {

struct WholeMember {
  solver::Beam beam;
  solver::Vec12 end_forces;
  std::vector<solver::BeamLoad> loads;  ///< its own, and what the mesh does to it at each of its nodes
};

/// `beams` are those of the frame in the state solved; `loads` those on the whole member.
[[nodiscard]] WholeMember whole_member(const Frame& frame, std::size_t member, const std::vector<solver::Beam>& beams,
                                       const std::vector<solver::Vec12>& end_forces,
                                       std::vector<solver::BeamLoad> loads);

/// The axial forces of a frame, on one whose members have been divided further: tension at each piece's first end, and
/// the loads on it.
[[nodiscard]] solver::AxialState divided_state(const Frame& frame, const Frame& divided, solver::AxialState state);

}  // namespace topple::structure
