#pragma once
// L D L' of a sparse symmetric matrix that need not be positive definite, for its count of negative pivots: as many as
// it has negative eigenvalues (Sylvester's law of inertia). Supernodal Cholesky stops at the first of them and has no
// count. Multifrontal (Duff and Reid 1983), in the order given and without pivoting: as in every Sturm count, a shift
// within rounding of an eigenvalue of a leading part may be miscounted.
#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "assembly/sparse.h"

namespace topple::solver {

class LdlFactor {
 public:
  /// Symbolic analysis. `order[k]` is the row eliminated k-th (subtrees are brought together; fill stays the same).
  LdlFactor(const SparseSymmetric& pattern, std::span<const int> order);

  /// Factorises a matrix with the pattern given at construction; returns the negative pivots. The factor is kept for
  /// solve() only when asked for.
  int factorise(const SparseSymmetric& matrix, bool keep);
  /// In place, after factorise(..., true).
  void solve(Eigen::VectorXd& x) const;

 private:
  struct Update;
  [[nodiscard]] std::vector<std::int32_t> pattern(std::size_t block, const std::vector<Update>& children) const;
  [[nodiscard]] Eigen::MatrixXd assemble(std::size_t block, std::size_t size,
                                         const std::vector<Update>& children) const;

  std::vector<std::int32_t> place_;  ///< per row of the matrix: when it is eliminated
  std::vector<std::int64_t> start_;  ///< strict lower triangle by columns, in elimination order
  std::vector<std::int32_t> row_;
  std::vector<std::int64_t> source_;  ///< of each entry: its place in the matrix
  std::vector<std::int64_t> diagonal_source_;
  std::vector<std::int32_t> first_;  ///< first column of each block, and the end
  std::vector<std::int32_t> block_of_;
  std::vector<double> value_, diagonal_;
  std::vector<std::int32_t> local_;
  std::vector<std::vector<std::int32_t>> rows_;  ///< per block, its own columns first
  std::vector<Eigen::MatrixXd> panel_;           ///< per block: columns of L D, D on the diagonal
};

}  // namespace topple::solver
