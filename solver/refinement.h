#pragma once
// Iterative refinement to a componentwise backward error at rounding level, and the condition estimate that turns it
// into a bound on the answer. Sources: Oettli and Prager 1964; Arioli, Demmel and Duff 1989; Higham, Accuracy and
// Stability of Numerical Algorithms, ch. 12 and 15.
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "sparse.h"
#include "topple/solver/static_analysis.h"

namespace topple::solver {

/// Solves in place with whatever factor stands, all columns together.
using LinearSolve = std::function<void(Eigen::Ref<Eigen::MatrixXd>)>;

/// What counts as rounding level.
inline constexpr double backward_error_limit = 1e-14;

/// r = b - K x, accumulated in extended precision row by row, and max |r_i| / (|K| |x| + |b|)_i. The pattern is
/// analysed once for any number of residuals; the matrix is borrowed.
class ExtendedResidual {
 public:
  explicit ExtendedResidual(const SparseSymmetric& K);
  double operator()(const Eigen::Ref<const Eigen::VectorXd>& b, const Eigen::Ref<const Eigen::VectorXd>& x,
                    Eigen::VectorXd& r) const;

 private:
  /// An entry left of the diagonal: its column, and how far below that column's diagonal it is stored.
  struct Left {
    std::int32_t column, place;
  };
  const SparseSymmetric& K_;
  std::vector<std::int64_t> left_start_;
  std::vector<Left> left_;
  std::vector<double> row_sum_;
};

/// The same for a single one.
double residual(const SparseSymmetric& K, const Eigen::Ref<const Eigen::VectorXd>& b,
                const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::VectorXd& r);

struct RefinedSolution {
  Eigen::MatrixXd x;
  std::vector<SolveQuality> quality;  ///< per column; condition and bound are not filled in
};
/// Refines each column until its backward error is below the limit or stops falling.
[[nodiscard]] RefinedSolution solve_refined(const SparseSymmetric& K, const LinearSolve& solve,
                                            const Eigen::MatrixXd& b);

/// The 1-norm.
[[nodiscard]] double matrix_norm(const SparseSymmetric& K);

/// Estimate of the condition number in the 1-norm (Hager, Higham); a lower bound, nearly always within a factor of 3.
[[nodiscard]] double estimate_condition(const SparseSymmetric& K, const LinearSolve& solve);

/// Bound on the relative forward error, the rounding of the assembled matrix included.
[[nodiscard]] double forward_error_bound(double condition, double backward_error);

}  // namespace topple::solver
