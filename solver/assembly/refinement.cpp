#include "assembly/refinement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "assembly/machine_epsilon.h"

namespace topple::solver {

RefinedSolution solve_refined(const SparseSymmetric& K, const LinearSolve& solve, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd x = b;
  solve(x);
  return refine(ExtendedResidual(K), solve, b, std::move(x));
}

OnceRefined refine_once(const ExtendedResidual& residual, const LinearSolve& solve, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd x = b, step;
  solve(x);
  (void)residual(b, x, step);
  solve(step);
  OnceRefined result{x + step, {}};
  result.rest = (x - result.x) + step;
  return result;
}

RefinedSolution refine(const ExtendedResidual& residual, const LinearSolve& solve, const Eigen::MatrixXd& b,
                       Eigen::MatrixXd x) {
  RefinedSolution result;
  result.x = std::move(x);
  result.quality.resize(static_cast<std::size_t>(b.cols()));
  Eigen::MatrixXd r;
  const std::vector<double> first = residual(b, result.x, r);
  std::vector<Eigen::Index> open;
  for (Eigen::Index j = 0; j < b.cols(); ++j) {
    result.quality[static_cast<std::size_t>(j)].backward_error = first[static_cast<std::size_t>(j)];
    if (first[static_cast<std::size_t>(j)] > backward_error_limit) open.push_back(j);
  }
  Eigen::MatrixXd better, right, better_residual;
  for (int step = 0; step < most_refinement_steps && !open.empty(); ++step) {
    better = r(Eigen::all, open);
    solve(better);
    better += result.x(Eigen::all, open);
    right = b(Eigen::all, open);
    const std::vector<double> errors = residual(right, better, better_residual);
    std::vector<Eigen::Index> still_open;
    for (std::size_t k = 0; k < open.size(); ++k) {
      const Eigen::Index j = open[k], column = static_cast<Eigen::Index>(k);
      SolveQuality& quality = result.quality[static_cast<std::size_t>(j)];
      const bool go_on = errors[k] <= worthwhile_refinement * quality.backward_error;
      if (errors[k] < quality.backward_error) {
        result.x.col(j) = better.col(column);
        r.col(j) = better_residual.col(column);
        quality.backward_error = errors[k];
        ++quality.refinements;
      }
      if (go_on && quality.backward_error > backward_error_limit) still_open.push_back(j);
    }
    open = std::move(still_open);
  }
  for (SolveQuality& quality : result.quality) quality.converged = quality.backward_error <= backward_error_limit;
  return result;
}

double matrix_norm(const SparseSymmetric& K) {
  std::vector<double> sum(static_cast<std::size_t>(K.size), 0.0);
  for (std::size_t column = 0; column < sum.size(); ++column) {
    for (auto k = K.start[column]; k < K.start[column + 1]; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const auto row = static_cast<std::size_t>(K.row[i]);
      sum[column] += std::abs(K.value[i]);
      if (row != column) sum[row] += std::abs(K.value[i]);
    }
  }
  return sum.empty() ? 0 : *std::max_element(sum.begin(), sum.end());
}

double estimate_condition(const SparseSymmetric& K, const LinearSolve& solve) {
  const Eigen::Index n = K.size;
  if (n == 0) return 1;
  // Higham's algorithm 15.4 for one vector; the second column is its alternative estimate, solved along with the first.
  Eigen::MatrixXd start(n, 2);
  for (Eigen::Index i = 0; i < n; ++i) {
    start(i, 0) = 1 / static_cast<double>(n);
    const double ramp = n > 1 ? 1 + static_cast<double>(i) / static_cast<double>(n - 1) : 1;
    start(i, 1) = i % 2 == 0 ? ramp : -ramp;
  }
  solve(start);
  double estimate = start.col(0).lpNorm<1>();
  const double alternative = 2 * start.col(1).lpNorm<1>() / (3 * static_cast<double>(n));
  Eigen::VectorXd y = start.col(0);
  Eigen::Index last = -1;
  constexpr int most_steps = 5;
  for (int step = 0; step < most_steps; ++step) {
    Eigen::MatrixXd z = y.unaryExpr([](double v) { return v < 0 ? -1.0 : 1.0; });
    solve(z);
    Eigen::Index best = 0;
    z.col(0).cwiseAbs().maxCoeff(&best);
    if (best == last) break;
    last = best;
    Eigen::MatrixXd x = Eigen::MatrixXd::Zero(n, 1);
    x(best, 0) = 1;
    solve(x);
    const double grown = x.col(0).lpNorm<1>();
    if (!(grown > estimate)) break;
    estimate = grown;
    y = x.col(0);
  }
  const double condition = std::max(estimate, alternative) * matrix_norm(K);
  return std::isfinite(condition) ? std::max(condition, 1.0) : std::numeric_limits<double>::infinity();
}

double forward_error_bound(double condition, double backward_error) {
  // The residual takes the matrix as it was assembled. On the way there each entry was rounded about twelve times, by
  // half an epsilon at most: in the products of the element's stiffness, and in the two turns of its axes.
  constexpr double matrix_rounding = 6 * machine_epsilon;
  return 2 * condition * (std::max(backward_error, machine_epsilon / 2) + matrix_rounding);
}

}  // namespace topple::solver
