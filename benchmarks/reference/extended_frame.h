#pragma once
// A frame of Timoshenko beams solved in extended precision by a factorisation within the profile of the matrix: the
// reference against which errors are measured. Written apart from the solver on purpose; it shares the model's numbers
// and nothing else. Springs at supports and at member ends, supports that hold or leave free.
#include <array>
#include <vector>

#include "topple/solver/frame_model.h"

namespace reference {

/// 64 bits of mantissa on x86: 3 digits more than double, for frames of ordinary condition.
using Extended = long double;
/// 113 bits: 18 digits more than double, for all that double precision cannot judge; some 30 times slower.
__extension__ using Quad = __float128;

template <typename Real>
struct Answer {
  std::vector<std::array<Real, 6>> displacements;     // per node, global
  std::vector<std::array<Real, 12>> beam_end_forces;  // per beam, local: what the nodes do to it
  std::vector<std::array<Real, 6>> reactions;         // per support: what it does to the structure
};

/// Throws std::runtime_error, naming it, for what it does not know (shells, diaphragms, offsets, settlements, loads
/// that are not distributed forces, distributed loads on beams with shear deformation), and for a model that is not
/// stable.
template <typename Real>
[[nodiscard]] Answer<Real> solve(const topple::solver::FrameModel& model, const topple::solver::LoadSet& loads);

extern template Answer<Extended> solve<Extended>(const topple::solver::FrameModel&, const topple::solver::LoadSet&);
extern template Answer<Quad> solve<Quad>(const topple::solver::FrameModel&, const topple::solver::LoadSet&);

}  // namespace reference
