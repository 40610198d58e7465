#include "assembly/matrix_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "assembly/machine_epsilon.h"
#include "factor/vector_versions.h"
#include "reanalysis/update_costs.h"
#include "reanalysis/work_count.h"

namespace topple::solver {
namespace {

constexpr int six = 6;  // columns of a node

struct Vectors {
  const double *x, *absolute_x;
  double *r, *size;
};

/// Sums of N columns' products with the rows below them: k x and |k| |x|.
template <class Lanes, int N>
struct Sums {
  typename Lanes::Vector value[N] = {}, size[N] = {};
};

/// Some rows below N columns: r -= K x and size += |K| |x| both ways, the columns' in `sums`.
template <class Lanes, int N>
[[gnu::always_inline]] inline void multiply_rows(const double* const* column, int at, const double* x, const double* ax,
                                                 std::int32_t row, const Vectors& v, Sums<Lanes, N>& sums) {
  using Vector = typename Lanes::Vector;
  const Vector own_x = lanes_at<Lanes>(v.x + row), own_size = lanes_at<Lanes>(v.absolute_x + row);
  Vector r = lanes_at<Lanes>(v.r + row), size = lanes_at<Lanes>(v.size + row);
  TOPPLE_UNROLLED
  for (int c = 0; c < N; ++c) {
    const Vector k = lanes_at<Lanes>(column[c] + at);
    const Vector large = k < 0 ? -k : k;
    r -= k * x[c];
    size += large * ax[c];
    sums.value[c] += k * own_x;
    sums.size[c] += large * own_size;
  }
  lanes_at<Lanes>(v.r + row) = r;
  lanes_at<Lanes>(v.size + row) = size;
}

/// The group's own triangle; `below` points behind it in each column.
template <int N>
[[gnu::always_inline]] inline void multiply_triangle(const double* const* below, const double* x, const double* ax,
                                                     double* value, double* size) {
  for (int c = 0; c < N; ++c) {
    const double* k = below[c] - N;
    // By themselves: the compiler cannot know that the others are not these.
    double own_value = value[c] + k[c] * x[c], own_size = size[c] + std::abs(k[c]) * ax[c];
    for (int i = c + 1; i < N; ++i) {
      const double large = std::abs(k[i]);
      own_value += k[i] * x[i];
      own_size += large * ax[i];
      value[i] += k[i] * x[c];
      size[i] += large * ax[c];
    }
    value[c] = own_value;
    size[c] = own_size;
  }
}

template <int N>
[[gnu::always_inline]] inline void multiply_group(const SparseSymmetric& K, const ColumnGroup& group,
                                                  const RowsInRun* runs, const Vectors& v) {
  const double* below[N];
  double x[N], ax[N], value[N], size[N];
  for (int c = 0; c < N; ++c) {
    below[c] = K.value.data() + K.start[static_cast<std::size_t>(group.first + c)] + (N - c);
    x[c] = v.x[group.first + c];
    ax[c] = v.absolute_x[group.first + c];
  }
  Sums<FourLanes, N> four;
  Sums<TwoLanes, N> two;
  Sums<OneLane, N> one;
  int at = 0;
  for (auto run = group.first_run; run < group.last_run; ++run) {
    const RowsInRun& rows = runs[run];
    int i = 0;
    for (; i + 4 <= rows.count; i += 4) multiply_rows(below, at + i, x, ax, rows.row + i, v, four);
    if (rows.count - i >= 2) {
      multiply_rows(below, at + i, x, ax, rows.row + i, v, two);
      i += 2;
    }
    if (i < rows.count) multiply_rows(below, at + i, x, ax, rows.row + i, v, one);
    at += rows.count;
  }
  TOPPLE_UNROLLED
  for (int c = 0; c < N; ++c) {
    double p[2 * FourLanes::count], q[2 * TwoLanes::count];
    lanes_at<FourLanes>(p) = four.value[c];
    lanes_at<FourLanes>(p + 4) = four.size[c];
    lanes_at<TwoLanes>(q) = two.value[c];
    lanes_at<TwoLanes>(q + 2) = two.size[c];
    value[c] = ((p[0] + p[1]) + (p[2] + p[3])) + ((q[0] + q[1]) + one.value[c]);
    size[c] = ((p[4] + p[5]) + (p[6] + p[7])) + ((q[2] + q[3]) + one.size[c]);
  }
  multiply_triangle<N>(below, x, ax, value, size);
  for (int c = 0; c < N; ++c) {
    v.r[group.first + c] -= value[c];
    v.size[group.first + c] += size[c];
  }
}

TOPPLE_VECTOR_VERSIONS
void multiply_groups(const SparseSymmetric& K, std::span<const ColumnGroup> groups, const RowsInRun* runs,
                     const Vectors& v) {
  for (const ColumnGroup& group : groups) {
    if (group.count == six) {
      multiply_group<six>(K, group, runs, v);
    } else {
      multiply_group<1>(K, group, runs, v);
    }
  }
}

}  // namespace

MatrixRows::MatrixRows(const SparseSymmetric& pattern) {
  const auto n = static_cast<std::size_t>(pattern.size);
  left_start_.assign(n + 1, 0);
  for (std::size_t column = 0; column < n; ++column)
    for (auto k = pattern.start[column] + 1; k < pattern.start[column + 1]; ++k)
      ++left_start_[static_cast<std::size_t>(pattern.row[static_cast<std::size_t>(k)]) + 1];
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
  group_columns(pattern);
}

/// Six columns that share their pattern go together, others by themselves.
void MatrixRows::group_columns(const SparseSymmetric& pattern) {
  const auto joins = [&](std::int32_t c) {  // column c + 1 is column c without its diagonal
    const auto at = static_cast<std::size_t>(c);
    const auto begin = pattern.row.begin() + pattern.start[at], middle = pattern.row.begin() + pattern.start[at + 1],
               end = pattern.row.begin() + pattern.start[at + 2];
    return middle - begin == end - middle + 1 && std::equal(begin + 1, middle, middle);
  };
  for (std::int32_t column = 0; column < pattern.size;) {
    std::int32_t count = 1;
    while (count < six && column + count < pattern.size && joins(column + count - 1)) ++count;
    if (count < six) count = 1;
    const auto runs = static_cast<std::int64_t>(run_.size());
    const auto at = static_cast<std::size_t>(column);
    for (auto k = pattern.start[at] + count; k < pattern.start[at + 1]; ++k) {
      const std::int32_t row = pattern.row[static_cast<std::size_t>(k)];
      const bool first = static_cast<std::int64_t>(run_.size()) == runs;
      if (!first && run_.back().row + run_.back().count == row) {
        ++run_.back().count;
      } else {
        run_.push_back({row, 1});
      }
    }
    group_.push_back({column, count, runs, static_cast<std::int64_t>(run_.size())});
    column += count;
  }
}

double MatrixRows::residual(const SparseSymmetric& K, const Eigen::VectorXd& b, const Eigen::VectorXd& x,
                            Eigen::VectorXd& r) {
  count_work(residual_cost(static_cast<double>(K.row.size())));
  r = b;
  size_ = b.cwiseAbs();
  absolute_x_ = x.cwiseAbs();
  multiply_groups(K, group_, run_.data(), {x.data(), absolute_x_.data(), r.data(), size_.data()});
  const double largest = b.size() > 0 ? absolute_x_.maxCoeff() : 0;
  const double rounding = static_cast<double>(b.size()) * machine_epsilon * largest;
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

void MatrixRows::find_rows_above(double error, const Eigen::VectorXd& r, std::vector<int>& rows) const {
  rows.clear();
  // How many are off hangs on rounding, and later answers are to ask for no memory.
  rows.reserve(static_cast<std::size_t>(r.size()));
  for (Eigen::Index i = 0; i < r.size(); ++i)
    if (std::abs(r(i)) > error * size_(i)) rows.push_back(static_cast<int>(i));
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
  const double rounding =
      static_cast<double>(b.size()) * machine_epsilon * (b.size() > 0 ? x.cwiseAbs().maxCoeff() : 0.0);
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
    if (size <= rounding * coefficients)
      size += coefficients * rounding / (static_cast<double>(b.size()) * machine_epsilon);
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
