#include "factor/dense_factor.h"

#include <algorithm>
#include <cmath>
#include <limits>

extern "C" {
void dgetrf_(const int*, const int*, double*, const int*, int*, int*);
void dgetrs_(const char*, const int*, const int*, const double*, const int*, const int*, double*, const int*, int*);
void dlaswp_(const int*, double*, const int*, const int*, const int*, const int*, const int*);
void dtrsm_(const char*, const char*, const char*, const char*, const int*, const int*, const double*, const double*,
            const int*, double*, const int*);
void dgemm_(const char*, const char*, const int*, const int*, const int*, const double*, const double*, const int*,
            const double*, const int*, const double*, double*, const int*);
void dgecon_(const char*, const int*, const double*, const int*, const double*, double*, double*, int*, int*);
}

namespace topple::solver {

namespace {
constexpr int least_room = 48;  ///< rows
/// A leading part with an inverse larger than this would spoil what is built on it.
constexpr double largest_inverse = 1e6;
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
  const int one = 1;
  const double plus = 1, minus = -1;
  int* own = pivot_.data() + kept;
  int info = 0;
  if (kept > 0) {
    dlaswp_(&added, at(0, kept), &capacity_, &one, &kept, pivot_.data(), &one);
    dtrsm_("L", "L", "N", "U", &kept, &added, &plus, at(0, 0), &capacity_, at(0, kept), &capacity_);
    dtrsm_("R", "U", "N", "N", &added, &kept, &plus, at(0, 0), &capacity_, at(kept, 0), &capacity_);
    dgemm_("N", "N", &added, &added, &kept, &minus, at(kept, 0), &capacity_, at(0, kept), &capacity_, &plus,
           at(kept, kept), &capacity_);
  }
  dgetrf_(&added, &added, at(kept, kept), &capacity_, own, &info);
  if (kept > 0) dlaswp_(&kept, at(kept, 0), &capacity_, &one, &added, own, &one);
  for (int i = 0; i < added; ++i) own[i] += kept;
  double reciprocal = 0;
  const double norm = 1;  // of A: it cancels
  if (info == 0)
    dgecon_("1", &size_, value_.data(), &capacity_, &norm, &reciprocal, work_.data(), integer_work_.data(), &info);
  inverse_norm_ = info == 0 && reciprocal > 0 ? 1 / reciprocal : std::numeric_limits<double>::infinity();
  parts_.push_back({size_, inverse_norm_});
}

void DenseFactor::solve(double* x, int columns) const {
  int info = 0;
  dgetrs_("N", &size_, &columns, value_.data(), &capacity_, pivot_.data(), x, &size_, &info);
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
    dgetrs_("N", &size_, &one, value_.data(), &capacity_, pivot_.data(), x.data(), &size_, &info);
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
