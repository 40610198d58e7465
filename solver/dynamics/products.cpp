#include "dynamics/products.h"

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
template void multiply<2>(const SparseSymmetric&, const SideBySide<2>&, SideBySide<2>&);
template void multiply<4>(const SparseSymmetric&, const SideBySide<4>&, SideBySide<4>&);

}  // namespace topple::solver
