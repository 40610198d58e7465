#pragma once
#include <cmath>
#include <vector>

#include "topple/solver/static_analysis.h"
#include "topple/structure/building.h"

namespace topple::structure {

/// Loads against reactions: sums of the six components, moments about the model's centroid, and the largest of the six
/// |sum| / sum of |.| (where nothing but rounding acts: over a millionth of the largest of its kind).
struct Equilibrium {
  Vec6 load = Vec6::Zero(), reaction = Vec6::Zero();
  double error = 0;
};
/// Six components about the centroid of the model's nodes, with the sums of their sizes.
struct Balance {
  Vec6 sum = Vec6::Zero(), size = Vec6::Zero();
  Balance& add(const Balance& other, double factor) {
    sum += factor * other.sum;
    size += std::abs(factor) * other.size;
    return *this;
  }
};
[[nodiscard]] Balance balance_of(const solver::FrameModel& model, const solver::LoadSet& loads);
[[nodiscard]] Balance balance_of(const solver::FrameModel& model, const std::vector<solver::NodeLoad>& loads);

/// `displaced`: equilibrium holds on the displaced structure (second order), so that moments about undisplaced places
/// do not balance; the error is then that of the forces.
[[nodiscard]] Equilibrium equilibrium(const solver::FrameModel& model, const Balance& applied,
                                      const std::vector<Vec6>& reactions, bool displaced = false);

}  // namespace topple::structure
