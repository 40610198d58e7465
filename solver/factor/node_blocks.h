#pragma once
// The elimination of a matrix seen by blocks of rows that have one pattern, as the six freedoms of a node do: its
// elimination tree and the length of its factor's columns cost a few operations for each pair of nodes.
#include <cstdint>
#include <span>
#include <vector>

#include "assembly/sparse.h"

namespace topple::solver {

/// Adjacency lists, one after the other.
struct Lists {
  std::vector<std::int64_t> start;
  std::vector<std::int32_t> value;
  [[nodiscard]] std::span<const std::int32_t> operator[](std::size_t i) const {
    return {value.data() + start[i], value.data() + start[i + 1]};
  }
};

/// Blocks in their order of elimination. Rows of a block follow each other in the matrix and in the order.
struct NodeBlocks {
  std::vector<std::int32_t> first_row;      ///< per block, in the matrix
  std::vector<std::int32_t> rows;           ///< per block
  std::vector<std::int32_t> block_of;       ///< per row of the matrix
  Lists earlier, later;                     ///< neighbours eliminated before and after; repetitions are possible
  std::vector<std::int32_t> parent;         ///< elimination tree (Liu 1990); -1: a root
  std::vector<std::int32_t> column_length;  ///< rows of the factor from the block's first column on, that one included
  double operations = 0;                    ///< of the factorisation: the sum of the squares of its columns' lengths

  [[nodiscard]] int count() const { return static_cast<int>(rows.size()); }
};

/// `order[k]` is the row eliminated k-th.
[[nodiscard]] NodeBlocks find_node_blocks(const SparseSymmetric& pattern, std::span<const int> order);

}  // namespace topple::solver
