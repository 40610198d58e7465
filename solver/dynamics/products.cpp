#include "dynamics/products.h"

#include "factor/vector_versions.h"

namespace topple::solver {

template <int Width>
void multiply(const SparseSymmetric& A, const SideBySide<Width>& X, SideBySide<Width>& Y) {
  using Column = Eigen::Matrix<double, Width, 1>;
  Y.setZero(Width, A.size);
  const double* value = A.value.data();
  const std::int32_t* row = A.row.data();
  for (std::int32_t c = 0; c < A.size; ++c) {
    auto k = A.start[static_cast<std::size_t>(c)];
    const auto end = A.start[static_cast<std::size_t>(c) + 1];
    const Column at = X.col(c);
    Column sum = value[k] * at;
    for (++k; k < end; ++k) {
      sum += value[k] * X.col(row[k]);
      Y.col(row[k]) += value[k] * at;
    }
    Y.col(c) += sum;
  }
}

template void multiply<1>(const SparseSymmetric&, const SideBySide<1>&, SideBySide<1>&);

namespace {

/// Four numbers at a time: a processor with vectors of eight has them of four as well.
TOPPLE_VECTOR_VERSIONS void add_products(const SparseSymmetric& A, const SparseSymmetric& B, const double* X,
                                         double* Y) {
  using Vector = FourLanes::Vector;
  const std::int64_t* start = A.start.data();
  const std::int32_t* row = A.row.data();
  const double *a = A.value.data(), *b = B.value.data();
  for (std::int32_t c = 0; c < A.size; ++c) {
    std::int64_t k = start[c];
    const double* at = X + 8 * std::ptrdiff_t{c};
    const Vector by_a = lanes_at<FourLanes>(at), by_b = lanes_at<FourLanes>(at + 4);
    Vector sum_a = a[k] * by_a, sum_b = b[k] * by_b;
    for (++k; k < start[c + 1]; ++k) {
      const double* from = X + 8 * std::ptrdiff_t{row[k]};
      double* to = Y + 8 * std::ptrdiff_t{row[k]};
      sum_a += a[k] * lanes_at<FourLanes>(from);
      sum_b += b[k] * lanes_at<FourLanes>(from + 4);
      lanes_at<FourLanes>(to) += a[k] * by_a;
      lanes_at<FourLanes>(to + 4) += b[k] * by_b;
    }
    double* own = Y + 8 * std::ptrdiff_t{c};
    lanes_at<FourLanes>(own) += sum_a;
    lanes_at<FourLanes>(own + 4) += sum_b;
  }
}

}  // namespace

void multiply_by_two(const SparseSymmetric& A, const SparseSymmetric& B, const SideBySide<8>& X, SideBySide<8>& Y) {
  Y.setZero(8, A.size);
  add_products(A, B, X.data(), Y.data());
}

}  // namespace topple::solver
