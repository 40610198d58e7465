#include "matrix_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vector_versions.h"

namespace topple::solver {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// r -= K x and size += |K| |x|, the diagonal left out. The rows of a node follow each other.
TOPPLE_VECTOR_VERSIONS
void subtract_products(const SparseSymmetric& K, const std::int64_t* run_start, const RowsOfColumn* all_runs,
                       const double* x, const double* absolute_x, double* r, double* size) {
  for (std::int32_t c = 0; c < K.size; ++c) {
    const double xc = x[c], axc = absolute_x[c];
    const double* k = K.value.data() + K.start[static_cast<std::size_t>(c)] + 1;
    FourLanes::Vector value{}, sum{};
    TwoLanes::Vector value_2{}, sum_2{};
    double value_1 = 0, sum_1 = 0;
    const RowsOfColumn* last = all_runs + run_start[c + 1];
    for (const RowsOfColumn* run = all_runs + run_start[c]; run != last; ++run) {
      const double *own_x = x + run->row, *own_size = absolute_x + run->row;
      double *own_r = r + run->row, *to = size + run->row;
      int i = 0;
      for (; i + FourLanes::count <= run->count; i += FourLanes::count) {
        const FourLanes::Vector entry = lanes_at<FourLanes>(k + i), large = entry < 0 ? -entry : entry;
        lanes_at<FourLanes>(own_r + i) -= entry * xc;
        lanes_at<FourLanes>(to + i) += large * axc;
        value += entry * lanes_at<FourLanes>(own_x + i);
        sum += large * lanes_at<FourLanes>(own_size + i);
      }
      if (run->count - i >= TwoLanes::count) {
        const TwoLanes::Vector entry = lanes_at<TwoLanes>(k + i), large = entry < 0 ? -entry : entry;
        lanes_at<TwoLanes>(own_r + i) -= entry * xc;
        lanes_at<TwoLanes>(to + i) += large * axc;
        value_2 += entry * lanes_at<TwoLanes>(own_x + i);
        sum_2 += large * lanes_at<TwoLanes>(own_size + i);
        i += TwoLanes::count;
      }
      if (i < run->count) {
        const double entry = k[i], large = std::abs(entry);
        own_r[i] -= entry * xc;
        to[i] += large * axc;
        value_1 += entry * own_x[i];
        sum_1 += large * own_size[i];
      }
      k += run->count;
    }
    double parts[2 * FourLanes::count], parts_2[2 * TwoLanes::count];
    lanes_at<FourLanes>(parts) = value;
    lanes_at<FourLanes>(parts + FourLanes::count) = sum;
    lanes_at<TwoLanes>(parts_2) = value_2;
    lanes_at<TwoLanes>(parts_2 + TwoLanes::count) = sum_2;
    r[c] -= ((parts[0] + parts[1]) + (parts[2] + parts[3])) + ((parts_2[0] + parts_2[1]) + value_1);
    size[c] += ((parts[4] + parts[5]) + (parts[6] + parts[7])) + ((parts_2[2] + parts_2[3]) + sum_1);
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
      if (!first && run_.back().row + run_.back().count == row) {
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
  subtract_products(K, run_start_.data(), run_.data(), x.data(), absolute_x_.data(), r.data(), size_.data());
  for (Eigen::Index c = 0; c < b.size(); ++c) {
    const double diagonal = K.value[static_cast<std::size_t>(K.start[static_cast<std::size_t>(c)])];
    r(c) -= diagonal * x(c);
    size_(c) += std::abs(diagonal) * absolute_x_(c);
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
    if (error > worst * denominator) worst = error / denominator;
  }
  return std::isfinite(worst) && std::isfinite(r.cwiseAbs().sum()) ? worst : std::numeric_limits<double>::infinity();
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
