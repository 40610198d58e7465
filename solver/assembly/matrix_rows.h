#pragma once
// What refinement asks of a matrix again and again: the residual with its componentwise backward error, and the
// residual of a few rows alone. The pattern is analysed once; values are read as they are at each call. Sums are made
// in double precision, in a fixed order: for rows of some 50 terms that tells backward errors down to 1e-15.
#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "assembly/sparse.h"

namespace topple::solver {

/// Columns of one pattern (a node's), and in which runs the rows below them follow each other.
struct ColumnGroup {
  std::int32_t first, count;
  std::int64_t first_run, last_run;
};
struct RowsInRun {
  std::int32_t row, count;
};

class MatrixRows {
 public:
  explicit MatrixRows(const SparseSymmetric& pattern);

  /// r = b - K x and max |r_i| / (|K| |x| + |b|)_i (Oettli and Prager), as ExtendedResidual of refinement.h has it.
  double residual(const SparseSymmetric& K, const Eigen::VectorXd& b, const Eigen::VectorXd& x, Eigen::VectorXd& r);
  /// After that: the rows of r whose own error is above this.
  void find_rows_above(double error, const Eigen::VectorXd& r, std::vector<int>& rows) const;
  /// r = b - K x in these rows, 0 in all others.
  void residual(const SparseSymmetric& K, const Eigen::VectorXd& b, const Eigen::VectorXd& x, std::span<const int> rows,
                Eigen::VectorXd& r) const;

  /// The largest componentwise backward error of these rows.
  [[nodiscard]] double error(const SparseSymmetric& K, const Eigen::VectorXd& b, const Eigen::VectorXd& x,
                             std::span<const int> rows) const;

 private:
  [[nodiscard]] double row_sum(const SparseSymmetric& K, int row) const;

  void group_columns(const SparseSymmetric& pattern);

  std::vector<ColumnGroup> group_;
  std::vector<RowsInRun> run_;
  // Entries to the left of the diagonal, by rows.
  std::vector<std::int64_t> left_start_, left_position_;
  std::vector<std::int32_t> left_column_;
  Eigen::VectorXd size_, absolute_x_;
};

}  // namespace topple::solver
