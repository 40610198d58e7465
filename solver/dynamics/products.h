#pragma once
// Products of a symmetric matrix, given by its lower triangle, with a few vectors at once.
#include <Eigen/Core>

#include "assembly/sparse.h"

namespace topple::solver {

/// Vectors side by side: a column is one row of all of them, so that what belongs together lies together.
template <int Width>
using SideBySide = Eigen::Matrix<double, Width, Eigen::Dynamic>;

/// Y := X A. Instantiated for widths of 1, 2 and 4.
template <int Width>
void multiply(const SparseSymmetric& A, const SideBySide<Width>& X, SideBySide<Width>& Y);

}  // namespace topple::solver
