#pragma once
// Which blocks of rows make a front, and how fronts depend on each other.
#include <cstdint>
#include <vector>

#include "factor/node_blocks.h"

namespace topple::solver {

/// Fronts, numbered so that children stand before parents and subtrees together; children in the order in which the
/// fewest updates wait at a time (Liu 1986).
struct FrontTree {
  std::vector<std::int32_t> parent;                 ///< -1: a root
  std::vector<std::vector<std::int32_t>> children;  ///< ascending
  std::vector<std::vector<std::int32_t>> blocks;    ///< in order of elimination
};

/// Multiply-adds (with square roots and divisions counted alike) that eliminate `columns` leading columns of a dense
/// symmetric matrix of `rows` rows: the sum of the squares of the columns' lengths.
[[nodiscard]] double elimination_operations(double columns, double rows);

[[nodiscard]] FrontTree make_front_tree(const NodeBlocks& blocks);

}  // namespace topple::solver
