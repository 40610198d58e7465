#pragma once
// Mass matrix of a beam.
#include "elements/beam.h"
#include "topple/solver/modes.h"

namespace topple::solver {

/// Local axes, freedoms of the rigid ends. Consistent: cubic and linear shapes between the beam's ends, which follow
/// the rigid ends statically through springs and releases. Lumped: half at either rigid end, springs or not. `length`:
/// over which the beam's mass lies (MassModel::beam_lengths). Przemieniecki, ch. 11.
[[nodiscard]] Mat12 beam_mass_matrix(const Beam& beam, const MassModel& masses, double length);

/// The consistent mass between the beam's own ends, local axes: beam_mass_matrix() of rigid ends.
[[nodiscard]] Mat12 mass_between_ends(const Beam& beam, const MassModel& masses, double length);
/// How the beam's ends follow its rigid ends when nothing acts on it, local axes: a beam that hangs on one end follows
/// that rigid end as a rigid body; one that hangs on nothing stays at rest.
[[nodiscard]] Mat12 ends_by_rigid_ends(const Beam& beam);

}  // namespace topple::solver
