#pragma once
// Frames one after the other that differ in numbers alone (stiffnesses, springs, places of nodes), as samples of a
// study do: numbering, pattern, ordering, the symbolic factor and its memory are those of the first.
#include <memory>
#include <span>
#include <vector>

#include "topple/solver/case_sums.h"
#include "topple/solver/static_analysis.h"

namespace topple::solver {

/// The answers have the same bits as those of StaticAnalysis and solve_case_sums(), whatever came before. A frame of
/// other elements, other freedoms held, or with other options, is ordered anew. One thread uses it at a time.
class KeptEquations {
 public:
  KeptEquations();
  ~KeptEquations();
  KeptEquations(const KeptEquations&) = delete;
  KeptEquations& operator=(const KeptEquations&) = delete;

  /// As StaticAnalysis does. Throws as it does; what is kept serves further frames all the same.
  [[nodiscard]] std::vector<StaticSolution> solve(FrameModel model, std::span<const LoadSet> loads,
                                                  const AnalysisOptions& options, AnalysisStatistics& statistics);
  /// As the function of this name does.
  [[nodiscard]] CaseSums solve_case_sums(FrameModel model, std::span<const LoadSet> cases,
                                         const Eigen::MatrixXd& factors, const AnalysisOptions& options = {});
  /// Frames that needed no ordering.
  [[nodiscard]] std::size_t reused() const { return reused_; }

 private:
  struct State;
  std::unique_ptr<State> state_;
  std::size_t reused_ = 0;
};

}  // namespace topple::solver
