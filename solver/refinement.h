#pragma once
// Iterative refinement to a componentwise backward error at rounding level, and the condition estimate that turns it
// into a bound on the answer. Sources: Oettli and Prager 1964; Arioli, Demmel and Duff 1989; Higham, Accuracy and
// Stability of Numerical Algorithms, ch. 12 and 15.
#include <Eigen/Core>
#include <functional>
#include <vector>

#include "sparse.h"
#include "topple/solver/static_analysis.h"

namespace topple::solver {

/// Solves in place with whatever factor stands, all columns together.
using LinearSolve = std::function<void(Eigen::Ref<Eigen::MatrixXd>)>;

/// What counts as rounding level.
inline constexpr double backward_error_limit = 1e-14;

/// r = b - K x, accumulated in extended precision, and max |r_i| / (|K| |x| + |b|)_i.
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

/// Bound on the relative forward error.
[[nodiscard]] double forward_error_bound(double condition, double backward_error);

}  // namespace topple::solver
