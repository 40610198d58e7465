#pragma once
// A frame of Timoshenko beams solved in extended precision (80 bits on x86) by a dense factorisation: the reference
// against which errors are measured. Written apart from the solver on purpose. Rigid ends, supports that hold or leave
// free.
#include <array>
#include <vector>

#include "topple/solver/frame_model.h"

namespace reference {

using Real = long double;

struct Answer {
  std::vector<std::array<Real, 6>> displacements;     // per node, global
  std::vector<std::array<Real, 12>> beam_end_forces;  // per beam, local: what the nodes do to it
  std::vector<std::array<Real, 6>> reactions;         // per support
};

/// Throws std::runtime_error, naming it, for what it does not know: shells, releases, offsets, springs, diaphragms.
[[nodiscard]] Answer solve(const topple::solver::FrameModel& model, const topple::solver::LoadSet& loads);

}  // namespace reference
