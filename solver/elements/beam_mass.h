#pragma once
// Mass matrix of a beam.
#include "elements/beam.h"
#include "topple/solver/modes.h"

namespace topple::solver {

/// Local axes, freedoms of the hubs. Consistent: cubic and linear shapes between the beam's ends, which follow the hubs
/// statically through springs and releases. Lumped: half at either hub, springs or not. `length`: over which the beam's
/// mass lies (MassModel::beam_lengths). Przemieniecki, ch. 11.
[[nodiscard]] Mat12 beam_mass_matrix(const Beam& beam, const MassModel& masses, double length);

}  // namespace topple::solver
