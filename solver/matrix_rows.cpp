#include "matrix_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace topple::solver {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// What one column gives to its rows and takes from them: r -= k x_c, size += |k| |x_c|; the sums k x and |k| |x|.
struct ColumnSums {
  double value = 0, size = 0;
};

/// A whole node's rows at once.
void add_six(const double* k, const double* x, const double* absolute_x, double xc, double axc, double* r, double* size,
             ColumnSums& sums) {
  using Six = Eigen::Matrix<double, 6, 1>;
  const Eigen::Map<const Six> K(k), X(x), A(absolute_x);
  Eigen::Map<Six> R(r), S(size);
  const Six absolute = K.cwiseAbs();
  R -= K * xc;
  S += absolute * axc;
  sums.value += K.dot(X);
  sums.size += absolute.dot(A);
}

void add_run(const double* k, int count, const double* x, const double* absolute_x, double xc, double axc, double* r,
             double* size, ColumnSums& sums) {
  for (int i = 0; i < count; ++i) {
    const double absolute = std::abs(k[i]);
    r[i] -= k[i] * xc;
    size[i] += absolute * axc;
    sums.value += k[i] * x[i];
    sums.size += absolute * absolute_x[i];
  }
}

}  // namespace

MatrixRows::MatrixRows(const SparseSymmetric& pattern) {
  const auto n = static_cast<std::size_t>(pattern.size);
  left_start_.assign(n + 1, 0);
  run_start_.push_back(0);
  for (std::size_t column = 0; column < n; ++column) {
    for (auto k = pattern.start[column] + 1; k < pattern.start[column + 1]; ++k) {
      const std::int32_t row = pattern.row[static_cast<std::size_t>(k)];
      ++left_start_[static_cast<std::size_t>(row) + 1];
      const bool first = static_cast<std::size_t>(run_start_.back()) == run_.size();
      if (!first && run_.back().row + run_.back().count == row && run_.back().count < 6) {
        ++run_.back().count;
      } else {
        run_.push_back({row, 1});
      }
    }
    run_start_.push_back(static_cast<std::int64_t>(run_.size()));
  }
  for (std::size_t i = 0; i < n; ++i) left_start_[i + 1] += left_start_[i];
  left_column_.resize(static_cast<std::size_t>(left_start_.back()));
  left_position_.resize(left_column_.size());
  std::vector<std::int64_t> next(left_start_.begin(), left_start_.end() - 1);
  for (std::size_t column = 0; column < n; ++column) {
    for (auto k = pattern.start[column] + 1; k < pattern.start[column + 1]; ++k) {
      const auto at =
          static_cast<std::size_t>(next[static_cast<std::size_t>(pattern.row[static_cast<std::size_t>(k)])]++);
      left_column_[at] = static_cast<std::int32_t>(column);
      left_position_[at] = k;
    }
  }
}

double MatrixRows::residual(const SparseSymmetric& K, const Eigen::VectorXd& b, const Eigen::VectorXd& x,
                            Eigen::VectorXd& r) {
  r = b;
  size_ = b.cwiseAbs();
  absolute_x_ = x.cwiseAbs();
  for (Eigen::Index column = 0; column < b.size(); ++column) {
    const auto c = static_cast<std::size_t>(column);
    const double xc = x(column), axc = absolute_x_(column);
    const double* k = K.value.data() + K.start[c];
    const double diagonal = *k++;
    ColumnSums sums;
    for (auto i = run_start_[c]; i < run_start_[c + 1]; ++i) {
      const auto [row, count] = run_[static_cast<std::size_t>(i)];
      if (count == 6) {
        add_six(k, x.data() + row, absolute_x_.data() + row, xc, axc, r.data() + row, size_.data() + row, sums);
      } else {
        add_run(k, count, x.data() + row, absolute_x_.data() + row, xc, axc, r.data() + row, size_.data() + row, sums);
      }
      k += count;
    }
    r(column) -= sums.value + diagonal * xc;
    size_(column) += sums.size + std::abs(diagonal) * axc;
  }
  const double largest = b.size() > 0 ? absolute_x_.maxCoeff() : 0;
  const double rounding = static_cast<double>(b.size()) * epsilon * largest;
  // No row of the scaled matrix sums up to more than this; beyond, the row's own sum decides.
  constexpr double most_row_sum = 1e4;
  double worst = 0;
  for (Eigen::Index i = 0; i < b.size(); ++i) {
    const double error = std::abs(r(i));
    if (error == 0) continue;
    double denominator = size_(i);
    if (denominator <= rounding * most_row_sum) {
      // A row whose terms are themselves rounding of the others' is measured against the row's norm.
      const double sum = row_sum(K, static_cast<int>(i));
      if (denominator <= rounding * sum) denominator += sum * largest;
    }
    worst = std::max(worst, error / denominator);
  }
  return std::isfinite(worst) && r.allFinite() ? worst : std::numeric_limits<double>::infinity();
}

void MatrixRows::residual(const SparseSymmetric& K, const Eigen::VectorXd& b, const Eigen::VectorXd& x,
                          std::span<const int> rows, Eigen::VectorXd& r) const {
  r.setZero(b.size());
  for (const int row : rows) {
    const auto i = static_cast<std::size_t>(row);
    double sum = b(row);
    for (auto k = K.start[i]; k < K.start[i + 1]; ++k)
      sum -= K.value[static_cast<std::size_t>(k)] * x(K.row[static_cast<std::size_t>(k)]);
    for (auto k = left_start_[i]; k < left_start_[i + 1]; ++k)
      sum -= K.value[static_cast<std::size_t>(left_position_[static_cast<std::size_t>(k)])] *
             x(left_column_[static_cast<std::size_t>(k)]);
    r(row) = sum;
  }
}

double MatrixRows::error(const SparseSymmetric& K, const Eigen::VectorXd& b, const Eigen::VectorXd& x,
                         std::span<const int> rows) const {
  double worst = 0;
  const double rounding = static_cast<double>(b.size()) * epsilon * (b.size() > 0 ? x.cwiseAbs().maxCoeff() : 0.0);
  for (const int row : rows) {
    const auto i = static_cast<std::size_t>(row);
    double sum = b(row), size = std::abs(b(row)), coefficients = 0;
    const auto add = [&](double k, double xj) {
      sum -= k * xj;
      size += std::abs(k * xj);
      coefficients += std::abs(k);
    };
    for (auto k = K.start[i]; k < K.start[i + 1]; ++k)
      add(K.value[static_cast<std::size_t>(k)], x(K.row[static_cast<std::size_t>(k)]));
    for (auto k = left_start_[i]; k < left_start_[i + 1]; ++k)
      add(K.value[static_cast<std::size_t>(left_position_[static_cast<std::size_t>(k)])],
          x(left_column_[static_cast<std::size_t>(k)]));
    if (size <= rounding * coefficients) size += coefficients * rounding / (static_cast<double>(b.size()) * epsilon);
    if (sum != 0) worst = std::max(worst, std::abs(sum) / size);
    if (!std::isfinite(sum)) return std::numeric_limits<double>::infinity();
  }
  return worst;
}

double MatrixRows::row_sum(const SparseSymmetric& K, int row) const {
  const auto i = static_cast<std::size_t>(row);
  double sum = 0;
  for (auto k = K.start[i]; k < K.start[i + 1]; ++k) sum += std::abs(K.value[static_cast<std::size_t>(k)]);
  for (auto k = left_start_[i]; k < left_start_[i + 1]; ++k)
    sum += std::abs(K.value[static_cast<std::size_t>(left_position_[static_cast<std::size_t>(k)])]);
  return sum;
}

}  // namespace topple::solver
