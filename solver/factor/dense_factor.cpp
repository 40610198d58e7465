#include "factor/dense_factor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "factor/multiple_right_hand_sides.h"

extern "C" {
void dgetrs_(const char*, const int*, const int*, const double*, const int*, const int*, double*, const int*, int*);
void dgecon_(const char*, const int*, const double*, const int*, const double*, double*, double*, int*, int*);
}

namespace topple::solver {

namespace {
constexpr int least_room = 48;  ///< rows
/// A leading part with an inverse larger than this would spoil what is built on it.
constexpr double largest_inverse = 1e6;

/// x := L^-1 x with ones on the diagonal of L.
void substitute_unit(const double* L, int stride, int rows, double* x) {
  for (int k = 0; k + 1 < rows; ++k)
    subtract_combination(L + static_cast<std::ptrdiff_t>(k) * stride + k + 1, stride, rows - k - 1, 1, x + k,
                         x + k + 1);
}

/// x := U^-1 x.
void substitute_upper(const double* U, int stride, int rows, double* x) {
  for (int k = rows; k-- > 0;) {
    const double* column = U + static_cast<std::ptrdiff_t>(k) * stride;
    x[k] /= column[k];
    subtract_combination(column, stride, k, 1, x + k, x);
  }
}

/// Rows are exchanged with those that `pivot` names (from 1, as LAPACK's), one after the other.
void exchange_rows(double* columns, int stride, int count, const int* pivot, int rows) {
  for (int c = 0; c < count; ++c, columns += stride)
    for (int k = 0; k < rows; ++k) std::swap(columns[k], columns[pivot[k] - 1]);
}

/// A = P L U by columns, with pivots of each; false when one is zero.
bool eliminate(double* A, int stride, int rows, int* pivot) {
  bool regular = true;
  for (int j = 0; j < rows; ++j) {
    double* own = A + static_cast<std::ptrdiff_t>(j) * stride;
    const double* top =
        std::max_element(own + j, own + rows, [](double a, double b) { return std::abs(a) < std::abs(b); });
    pivot[j] = static_cast<int>(top - own) + 1;
    for (int c = 0; c < rows && pivot[j] != j + 1; ++c) {
      double* column = A + static_cast<std::ptrdiff_t>(c) * stride;
      std::swap(column[j], column[pivot[j] - 1]);
    }
    regular = regular && own[j] != 0;
    if (own[j] == 0) continue;
    for (int i = j + 1; i < rows; ++i) own[i] /= own[j];
    for (int c = j + 1; c < rows; ++c) {
      double* column = A + static_cast<std::ptrdiff_t>(c) * stride;
      subtract_combination(own + j + 1, stride, rows - j - 1, 1, column + j, column + j + 1);
    }
  }
  return regular;
}
}  // namespace

int DenseFactor::keep(int size) {
  while (!parts_.empty() && (parts_.back().rows > size || !(parts_.back().inverse_norm < largest_inverse)))
    parts_.pop_back();
  return kept();
}

int DenseFactor::kept() const { return parts_.empty() ? 0 : parts_.back().rows; }

DenseFactor::Matrix DenseFactor::grow(int size) {
  size_ = size;
  if (capacity_ < size) {
    const Eigen::Index kept = this->kept();
    const int room = std::max(least_room, 2 * size);
    const auto n = static_cast<std::size_t>(room);
    std::vector<double> larger(n * n);
    Matrix(larger.data(), kept, kept, Eigen::OuterStride<>(room)) =
        Matrix(value_.data(), kept, kept, Eigen::OuterStride<>(capacity_));
    value_.swap(larger);
    capacity_ = room;
    work_.resize(4 * n);
    pivot_.resize(n);
    integer_work_.resize(n);
  }
  return {value_.data(), size, size, Eigen::OuterStride<>(capacity_)};
}

/// [A B; C E] with A = P L U: B becomes L^-1 P B, C becomes C U^-1, and E - C B is factorised.
void DenseFactor::factorise() {
  const int kept = this->kept(), added = size_ - kept;
  if (added == 0) {
    inverse_norm_ = parts_.empty() ? 1 : parts_.back().inverse_norm;
    return;
  }
  const auto at = [&](int row, int column) {
    return value_.data() + row + static_cast<std::ptrdiff_t>(column) * capacity_;
  };
  if (kept > 0) {
    exchange_rows(at(0, kept), capacity_, added, pivot_.data(), kept);
    for (int j = kept; j < size_; ++j) substitute_unit(at(0, 0), capacity_, kept, at(0, j));
    for (int k = 0; k < kept; ++k) {
      subtract_combination(at(kept, 0), capacity_, added, k, at(0, k), at(kept, k));
      for (int i = kept; i < size_; ++i) *at(i, k) /= *at(k, k);
    }
    for (int j = kept; j < size_; ++j) subtract_combination(at(kept, 0), capacity_, added, kept, at(0, j), at(kept, j));
  }
  int* own = pivot_.data() + kept;
  const bool regular = eliminate(at(kept, kept), capacity_, added, own);
  exchange_rows(at(kept, 0), capacity_, kept, own, added);
  for (int i = 0; i < added; ++i) own[i] += kept;
  double reciprocal = 0;
  const double norm = 1;  // of A: it cancels
  int info = 0;
  if (regular)
    dgecon_("1", &size_, value_.data(), &capacity_, &norm, &reciprocal, work_.data(), integer_work_.data(), &info);
  inverse_norm_ = regular && info == 0 && reciprocal > 0 ? 1 / reciprocal : std::numeric_limits<double>::infinity();
  parts_.push_back({size_, inverse_norm_});
}

void DenseFactor::solve(double* x, int columns) const {
  exchange_rows(x, size_, columns, pivot_.data(), size_);
  for (int c = 0; c < columns; ++c, x += size_) {
    substitute_unit(value_.data(), capacity_, size_, x);
    substitute_upper(value_.data(), capacity_, size_, x);
  }
}

int DenseFactor::largest_inverse_column() const {
  const auto n = static_cast<std::size_t>(size_);
  if (n == 0) return -1;
  const int one = 1;
  int info = 0, best = -1;
  std::vector<double> x(n, 1 / static_cast<double>(size_)), z(n);
  double largest = 0;
  constexpr int most_steps = 5;  // as LAPACK's; it nearly always ends after two or three
  for (int step = 0; step < most_steps; ++step) {
    solve(x.data());
    double norm = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (!std::isfinite(x[i])) return best;
      norm += std::abs(x[i]);
      z[i] = x[i] < 0 ? -1 : 1;
    }
    if (best >= 0 && norm <= largest) break;
    largest = norm;
    dgetrs_("T", &size_, &one, value_.data(), &capacity_, pivot_.data(), z.data(), &size_, &info);
    const auto top = std::max_element(z.begin(), z.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
    const int column = static_cast<int>(top - z.begin());
    if (column == best) break;
    best = column;
    std::fill(x.begin(), x.end(), 0.0);
    x[static_cast<std::size_t>(best)] = 1;
  }
  return best;
}

}  // namespace topple::solver
