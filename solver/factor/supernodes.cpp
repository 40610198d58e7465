#include "factor/supernodes.h"

#include <algorithm>
#include <numeric>

#include "factor/front_tree.h"

namespace topple::solver {
namespace {

/// Numbers the blocks as the fronts eliminate them, and the rows of the matrix with them.
struct Numbering {
  std::vector<std::int32_t> front_of, place;  ///< per block: its front, its first row in the order of elimination
};

Numbering number_blocks(const NodeBlocks& blocks, const FrontTree& tree, Supernodes& result) {
  Numbering numbering;
  numbering.front_of.resize(blocks.rows.size());
  numbering.place.resize(blocks.rows.size());
  result.first.push_back(0);
  std::int32_t place = 0;
  for (std::size_t f = 0; f < tree.parent.size(); ++f) {
    for (const std::int32_t block : tree.blocks[f]) {
      const auto b = static_cast<std::size_t>(block);
      numbering.front_of[b] = static_cast<std::int32_t>(f);
      numbering.place[b] = place;
      for (std::int32_t r = 0; r < blocks.rows[b]; ++r) result.order.push_back(blocks.first_row[b] + r);
      place += blocks.rows[b];
    }
    result.first.push_back(place);
  }
  return numbering;
}

/// Rows of each front: its own, those that its columns reach in the matrix, and those that its children hand on.
void find_rows(const NodeBlocks& blocks, const FrontTree& tree, const Numbering& numbering, Supernodes& result) {
  const std::size_t fronts = tree.parent.size();
  std::vector<std::int32_t> mark(blocks.rows.size(), -1);
  std::vector<std::vector<std::int32_t>> below(fronts);  // blocks; given up once the parent has them
  const auto by_place = [&](std::int32_t a, std::int32_t b) {
    return numbering.place[static_cast<std::size_t>(a)] < numbering.place[static_cast<std::size_t>(b)];
  };
  result.row_start.push_back(0);
  result.value_start.push_back(0);
  for (std::size_t f = 0; f < fronts; ++f) {
    std::vector<std::int32_t>& own = below[f];
    const auto reach = [&](std::span<const std::int32_t> list) {
      for (const std::int32_t b : list) {
        const auto at = static_cast<std::size_t>(b);
        if (numbering.front_of[at] == static_cast<std::int32_t>(f) || mark[at] == static_cast<std::int32_t>(f))
          continue;
        mark[at] = static_cast<std::int32_t>(f);
        own.push_back(b);
      }
    };
    for (const std::int32_t b : tree.blocks[f]) reach(blocks.later[static_cast<std::size_t>(b)]);
    for (const std::int32_t child : tree.children[f]) {
      reach(below[static_cast<std::size_t>(child)]);
      below[static_cast<std::size_t>(child)] = {};
    }
    std::sort(own.begin(), own.end(), by_place);
    for (std::int64_t c = result.first[f]; c < result.first[f + 1]; ++c) result.row.push_back(c);
    for (const std::int32_t b : own) {
      const auto at = static_cast<std::size_t>(b);
      for (std::int32_t r = 0; r < blocks.rows[at]; ++r) result.row.push_back(numbering.place[at] + r);
    }
    result.row_start.push_back(static_cast<std::int64_t>(result.row.size()));
    result.value_start.push_back(result.value_start.back() +
                                 static_cast<std::int64_t>(result.columns(f)) * result.rows(f));
  }
}

/// A run of entries before its place in the front is known: the rows of one block in one column of the matrix.
struct LooseRun {
  std::int64_t source;
  std::int32_t row, column, count;  ///< of the first entry, in the order of elimination
  bool transposed;                  ///< the entries lie in one row, columns ascending
};

template <class Visit>
void each_run(const SparseSymmetric& pattern, const NodeBlocks& blocks, const Numbering& numbering, Visit visit) {
  const auto place_of = [&](std::int32_t row) {
    const auto b = static_cast<std::size_t>(blocks.block_of[static_cast<std::size_t>(row)]);
    return numbering.place[b] + row - blocks.first_row[b];
  };
  for (std::int32_t c = 0; c < pattern.size; ++c) {
    const auto end = pattern.start[static_cast<std::size_t>(c) + 1];
    const std::int32_t own = place_of(c);
    for (auto k = pattern.start[static_cast<std::size_t>(c)]; k < end;) {
      const std::int32_t row = pattern.row[static_cast<std::size_t>(k)],
                         block = blocks.block_of[static_cast<std::size_t>(row)];
      std::int32_t count = 1;
      while (k + count < end && pattern.row[static_cast<std::size_t>(k + count)] == row + count &&
             blocks.block_of[static_cast<std::size_t>(row + count)] == block)
        ++count;
      const std::int32_t other = place_of(row);
      visit(other >= own ? LooseRun{k, other, own, count, false} : LooseRun{k, own, other, count, true});
      k += count;
    }
  }
}

/// Where every entry of the matrix goes.
void assign_entries(const SparseSymmetric& pattern, const NodeBlocks& blocks, const Numbering& numbering,
                    Supernodes& result) {
  const std::size_t fronts = result.parent.size();
  const auto front_of = [&](const LooseRun& run) {
    const auto natural = static_cast<std::size_t>(result.order[static_cast<std::size_t>(run.column)]);
    return static_cast<std::size_t>(numbering.front_of[static_cast<std::size_t>(blocks.block_of[natural])]);
  };
  result.entry_start.assign(fronts + 1, 0);
  each_run(pattern, blocks, numbering, [&](const LooseRun& run) { ++result.entry_start[front_of(run) + 1]; });
  std::partial_sum(result.entry_start.begin(), result.entry_start.end(), result.entry_start.begin());
  std::vector<LooseRun> runs(static_cast<std::size_t>(result.entry_start.back()));
  std::vector<std::int64_t> next(result.entry_start);
  each_run(pattern, blocks, numbering,
           [&](const LooseRun& run) { runs[static_cast<std::size_t>(next[front_of(run)]++)] = run; });
  result.entry.reserve(runs.size());
  std::vector<std::int32_t> local(result.order.size());
  for (std::size_t f = 0; f < fronts; ++f) {
    const std::int32_t rows = result.rows(f);
    for (std::int32_t i = 0; i < rows; ++i)
      local[static_cast<std::size_t>(result.row[static_cast<std::size_t>(result.row_start[f] + i)])] = i;
    for (auto k = result.entry_start[f]; k < result.entry_start[f + 1]; ++k) {
      const LooseRun& run = runs[static_cast<std::size_t>(k)];
      const std::int64_t column = run.column - result.first[f];
      const std::int64_t place = result.value_start[f] + column * rows + local[static_cast<std::size_t>(run.row)];
      result.entry.push_back({run.source, place, run.transposed ? rows : 1, run.count});
    }
  }
}

}  // namespace

double Supernodes::front_operations(std::size_t f) const { return elimination_operations(columns(f), rows(f)); }

Supernodes find_supernodes(const SparseSymmetric& pattern, const std::vector<int>& order) {
  const NodeBlocks blocks = find_node_blocks(pattern, order);
  FrontTree tree = make_front_tree(blocks);
  Supernodes result;
  result.operations = blocks.operations;
  result.order.reserve(order.size());
  const Numbering numbering = number_blocks(blocks, tree, result);
  find_rows(blocks, tree, numbering, result);
  result.parent = std::move(tree.parent);
  assign_entries(pattern, blocks, numbering, result);
  return result;
}

}  // namespace topple::solver
