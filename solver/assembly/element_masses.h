#pragma once
// Masses of elements and nodes in the freedoms that they reach.
#include <vector>

#include "elements/beam.h"
#include "elements/shell.h"
#include "topple/solver/modes.h"

namespace topple::solver {

class FrameElements;

/// Over which a beam's mass lies.
[[nodiscard]] double mass_length(const MassModel& masses, const Beam& beam, int index);
/// Consistent or lumped mass of a beam in the 12 freedoms of its element (diaphragm arms included), whether it stands
/// or not.
[[nodiscard]] Mat12 beam_mass(const FrameElements& frame, const MassModel& masses, int beam);
/// Of a shell in the global freedoms of its nodes, without what diaphragms add.
[[nodiscard]] Mat24 shell_mass(const FrameElements& frame, const MassModel& masses, int shell);
/// Per node: mass three times, then the inertias, of all its NodeMass entries together. Throws std::invalid_argument
/// for a node that does not exist or a negative mass.
[[nodiscard]] std::vector<Vec6> masses_at_nodes(const FrameModel& model, const MassModel& masses);

/// What a frame system that moves is assembled with: K + factor M takes the place of K. `factor` in 1/s2.
struct SystemInertia {
  MassModel masses;
  std::vector<Vec6> at_node;  ///< masses_at_nodes()
  double factor = 0;
};

}  // namespace topple::solver
