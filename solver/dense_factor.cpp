#include "dense_factor.h"

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

}  // namespace topple::solver
