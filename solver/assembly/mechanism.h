#pragma once
// Is the structure stable, and if not, what moves? A tiny scaled pivot or reciprocal condition says so; inverse
// iteration on a slightly stiffened matrix gives the motion.
#include <optional>
#include <span>

#include "assembly/frame_system.h"
#include "factor/factor.h"

namespace topple::solver {

struct Stability {
  std::optional<Defect> defect;
  bool nearly_unstable = false;
  double condition = 0;  ///< 0: was not needed
  double least_pivot = 1;
};

/// Factorises the system's matrix and judges it. On a defect the factor is of no further use.
[[nodiscard]] Stability factorise_and_judge(const FrameSystem& system, Factor& factor, const AnalysisOptions& options);

/// Takes the estimate of the condition into the verdict.
void judge_condition(const AnalysisOptions& options, double condition, Stability& stability);

/// A motion (scaled equations) told as a mechanism: normalised, the nodes that move named.
[[nodiscard]] Defect motion_defect(const FrameSystem& system, const Eigen::VectorXd& scaled_motion);

/// The motion that costs (nearly) no energy in which equation `row` takes part.
[[nodiscard]] Defect find_mechanism(const FrameSystem& system, Factor& factor, int row);

}  // namespace topple::solver
