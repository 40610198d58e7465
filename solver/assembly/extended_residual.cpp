#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

#include "assembly/machine_epsilon.h"
#include "assembly/refinement.h"
#include "factor/large_buffer.h"
#include "factor/vector_versions.h"
#include "topple/solver/parallel_for.h"

namespace topple::solver {
namespace {

/// A number as the sum of two of half its digits, whose products are exact.
template <class Number>
struct Halves {
  Number whole, high, low;
};
template <class Number>
[[gnu::always_inline]] inline Halves<Number> split(const Number& number) {
  constexpr double splitter = 134217729;  // 2^27 + 1
  const Number large = splitter * number, high = large - (large - number);
  return {number, high, number - high};
}

/// value + lost -= a x, and size += |a x|.
template <class Number>
[[gnu::always_inline]] inline void subtract(Number& value, Number& lost, Number& size, double number,
                                            const Number& other) {
  const Halves<double> a = split(number);
  const Halves<Number> x = split(other);
  const Number product = a.whole * x.whole;
  const Number error = a.low * x.low - (((product - a.high * x.high) - a.low * x.high) - a.high * x.low);
  const Number total = value - product, taken = total - value;
  lost += ((value - (total - taken)) - (product + taken)) - error;
  value = total;
  add_magnitude(product, size);
}

/// The rows of the matrix: what lies left of the diagonal, and the stored rest.
struct ResidualRows {
  std::int32_t size;
  const std::int64_t *start, *left_start;
  const std::int32_t* row;
  const double* value;
  const std::int64_t* left_place;
  const std::int32_t* left_column;
};

/// x: as many numbers a row as there are lanes, one for each column. sums: of each row the value, what its last digit
/// lost, and the size, so many numbers each.
template <class Lanes>
[[gnu::always_inline]] inline void subtract_row_products(const ResidualRows& K, const double* x, double* sums) {
  constexpr int N = Lanes::count;
  using Number = typename Lanes::Vector;
  for (std::int32_t i = 0; i < K.size; ++i) {
    double* sum = sums + std::ptrdiff_t{3 * N} * i;
    Number value = lanes_at<Lanes>(sum), lost = lanes_at<Lanes>(sum + N), size = lanes_at<Lanes>(sum + 2 * N);
    const auto take_off = [&](double entry, std::int32_t column) __attribute__((always_inline)) {
      const Number other = lanes_at<Lanes>(x + std::ptrdiff_t{N} * column);
      subtract(value, lost, size, entry, other);
    };
    for (std::int64_t k = K.left_start[i]; k < K.left_start[i + 1]; ++k)
      take_off(K.value[K.left_place[k]], K.left_column[k]);
    for (std::int64_t k = K.start[i]; k < K.start[i + 1]; ++k) take_off(K.value[k], K.row[k]);
    lanes_at<Lanes>(sum) = value;
    lanes_at<Lanes>(sum + N) = lost;
    lanes_at<Lanes>(sum + 2 * N) = size;
  }
}

TOPPLE_VECTOR_VERSIONS
void subtract_products_1(const ResidualRows& K, const double* x, double* sums) {
  subtract_row_products<OneLane>(K, x, sums);
}
TOPPLE_VECTOR_VERSIONS
void subtract_products_4(const ResidualRows& K, const double* x, double* sums) {
  subtract_row_products<FourLanes>(K, x, sums);
}
TOPPLE_EIGHT_LANES(void subtract_products_8(const ResidualRows& K, const double* x, double* sums),
                   subtract_row_products<Eight>(K, x, sums);)

}  // namespace

ExtendedResidual::ExtendedResidual(const SparseSymmetric& K, int threads) : K_(K), threads_(threads) {
  const auto n = static_cast<std::size_t>(K.size);
  left_start_.assign(n + 1, 0);
  row_sum_.assign(n, 0.0);
  for (std::size_t column = 0; column < n; ++column)
    for (auto k = static_cast<std::size_t>(K.start[column]); k < static_cast<std::size_t>(K.start[column + 1]); ++k) {
      const auto row = static_cast<std::size_t>(K.row[k]);
      row_sum_[column] += std::abs(K.value[k]);
      if (row == column) continue;
      row_sum_[row] += std::abs(K.value[k]);
      ++left_start_[row + 1];
    }
  std::partial_sum(left_start_.begin(), left_start_.end(), left_start_.begin());
  left_place_.resize(static_cast<std::size_t>(left_start_.back()));
  left_column_.resize(left_place_.size());
  std::vector<std::int64_t> next(left_start_.begin(), left_start_.end() - 1);
  for (std::size_t column = 0; column < n; ++column)
    for (auto k = K.start[column] + 1; k < K.start[column + 1]; ++k) {
      const auto row = static_cast<std::size_t>(K.row[static_cast<std::size_t>(k)]);
      const auto at = static_cast<std::size_t>(next[row]++);
      left_place_[at] = k;
      left_column_[at] = static_cast<std::int32_t>(column);
    }
}

std::vector<double> ExtendedResidual::operator()(const Eigen::Ref<const Eigen::MatrixXd>& b,
                                                 const Eigen::Ref<const Eigen::MatrixXd>& x, Eigen::MatrixXd& r) const {
  constexpr Eigen::Index most = 8;
  r.resize(K_.size, b.cols());
  std::vector<double> errors(static_cast<std::size_t>(b.cols()), 0.0);
  const auto groups = static_cast<int>((b.cols() + most - 1) / most);
  const auto group = [&](int g) {
    const Eigen::Index first = g * b.cols() / groups, end = (g + 1) * b.cols() / groups;
    columns(first, end - first, b, x, r, errors.data() + first);
  };
  parallel_for(groups, threads_, group);
  return errors;
}

/// At most eight, together.
void ExtendedResidual::columns(Eigen::Index first, Eigen::Index count, const Eigen::Ref<const Eigen::MatrixXd>& b,
                               const Eigen::Ref<const Eigen::MatrixXd>& x, Eigen::MatrixXd& r, double* errors) const {
  const Eigen::Index n = K_.size, lanes = count == 1 ? 1 : count <= 4 ? 4 : 8;
  const ResidualRows rows{K_.size,         K_.start.data(),    left_start_.data(), K_.row.data(),
                          K_.value.data(), left_place_.data(), left_column_.data()};
  const LargeBuffer own_memory(static_cast<std::size_t>(lanes * n)),
      sums_memory(static_cast<std::size_t>(3 * lanes * n));
  Eigen::Map<Eigen::MatrixXd> own(own_memory.data(), lanes, n), sums(sums_memory.data(), 3 * lanes, n);
  own.setZero();
  sums.setZero();
  own.topRows(count) = x.middleCols(first, count).transpose();
  sums.topRows(count) = b.middleCols(first, count).transpose();
  sums.middleRows(2 * lanes, count) = sums.topRows(count).cwiseAbs();
  if (lanes == 1) {
    subtract_products_1(rows, own.data(), sums.data());
  } else if (lanes == 4) {
    subtract_products_4(rows, own.data(), sums.data());
  } else {
    subtract_products_8(rows, own.data(), sums.data());
  }
  for (Eigen::Index c = 0; c < count; ++c) {
    const double largest = n > 0 ? x.col(first + c).cwiseAbs().maxCoeff() : 0;
    double worst = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      const double residual = sums(c, i) + sums(lanes + c, i), row_sum = row_sum_[static_cast<std::size_t>(i)];
      double denominator = sums(2 * lanes + c, i);
      // A row whose terms are themselves rounding of the others' is measured against the row's norm.
      if (denominator <= static_cast<double>(n) * machine_epsilon * row_sum * largest) denominator += row_sum * largest;
      if (std::abs(residual) > 0) worst = std::max(worst, std::abs(residual) / denominator);
      r(i, first + c) = residual;
    }
    const bool finite = std::isfinite(worst) && r.col(first + c).allFinite();
    errors[c] = finite ? worst : std::numeric_limits<double>::infinity();
  }
}

}  // namespace topple::solver
