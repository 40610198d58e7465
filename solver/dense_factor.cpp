#include "dense_factor.h"

#include <algorithm>
#include <cmath>
#include <limits>

extern "C" {
void dgetrf_(const int*, const int*, double*, const int*, int*, int*);
void dgetrs_(const char*, const int*, const int*, const double*, const int*, const int*, double*, const int*, int*);
void dgecon_(const char*, const int*, const double*, const int*, const double*, double*, double*, int*, int*);
}

namespace topple::solver {

Eigen::Map<Eigen::MatrixXd> DenseFactor::matrix(int size) {
  size_ = size;
  const auto n = static_cast<std::size_t>(size);
  if (value_.size() < n * n) {
    value_.resize(2 * n * n);
    work_.resize(8 * n);
    pivot_.resize(2 * n);
    integer_work_.resize(2 * n);
  }
  return {value_.data(), size, size};
}

void DenseFactor::factorise() {
  const Eigen::Map<const Eigen::MatrixXd> A(value_.data(), size_, size_);
  const double norm = A.cwiseAbs().colwise().sum().maxCoeff();
  int info = 0;
  dgetrf_(&size_, &size_, value_.data(), &size_, pivot_.data(), &info);
  double reciprocal = 0;
  if (info == 0)
    dgecon_("1", &size_, value_.data(), &size_, &norm, &reciprocal, work_.data(), integer_work_.data(), &info);
  inverse_norm_ = info == 0 && reciprocal > 0 ? 1 / (reciprocal * norm) : std::numeric_limits<double>::infinity();
}

void DenseFactor::solve(double* x, int columns) const {
  int info = 0;
  dgetrs_("N", &size_, &columns, value_.data(), &size_, pivot_.data(), x, &size_, &info);
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
    dgetrs_("N", &size_, &one, value_.data(), &size_, pivot_.data(), x.data(), &size_, &info);
    double norm = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (!std::isfinite(x[i])) return best;
      norm += std::abs(x[i]);
      z[i] = x[i] < 0 ? -1 : 1;
    }
    if (best >= 0 && norm <= largest) break;
    largest = norm;
    dgetrs_("T", &size_, &one, value_.data(), &size_, pivot_.data(), z.data(), &size_, &info);
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
