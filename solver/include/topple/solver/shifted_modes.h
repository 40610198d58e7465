#pragma once
// Natural modes of structures that float: free of supports, or of some of them.
#include "topple/solver/modes.h"

namespace topple::solver {

/// As natural_modes(), by subspaces of (K + shift M)^-1 M: K itself need not be regular. `shift` in (rad/s)^2, above 0;
/// a motion that strains nothing has frequency 0, which is told exactly where omega^2 is below 1e-8 of the shift.
/// Throws Instability where even K + shift M is not regular: a motion that moves no mass, or one of so little stiffness
/// and mass that the shift is lost in rounding.
[[nodiscard]] ModalAnswer shifted_modes(const FrameModel& model, const MassModel& masses, int count, double shift,
                                        const AnalysisOptions& options = {}, const AxialState* tangent = nullptr);

}  // namespace topple::solver
