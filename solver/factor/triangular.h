#pragma once
// Triangular solves with a sparse Cholesky factor, block by block, in elimination order: whole, restricted to the
// elimination paths of some rows, and for a few columns along one path. A block is a supernode: consecutive columns
// with one pattern below them.
#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "factor/factor.h"
#include "reanalysis/update_costs.h"

namespace topple::solver {

/// The blocks that the elimination of some rows goes through, from the first to the root, and where each one's rows
/// stand when only these are kept.
struct EliminationPath {
  std::vector<int> block;
  std::vector<int> offset;  ///< per block of the path; one more at the end: the number of rows
  [[nodiscard]] int rows() const { return offset.back(); }
  template <class Archive>
  void serialize(Archive& archive) {
    auto& [blocks, offsets] = *this;
    archive(blocks, offsets);
  }
};

/// Columns that are zero outside of one path; rows are those of the path, in its numbering.
struct PathColumns {
  const EliminationPath* path;
  Eigen::MatrixXd* columns;
};

/// Rows below a block that follow each other: among those below it from `from` on; in elimination order from `row` on;
/// on a path, `from_end` rows from its end on.
struct RowsInLine {
  int from, row, count, from_end;
};

/// K = P' L L' P over the numbers of a Factor, which must outlive it and not be factorised again. (A simplicial L D L'
/// is copied into blocks as L sqrt(D).)
class TriangularSolver {
 public:
  explicit TriangularSolver(const Factor& factor);

  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] int blocks() const { return static_cast<int>(parent_.size()); }
  /// Entries of the blocks on a path, of the whole factor.
  [[nodiscard]] double entries(const EliminationPath& path) const;
  [[nodiscard]] double entries() const { return entries_; }
  /// Of the blocks on the paths of any rows, each once; `marked` as by mark_paths().
  [[nodiscard]] double entries_on_paths(std::span<const int> rows, std::vector<char>& marked) const;

  /// From the matrix's numbering to the order of elimination and back.
  void permute(const Eigen::VectorXd& natural, Eigen::VectorXd& eliminated) const;
  void restore(const Eigen::VectorXd& eliminated, Eigen::VectorXd& natural) const;
  /// The row of the matrix eliminated k-th.
  [[nodiscard]] int row_at(int k) const { return order_[static_cast<std::size_t>(k)]; }
  [[nodiscard]] int position(int row) const { return position_[static_cast<std::size_t>(row)]; }

  /// The block that eliminates a row of the matrix.
  [[nodiscard]] int block_of(int row) const { return block_of_[static_cast<std::size_t>(position(row))]; }
  /// The path of rows (of the matrix) that lie on one path, as those of an element do.
  [[nodiscard]] EliminationPath path(std::span<const int> rows) const;
  /// Marks the blocks on the paths of any rows.
  void mark_paths(std::span<const int> rows, std::vector<char>& marked) const;

  /// Nanoseconds of a pass over one block, for so many columns at once (update_costs.h).
  [[nodiscard]] double pass_cost(int block, int count = 1) const;

  /// One block: its columns (consecutive in elimination order) and the rows below them.
  struct BlockRows {
    int first, columns;
    std::span<const std::int64_t> below;
  };
  [[nodiscard]] BlockRows block(int block) const;
  [[nodiscard]] int parent(int block) const { return parent_[static_cast<std::size_t>(block)]; }
  /// The backward step of one block: x (its own rows, `count` columns) := triangle^-T (x - rectangle' below).
  void backward(int block, double* x, const double* below, int count = 1) const;

  /// y := L^-1 y in elimination order. With `marked` (per block): only these; the rest of y must be zero.
  void forward(Eigen::VectorXd& y, const std::vector<char>* marked = nullptr) const;
  /// y := L^-T y. With `marked`: these blocks alone, which are right whatever the rest of y holds when each one's
  /// parent is marked too.
  void backward(Eigen::VectorXd& y, const std::vector<char>* marked = nullptr) const;
  /// The same for several columns, the factor gone through once.
  void forward(Eigen::MatrixXd& y, const std::vector<char>* marked = nullptr) const;
  void backward(Eigen::MatrixXd& y, const std::vector<char>* marked = nullptr) const;
  /// B := L^-1 B for each B. Blocks that several paths share are gone through once, with all their columns together.
  /// With `y` (unless null) also y := L^-1 y as above, in the same pass.
  void forward(std::span<const PathColumns> groups, Eigen::VectorXd* y = nullptr,
               const std::vector<char>* marked = nullptr) const;
  /// The row of the path at which an equation of the matrix stands.
  [[nodiscard]] int row_on_path(const EliminationPath& path, int row) const;
  /// W' y with columns W on the path and a whole vector y; and y -= W c.
  void multiply(const EliminationPath& path, const Eigen::MatrixXd& W, const Eigen::VectorXd& y, double* product) const;
  void subtract(const EliminationPath& path, const Eigen::MatrixXd& W, const double* c, Eigen::VectorXd& y) const;

 private:
  void load_supernodal(const FactorView& view);
  void load_simplicial(const FactorView& view);
  void finish();
  void find_runs();
  [[nodiscard]] std::span<const RowsInLine> runs(std::size_t block) const;
  void forward_block_of(std::size_t block, std::span<const PathColumns> groups, Eigen::VectorXd* y) const;
  [[nodiscard]] double* own_rows(std::size_t block, const Eigen::MatrixXd& y) const;
  void put_own_rows(std::size_t block, Eigen::MatrixXd& y) const;

  int size_ = 0;
  double entries_ = 0;
  PassCost cost_{};
  std::vector<int> order_, position_, block_of_;
  std::vector<int> parent_;  ///< per block; -1: a root
  std::span<const std::int64_t> first_, row_start_, value_start_, row_;
  std::span<const double> value_;
  // What the spans refer to when the factor's own layout is another.
  std::vector<std::int64_t> own_first_, own_row_start_, own_value_start_, own_row_;
  std::vector<double> own_value_;
  /// Per block: rows of a path from it to the root, its own included. A path's rows stand that far from its end.
  std::vector<int> rows_to_root_;
  std::vector<std::int64_t> run_start_;  ///< per block
  std::vector<RowsInLine> run_;
  // Scratch; grows only.
  mutable std::vector<double> below_, together_;
  mutable std::vector<std::size_t> next_, sharing_;
};

}  // namespace topple::solver
