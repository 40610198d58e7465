#include "factor/node_blocks.h"

#include <algorithm>
#include <numeric>

namespace topple::solver {
namespace {

/// Whether column c + 1 is column c without its diagonal: both then have the same neighbours behind them. (Should they
/// differ in those before them, the factor gets a few entries more, and stays right.)
bool same_pattern(const SparseSymmetric& pattern, int c) {
  const auto at = static_cast<std::size_t>(c);
  const auto begin = pattern.row.begin() + pattern.start[at], middle = pattern.row.begin() + pattern.start[at + 1],
             end = pattern.row.begin() + pattern.start[at + 2];
  return middle - begin == end - middle + 1 && std::equal(begin + 1, middle, middle);
}

void group_rows(const SparseSymmetric& pattern, std::span<const int> order, NodeBlocks& blocks) {
  blocks.block_of.resize(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const int row = order[k];
    if (k > 0 && order[k - 1] == row - 1 && same_pattern(pattern, row - 1)) {
      ++blocks.rows.back();
    } else {
      blocks.first_row.push_back(row);
      blocks.rows.push_back(1);
    }
    blocks.block_of[static_cast<std::size_t>(row)] = static_cast<std::int32_t>(blocks.rows.size()) - 1;
  }
}

/// Calls visit(a, b) for neighbours; consecutive repetitions are left out.
template <class Visit>
void each_edge(const SparseSymmetric& pattern, const NodeBlocks& blocks, Visit visit) {
  for (std::int32_t b = 0; b < blocks.count(); ++b) {
    // The first column of a block reaches every row that the others reach.
    const auto column = static_cast<std::size_t>(blocks.first_row[static_cast<std::size_t>(b)]);
    std::int32_t last = b;
    for (auto k = pattern.start[column]; k < pattern.start[column + 1]; ++k) {
      const std::int32_t other = blocks.block_of[static_cast<std::size_t>(pattern.row[static_cast<std::size_t>(k)])];
      if (other == last || other == b) continue;
      last = other;
      visit(std::min(b, other), std::max(b, other));
    }
  }
}

void find_neighbours(const SparseSymmetric& pattern, NodeBlocks& blocks) {
  const std::size_t count = blocks.rows.size();
  blocks.earlier.start.assign(count + 1, 0);
  blocks.later.start.assign(count + 1, 0);
  each_edge(pattern, blocks, [&](std::int32_t a, std::int32_t b) {
    ++blocks.later.start[static_cast<std::size_t>(a) + 1];
    ++blocks.earlier.start[static_cast<std::size_t>(b) + 1];
  });
  for (Lists* lists : {&blocks.earlier, &blocks.later}) {
    std::partial_sum(lists->start.begin(), lists->start.end(), lists->start.begin());
    lists->value.resize(static_cast<std::size_t>(lists->start.back()));
  }
  std::vector<std::int64_t> earlier(blocks.earlier.start), later(blocks.later.start);
  each_edge(pattern, blocks, [&](std::int32_t a, std::int32_t b) {
    blocks.later.value[static_cast<std::size_t>(later[static_cast<std::size_t>(a)]++)] = b;
    blocks.earlier.value[static_cast<std::size_t>(earlier[static_cast<std::size_t>(b)]++)] = a;
  });
}

void find_parents(NodeBlocks& blocks) {
  const std::size_t count = blocks.rows.size();
  blocks.parent.assign(count, -1);
  std::vector<std::int32_t> ancestor(count, -1);
  for (std::size_t i = 0; i < count; ++i)
    for (std::int32_t j : blocks.earlier[i])
      while (j != -1 && j < static_cast<std::int32_t>(i)) {
        const auto at = static_cast<std::size_t>(j);
        const std::int32_t next = ancestor[at];
        ancestor[at] = static_cast<std::int32_t>(i);
        if (next == -1) blocks.parent[at] = static_cast<std::int32_t>(i);
        j = next;
      }
}

/// Through the row subtrees: as many steps as the factor has blocks.
void count_columns(NodeBlocks& blocks) {
  const std::size_t count = blocks.rows.size();
  blocks.column_length = blocks.rows;
  std::vector<std::int32_t> mark(count, -1);
  for (std::size_t i = 0; i < count; ++i) {
    mark[i] = static_cast<std::int32_t>(i);
    for (const std::int32_t j : blocks.earlier[i])
      for (auto at = static_cast<std::size_t>(j); mark[at] != static_cast<std::int32_t>(i);
           at = static_cast<std::size_t>(blocks.parent[at])) {
        blocks.column_length[at] += blocks.rows[i];
        mark[at] = static_cast<std::int32_t>(i);
      }
  }
  for (std::size_t i = 0; i < count; ++i)
    for (std::int32_t c = 0; c < blocks.rows[i]; ++c) {
      const double length = blocks.column_length[i] - c;
      blocks.operations += length * length;
    }
}

}  // namespace

NodeBlocks find_node_blocks(const SparseSymmetric& pattern, std::span<const int> order) {
  NodeBlocks blocks;
  group_rows(pattern, order, blocks);
  find_neighbours(pattern, blocks);
  find_parents(blocks);
  count_columns(blocks);
  return blocks;
}

}  // namespace topple::solver
