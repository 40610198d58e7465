#include "reanalysis/background_factor.h"

#include <exception>
#include <utility>

#include "assembly/refinement.h"

namespace topple::solver {

BackgroundFactor::BackgroundFactor(const SparseSymmetric& matrix, const std::vector<int>& order,
                                   const AnalysisOptions& options, std::function<void()> on_worker)
    : matrix_(matrix) {
  thread_ = std::thread([this, order, options, begin = std::move(on_worker)] {
    if (begin) begin();
    try {
      make(order, options);
    } catch (const std::exception&) {
      result_ = {};  // no memory for a second factor: the first goes on serving
    }
    done_ = true;
  });
}

BackgroundFactor::~BackgroundFactor() {
  if (thread_.joinable()) thread_.join();
}

void BackgroundFactor::make(const std::vector<int>& order, const AnalysisOptions& options) {
  auto factor = std::make_unique<Factor>(matrix_, order, options.factorisation, 1);
  const Factor::Outcome outcome = factor->factorise(matrix_);
  if (!outcome.positive_definite || outcome.worst_pivot < options.warning_limit) return;
  const double condition = estimate_condition(matrix_, [&](auto b) { factor->solve(b); });
  if (1 / condition < options.warning_limit) return;
  std::optional<TriangularSolver> triangles(*factor);
  result_ = {std::move(factor), condition, std::move(triangles), {}};
}

BackgroundFactor::Result BackgroundFactor::extract(bool& late) {
  late = !done_;
  thread_.join();
  result_.values = std::move(matrix_.value);
  return std::move(result_);
}

}  // namespace topple::solver
