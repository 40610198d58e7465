#pragma once
// Products of a symmetric matrix, given by its lower triangle, with a few vectors at once.
#include <Eigen/Core>

#include "assembly/sparse.h"

namespace topple::solver {

/// Vectors side by side: a column is one row of all of them, so that what belongs together lies together.
template <int Width>
using SideBySide = Eigen::Matrix<double, Width, Eigen::Dynamic>;

/// Y := X A. Instantiated for a width of 1.
template <int Width>
void multiply(const SparseSymmetric& A, const SideBySide<Width>& X, SideBySide<Width>& Y);

/// The first four rows of Y := those of X times A, the last four times B, which has the pattern of A: the pattern is
/// gone through once. The same bits as by multiply(), with any processor's vectors.
void multiply_by_two(const SparseSymmetric& A, const SparseSymmetric& B, const SideBySide<8>& X, SideBySide<8>& Y);

}  // namespace topple::solver
