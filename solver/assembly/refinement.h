#pragma once
// Iterative refinement to a componentwise backward error at rounding level, and the condition estimate that turns it
// into a bound on the answer. Sources: Oettli and Prager 1964; Arioli, Demmel and Duff 1989; Higham, Accuracy and
// Stability of Numerical Algorithms, ch. 12 and 15.
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "assembly/sparse.h"
#include "topple/solver/static_analysis.h"

namespace topple::solver {

/// Solves in place with whatever factor stands, all columns together.
using LinearSolve = std::function<void(Eigen::Ref<Eigen::MatrixXd>)>;

/// What counts as rounding level.
inline constexpr double backward_error_limit = 1e-14;
inline constexpr int most_refinement_steps = 12;
/// A step that does not cut the error to this share of the last one is the last.
inline constexpr double worthwhile_refinement = 0.5;

/// r = b - K x for all columns together, in one pass over the matrix for eight of them, accumulated in twice the
/// precision (Ogita, Rump and Oishi 2005, Dot2; products split as Dekker 1971 does, so that the bits are the same with
/// and without fused multiply-add). The pattern is analysed once for any number of residuals; the matrix is borrowed.
/// Groups of columns go to several threads, which changes no bit.
class ExtendedResidual {
 public:
  explicit ExtendedResidual(const SparseSymmetric& K, int threads = 1);
  /// Sets r and returns max |r_i| / (|K| |x| + |b|)_i of each column; infinite where anything is not finite.
  std::vector<double> operator()(const Eigen::Ref<const Eigen::MatrixXd>& b, const Eigen::Ref<const Eigen::MatrixXd>& x,
                                 Eigen::MatrixXd& r) const;

 private:
  void columns(Eigen::Index first, Eigen::Index count, const Eigen::Ref<const Eigen::MatrixXd>& b,
               const Eigen::Ref<const Eigen::MatrixXd>& x, Eigen::MatrixXd& r, double* errors) const;

  const SparseSymmetric& K_;
  int threads_;
  std::vector<std::int64_t> left_start_;
  /// Entries left of the diagonal, row by row: where they are stored, and their columns.
  std::vector<std::int64_t> left_place_;
  std::vector<std::int32_t> left_column_;
  std::vector<double> row_sum_;
};

struct RefinedSolution {
  Eigen::MatrixXd x;
  std::vector<SolveQuality> quality;  ///< per column; condition and bound are not filled in
};
/// Refines each column until its backward error is below the limit or stops falling.
[[nodiscard]] RefinedSolution solve_refined(const SparseSymmetric& K, const LinearSolve& solve,
                                            const Eigen::MatrixXd& b);
/// The same from answers that are there already: those whose error is small enough stay as they are.
[[nodiscard]] RefinedSolution refine(const ExtendedResidual& residual, const LinearSolve& solve,
                                     const Eigen::MatrixXd& b, Eigen::MatrixXd x);
/// Answers after one refinement. Their errors are not known yet.
struct OnceRefined {
  Eigen::MatrixXd x;
  /// What the refinement knows of x beyond its last digit: where answers that cancel are added up, it counts.
  Eigen::MatrixXd rest;
};
[[nodiscard]] OnceRefined refine_once(const ExtendedResidual& residual, const LinearSolve& solve,
                                      const Eigen::MatrixXd& b);

/// The 1-norm.
[[nodiscard]] double matrix_norm(const SparseSymmetric& K);

/// Estimate of the condition number in the 1-norm (Hager, Higham); a lower bound, nearly always within a factor of 3.
[[nodiscard]] double estimate_condition(const SparseSymmetric& K, const LinearSolve& solve);

/// Bound on the relative forward error, the rounding of the assembled matrix included.
[[nodiscard]] double forward_error_bound(double condition, double backward_error);

}  // namespace topple::solver
