#include "refinement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace topple::solver {
namespace {
constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr int most_refinements = 12;
/// A step that does not cut the error to this share of the last one is the last.
constexpr double worthwhile = 0.5;

/// Of products, in extended precision, and of their sizes.
struct Sum {
  long double value = 0;
  double size = 0;
  void subtract(double a, double b) {
    value -= static_cast<long double>(a) * b;
    size += std::abs(a * b);
  }
};
}  // namespace

ExtendedResidual::ExtendedResidual(const SparseSymmetric& K) : K_(K) {
  const auto n = static_cast<std::size_t>(K.size);
  left_start_.assign(n + 1, 0);
  row_sum_.assign(n, 0.0);
  for (std::size_t column = 0; column < n; ++column)
    for (auto k = K.start[column]; k < K.start[column + 1]; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const auto row = static_cast<std::size_t>(K.row[i]);
      row_sum_[column] += std::abs(K.value[i]);
      if (row == column) continue;
      row_sum_[row] += std::abs(K.value[i]);
      ++left_start_[row + 1];
    }
  std::partial_sum(left_start_.begin(), left_start_.end(), left_start_.begin());
  left_.resize(static_cast<std::size_t>(left_start_.back()));
  std::vector<std::int64_t> next(left_start_.begin(), left_start_.end() - 1);
  for (std::size_t column = 0; column < n; ++column)
    for (auto k = K.start[column] + 1; k < K.start[column + 1]; ++k) {
      const auto row = static_cast<std::size_t>(K.row[static_cast<std::size_t>(k)]);
      left_[static_cast<std::size_t>(next[row]++)] = {static_cast<std::int32_t>(column),
                                                      static_cast<std::int32_t>(k - K.start[column])};
    }
}

double ExtendedResidual::operator()(const Eigen::Ref<const Eigen::VectorXd>& b,
                                    const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::VectorXd& r) const {
  const Eigen::Index n = K_.size;
  r.resize(n);
  const double largest = n > 0 ? x.cwiseAbs().maxCoeff() : 0;
  double worst = 0;
  for (Eigen::Index row = 0; row < n; ++row) {
    const auto i = static_cast<std::size_t>(row);
    // Two sums side by side: each waits for its own last addition only.
    Sum even{b(row), std::abs(b(row))}, odd;
    const auto left = [&](Sum& sum, std::int64_t k) {
      const auto [column, place] = left_[static_cast<std::size_t>(k)];
      sum.subtract(K_.value[static_cast<std::size_t>(K_.start[static_cast<std::size_t>(column)] + place)], x(column));
    };
    const auto right = [&](Sum& sum, std::int64_t k) {
      sum.subtract(K_.value[static_cast<std::size_t>(k)], x(K_.row[static_cast<std::size_t>(k)]));
    };
    auto k = left_start_[i];
    for (; k + 1 < left_start_[i + 1]; k += 2) left(even, k), left(odd, k + 1);
    if (k < left_start_[i + 1]) left(even, k);
    for (k = K_.start[i]; k + 1 < K_.start[i + 1]; k += 2) right(even, k), right(odd, k + 1);
    if (k < K_.start[i + 1]) right(odd, k);
    r(row) = static_cast<double>(even.value + odd.value);
    double denominator = even.size + odd.size;
    // A row whose terms are themselves rounding of the others' is measured against the row's norm.
    if (denominator <= static_cast<double>(n) * epsilon * row_sum_[i] * largest) denominator += row_sum_[i] * largest;
    const double error = std::abs(r(row));
    if (error > 0) worst = std::max(worst, error / denominator);
  }
  return std::isfinite(worst) && r.allFinite() ? worst : std::numeric_limits<double>::infinity();
}

double residual(const SparseSymmetric& K, const Eigen::Ref<const Eigen::VectorXd>& b,
                const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::VectorXd& r) {
  return ExtendedResidual(K)(b, x, r);
}

RefinedSolution solve_refined(const SparseSymmetric& K, const LinearSolve& solve, const Eigen::MatrixXd& b) {
  const ExtendedResidual residual(K);
  RefinedSolution result;
  result.x = b;
  solve(result.x);
  const Eigen::Index columns = b.cols();
  result.quality.resize(static_cast<std::size_t>(columns));
  Eigen::MatrixXd r(b.rows(), columns);
  Eigen::VectorXd column_residual;
  std::vector<Eigen::Index> open;
  for (Eigen::Index j = 0; j < columns; ++j) {
    SolveQuality& quality = result.quality[static_cast<std::size_t>(j)];
    quality.backward_error = residual(b.col(j), result.x.col(j), column_residual);
    r.col(j) = column_residual;
    if (quality.backward_error > backward_error_limit) open.push_back(j);
  }
  for (int step = 0; step < most_refinements && !open.empty(); ++step) {
    Eigen::MatrixXd correction(b.rows(), static_cast<Eigen::Index>(open.size()));
    for (std::size_t k = 0; k < open.size(); ++k) correction.col(static_cast<Eigen::Index>(k)) = r.col(open[k]);
    solve(correction);
    std::vector<Eigen::Index> still_open;
    for (std::size_t k = 0; k < open.size(); ++k) {
      const Eigen::Index j = open[k];
      SolveQuality& quality = result.quality[static_cast<std::size_t>(j)];
      const Eigen::VectorXd better = result.x.col(j) + correction.col(static_cast<Eigen::Index>(k));
      const double error = residual(b.col(j), better, column_residual);
      const bool improved = error < quality.backward_error, go_on = error <= worthwhile * quality.backward_error;
      if (improved) {
        result.x.col(j) = better;
        r.col(j) = column_residual;
        quality.backward_error = error;
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
  constexpr double matrix_rounding = 6 * epsilon;
  return 2 * condition * (std::max(backward_error, epsilon / 2) + matrix_rounding);
}

}  // namespace topple::solver
