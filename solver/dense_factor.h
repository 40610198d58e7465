#pragma once
// L U of a small dense matrix with partial pivoting (LAPACK), in storage that only grows: a correction is factorised
// anew with each break, and must not ask for memory each time.
#include <Eigen/Core>
#include <vector>

namespace topple::solver {

class DenseFactor {
 public:
  /// Makes room for size x size and returns it to be filled in (what it holds is undefined).
  [[nodiscard]] Eigen::Map<Eigen::MatrixXd> matrix(int size);
  /// Factorises what was filled in.
  void factorise();
  /// Estimates of the inverse's 1-norm (Hager, Higham; LAPACK's dgecon); infinite when the matrix is singular.
  [[nodiscard]] double inverse_norm() const { return inverse_norm_; }
  /// Number of the inverse's column with the largest 1-norm, by the same estimate; -1 when the matrix is singular.
  [[nodiscard]] int largest_inverse_column() const;
  /// x := A^-1 x, `columns` of them. Not for singular matrices.
  void solve(double* x, int columns = 1) const;
  [[nodiscard]] int size() const { return size_; }

 private:
  int size_ = 0;
  std::vector<double> value_, work_;
  std::vector<int> pivot_, integer_work_;
  double inverse_norm_ = 1;
};

}  // namespace topple::solver
