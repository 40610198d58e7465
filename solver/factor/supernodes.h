#pragma once
// The fronts of a factorisation: which blocks of rows are eliminated together, in which order, and on which rows each
// front stands. Columns with one pattern make a front by themselves (a fundamental supernode); a front is joined to
// the one above it when the zeros that this stores cost less than handing on an update (Ashcraft and Grimes 1989).
#include <cstdint>
#include <vector>

#include "assembly/sparse.h"
#include "factor/node_blocks.h"

namespace topple::solver {

/// Entries of the matrix that lie side by side and go to one place of a front, `stride` apart.
struct EntryRun {
  std::int64_t source;  ///< in the matrix's values
  std::int64_t place;   ///< in the factor's values
  std::int32_t stride, count;
};

/// Fronts in their order of elimination, children before parents and subtrees together. Everything is numbered in that
/// order. Front f has the columns first[f] ... first[f + 1] - 1; row[row_start[f]] ... are its rows, its own first;
/// value_start[f]: where its columns begin among the factor's values, each as long as the front has rows.
struct Supernodes {
  std::vector<std::int64_t> order;  ///< row of the matrix eliminated k-th
  std::vector<std::int64_t> first, row_start, row, value_start;
  std::vector<std::int32_t> parent;  ///< per front; -1: a root
  std::vector<EntryRun> entry;       ///< of the matrix, by fronts
  std::vector<std::int64_t> entry_start;
  double operations = 0;  ///< without those on stored zeros

  [[nodiscard]] int count() const { return static_cast<int>(parent.size()); }
  [[nodiscard]] int columns(std::size_t f) const { return static_cast<int>(first[f + 1] - first[f]); }
  [[nodiscard]] int rows(std::size_t f) const { return static_cast<int>(row_start[f + 1] - row_start[f]); }
  /// Multiply-adds of a front's elimination, stored zeros included.
  [[nodiscard]] double front_operations(std::size_t f) const;
};

/// `order[k]` is the row eliminated k-th; the fill is that of this order, whose subtrees are brought together.
[[nodiscard]] Supernodes find_supernodes(const SparseSymmetric& pattern, const std::vector<int>& order);

}  // namespace topple::solver
