#pragma once
// Sums of load cases: combinations are many, the cases that they are made of are few.
#include <Eigen/Core>
#include <span>
#include <vector>

#include "topple/solver/static_analysis.h"

namespace topple::solver {

/// Answers of solve_case_sums().
struct CaseSums {
  std::vector<StaticSolution> solutions;  ///< one for each column of `factors`
  AnalysisStatistics statistics;          ///< of the one analysis behind all of them
};

/// Answer j is that of the sum over c of factors(c, j) cases[c]. Where there are fewer cases than sums, the cases are
/// solved and refined, their answers added up, and each sum is held against the equations like any answer: it is
/// refined further where cases cancel so far that the error of what is left would be above rounding. Else the sums
/// themselves are solved. Throws like StaticAnalysis; std::invalid_argument where `factors` has not a row for each
/// case.
[[nodiscard]] CaseSums solve_case_sums(FrameModel model, std::span<const LoadSet> cases, const Eigen::MatrixXd& factors,
                                       const AnalysisOptions& options = {});

}  // namespace topple::solver
