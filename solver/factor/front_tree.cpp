#include "factor/front_tree.h"

#include <algorithm>
#include <utility>

namespace topple::solver {
namespace {

// What a front costs, in nanoseconds on a processor of 2023; the ratios decide, and they vary little.
constexpr double front_cost = 1500;       ///< however small it is
constexpr double entry_cost = 4;          ///< for each stored entry: cleared, filled, packed, written, read by solves
constexpr double update_cost = 0.8;       ///< for each entry of the update: cleared, added to the front above
constexpr double operation_cost = 0.025;  ///< for each multiply-add, in fronts of middling size

double front_time(double columns, double rows) {
  const double below = rows - columns;
  return front_cost + entry_cost * columns * rows + update_cost * below * below +
         operation_cost * elimination_operations(columns, rows);
}

/// Blocks joined into fronts, each known by its last block, which is the root of its part of the tree.
class Joining {
 public:
  explicit Joining(const NodeBlocks& blocks)
      : columns_(blocks.rows),
        rows_(blocks.column_length),
        parent_(blocks.parent),
        members_(blocks.rows.size()),
        children_(blocks.rows.size()),
        joined_(blocks.rows.size(), 0) {
    const auto count = static_cast<std::int32_t>(blocks.rows.size());
    for (std::int32_t b = 0; b < count; ++b) {
      members_[static_cast<std::size_t>(b)] = {b};
      const std::int32_t p = parent_[static_cast<std::size_t>(b)];
      if (p >= 0) children_[static_cast<std::size_t>(p)].push_back(b);
    }
    for (std::int32_t b = 0; b < count; ++b) join_children(static_cast<std::size_t>(b));
  }

  [[nodiscard]] FrontTree numbered();

 private:
  void join_children(std::size_t front) {
    std::vector<std::int32_t> stay, look = std::move(children_[front]);
    // Those that share most of their rows first: they store the fewest zeros.
    std::stable_sort(look.begin(), look.end(), [&](std::int32_t a, std::int32_t b) {
      return rows_[static_cast<std::size_t>(a)] > rows_[static_cast<std::size_t>(b)];
    });
    for (std::size_t i = 0; i < look.size(); ++i) {
      const auto child = static_cast<std::size_t>(look[i]);
      if (!worth_joining(child, front)) {
        stay.push_back(look[i]);
        continue;
      }
      columns_[front] += columns_[child];
      rows_[front] += columns_[child];
      std::vector<std::int32_t>& members = members_[child];
      members.insert(members.end(), members_[front].begin(), members_[front].end());
      members_[front] = std::move(members);
      members_[child] = {};
      joined_[child] = 1;
      look.insert(look.end(), children_[child].begin(), children_[child].end());
      children_[child] = {};
    }
    children_[front] = std::move(stay);
  }

  [[nodiscard]] bool worth_joining(std::size_t child, std::size_t front) const {
    const double columns = columns_[child], rows = rows_[child];
    return front_time(columns_[front] + columns, rows_[front] + columns) <=
           front_time(columns_[front], rows_[front]) + front_time(columns, rows);
  }

  void order_children();

  std::vector<std::int32_t> columns_, rows_, parent_;
  std::vector<std::vector<std::int32_t>> members_, children_;
  std::vector<char> joined_;
};

/// Liu's order: by what a subtree needs beyond what it leaves behind.
void Joining::order_children() {
  const std::size_t count = columns_.size();
  std::vector<double> peak(count, 0);
  const auto update = [&](std::size_t f) {
    const double below = rows_[f] - columns_[f];
    return below * below;
  };
  for (std::size_t f = 0; f < count; ++f) {
    if (joined_[f] != 0) continue;
    const auto excess = [&](std::int32_t c) {
      return peak[static_cast<std::size_t>(c)] - update(static_cast<std::size_t>(c));
    };
    std::stable_sort(children_[f].begin(), children_[f].end(),
                     [&](std::int32_t a, std::int32_t b) { return excess(a) > excess(b); });
    double waiting = 0;
    for (const std::int32_t c : children_[f]) {
      peak[f] = std::max(peak[f], waiting + peak[static_cast<std::size_t>(c)]);
      waiting += update(static_cast<std::size_t>(c));
    }
    peak[f] = std::max(peak[f], waiting + update(f));
  }
}

FrontTree Joining::numbered() {
  order_children();
  const std::size_t count = columns_.size();
  FrontTree tree;
  std::vector<std::int32_t> number(count, -1);
  std::vector<std::pair<std::int32_t, std::size_t>> stack;  // a front, and how many of its children are done
  for (std::size_t root = 0; root < count; ++root) {
    if (joined_[root] != 0 || parent_[root] >= 0) continue;
    stack.emplace_back(static_cast<std::int32_t>(root), 0);
    while (!stack.empty()) {
      const auto f = static_cast<std::size_t>(stack.back().first);
      if (stack.back().second < children_[f].size()) {
        stack.emplace_back(children_[f][stack.back().second++], 0);
        continue;
      }
      stack.pop_back();
      number[f] = static_cast<std::int32_t>(tree.parent.size());
      tree.parent.push_back(-1);
      tree.blocks.push_back(std::move(members_[f]));
      std::vector<std::int32_t>& children = tree.children.emplace_back();
      for (const std::int32_t c : children_[f]) {
        children.push_back(number[static_cast<std::size_t>(c)]);
        tree.parent[static_cast<std::size_t>(children.back())] = number[f];
      }
    }
  }
  return tree;
}

}  // namespace

double elimination_operations(double columns, double rows) {
  // The sum of (rows - j)^2 over j < columns.
  const double below = rows - columns;
  const auto squares = [](double n) { return n * (n + 1) * (2 * n + 1) / 6; };
  return squares(rows) - squares(below);
}

FrontTree make_front_tree(const NodeBlocks& blocks) { return Joining(blocks).numbered(); }

}  // namespace topple::solver
