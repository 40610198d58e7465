#pragma once
#include <span>

#include "topple/solver/frame_model.h"

namespace topple::solver {

/// Elastic energy of a beam and its end springs, exactly: the integral of N2/2EA + T2/2GJ + M2/2EI + V2/2GA along it.
[[nodiscard]] double beam_strain_energy(const Beam& beam, double factor, const Vec12& end_forces,
                                        std::span<const BeamLoad> loads);

}  // namespace topple::solver
