#pragma once
// Our own Cholesky factorisation of a sparse symmetric positive definite matrix: multifrontal (Duff and Reid 1983; Liu
// 1992), with dense kernels of its own and nothing of BLAS. Each front adds up its part of the matrix and what the
// fronts below hand on, eliminates its columns, and hands on the rest. Independent subtrees and the tiles of large
// fronts go to several threads; every number is added up in the same order whatever their number, so the factor's bits
// do not depend on it.
#include <Eigen/Core>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "assembly/sparse.h"
#include "factor/front.h"
#include "factor/front_kernels.h"
#include "factor/large_buffer.h"
#include "factor/supernodes.h"

namespace topple::solver {

class TaskTeam;

class MultifrontalFactor {
 public:
  /// Symbolic analysis. `order[k]` is the row eliminated k-th. `threads`: at least 1.
  MultifrontalFactor(const SparseSymmetric& pattern, const std::vector<int>& order, int threads);
  MultifrontalFactor(const MultifrontalFactor& other);
  ~MultifrontalFactor();

  /// Factorises a matrix with the pattern given at construction. Returns how many columns, in the order of elimination,
  /// come before the first one whose pivot is not positive: all, when there is none.
  [[nodiscard]] std::int64_t factorise(const SparseSymmetric& matrix);
  /// L S L', S of signs, of a matrix that need not be positive definite, in the order given and without pivoting.
  /// Returns the same; a column ends it only where its pivot is not finite. negative() tells the signs.
  [[nodiscard]] std::int64_t factorise_indefinite(const SparseSymmetric& matrix);
  /// Pivots below zero, in the order of elimination.
  [[nodiscard]] const std::vector<std::int64_t>& negative() const { return negative_; }
  /// Solves in place, all columns together.
  void solve(Eigen::Ref<Eigen::MatrixXd> right_hand_sides) const;

  [[nodiscard]] const Supernodes& fronts() const { return fronts_; }
  /// Columns of L front by front (Supernodes::value_start), of the last factorisation. Above a front's diagonal:
  /// anything.
  [[nodiscard]] std::span<const double> values() const { return {values_.data(), values_.size()}; }

 private:
  /// Fronts that one thread goes through in order: a subtree of little work, or one front of much.
  struct Item {
    std::int32_t first, last;
  };
  struct Worker;
  void find_items();
  void find_stacks();
  std::int64_t factorise_with(const SparseSymmetric& matrix);
  void run_item(std::size_t item, Worker& worker, const SparseSymmetric& matrix, TaskTeam& team);
  bool process(std::size_t front, bool keep_update, Worker& worker, const SparseSymmetric& matrix, TaskTeam* team);
  void map_children(std::size_t front, Worker& worker) const;
  void assemble(std::size_t front, const Front& dense, const Worker& worker, int begin, int end, TaskTeam* team) const;
  void assemble_columns(std::size_t front, const Front& dense, const Worker& worker, int begin, int end) const;
  void add_entries(std::size_t front, const SparseSymmetric& matrix);
  void drop_updates(std::size_t front, Worker& worker);
  void solve_in_order(Eigen::MatrixXd& y) const;

  Supernodes fronts_;
  std::vector<std::int64_t> child_start_;
  std::vector<std::int32_t> child_;
  std::vector<char> odd_;  ///< per front: whether an odd number of fronts lies between it and its root
  std::vector<Item> items_;
  std::vector<std::int32_t> item_parent_;
  std::size_t stack_entries_[2] = {0, 0};  ///< most that wait at a time inside of an item, at even and odd depths
  int threads_, most_columns_ = 0, most_below_ = 0;
  LargeBuffer values_;
  std::vector<double*> update_;           ///< per front, while it waits
  std::vector<LargeBuffer> kept_update_;  ///< per front: of the roots of items
  BufferPool spare_;
  std::atomic<std::int64_t> failed_{0};
  bool indefinite_ = false;
  std::vector<NegativePivots> negative_of_front_;  ///< while it is factorised as indefinite
  std::vector<std::int64_t> negative_;
};

}  // namespace topple::solver
