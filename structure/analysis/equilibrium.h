#pragma once
#include "topple/solver/static_analysis.h"
#include "topple/structure/building.h"

namespace topple::structure {

/// Loads against reactions: sums of the six components, moments about the model's centroid, and the largest of the six
/// |sum| / sum of |.| (where nothing but rounding acts: over a millionth of the largest of its kind).
struct Equilibrium {
  Vec6 load = Vec6::Zero(), reaction = Vec6::Zero();
  double error = 0;
};
/// `displaced`: equilibrium holds on the displaced structure (second order), so that moments about undisplaced places
/// do not balance; the error is then that of the forces.
[[nodiscard]] Equilibrium equilibrium(const solver::FrameModel& model, const solver::LoadSet& loads,
                                      const std::vector<Vec6>& reactions, bool displaced = false);

}  // namespace topple::structure
