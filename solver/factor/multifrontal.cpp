#include "factor/multifrontal.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "factor/multiple_right_hand_sides.h"
#include "factor/panel_substitution.h"
#include "parallel/task_team.h"
#include "topple/solver/parallel_for.h"

namespace topple::solver {
namespace {

/// Several threads: a subtree is one thread's when it holds at most this share of all work divided by their number, or
/// this many multiply-adds.
constexpr double item_share = 1.0 / 12, least_item = 1e6;
/// Below so many multiply-adds in all (a millisecond or two) starting threads takes longer than they save.
constexpr double least_parallel = 5e7;
/// Fronts with at least so many are cut into tiles for several threads.
constexpr double least_split = 4e6;
/// Entries that are cleared and added to together: they stay in the second-level cache meanwhile.
constexpr int assembly_entries = 1 << 15;

std::size_t entries_of_update(int below) { return UpdateLayout(below).entries(); }

}  // namespace

/// What one thread needs besides the factor. Updates inside of an item wait on two stacks: a front's children lie at
/// the top of the one, its own update goes on the other.
struct MultifrontalFactor::Worker {
  FrontWorkspace workspace;
  LargeBuffer stack[2];
  std::size_t used[2] = {0, 0};
  std::vector<RowRun> runs;  ///< of the children of the front at hand, one child after the other
  std::vector<std::size_t> run_start;
};

MultifrontalFactor::MultifrontalFactor(const SparseSymmetric& pattern, const std::vector<int>& order, int threads)
    : fronts_(find_supernodes(pattern, order)), threads_(threads) {
  const auto count = static_cast<std::size_t>(fronts_.count());
  child_start_.assign(count + 1, 0);
  for (const std::int32_t p : fronts_.parent)
    if (p >= 0) ++child_start_[static_cast<std::size_t>(p) + 1];
  std::partial_sum(child_start_.begin(), child_start_.end(), child_start_.begin());
  child_.resize(static_cast<std::size_t>(child_start_.back()));
  std::vector<std::int64_t> next(child_start_);
  odd_.assign(count, 0);
  for (std::size_t f = 0; f < count; ++f)
    if (const std::int32_t p = fronts_.parent[f]; p >= 0)
      child_[static_cast<std::size_t>(next[static_cast<std::size_t>(p)]++)] = static_cast<std::int32_t>(f);
  for (std::size_t f = count; f-- > 0;) {
    if (const std::int32_t p = fronts_.parent[f]; p >= 0) odd_[f] = odd_[static_cast<std::size_t>(p)] == 0 ? 1 : 0;
    most_columns_ = std::max(most_columns_, fronts_.columns(f));
    most_below_ = std::max(most_below_, fronts_.rows(f) - fronts_.columns(f));
  }
  find_items();
  find_stacks();
}

MultifrontalFactor::MultifrontalFactor(const MultifrontalFactor& other)
    : fronts_(other.fronts_),
      child_start_(other.child_start_),
      child_(other.child_),
      odd_(other.odd_),
      items_(other.items_),
      item_parent_(other.item_parent_),
      stack_entries_{other.stack_entries_[0], other.stack_entries_[1]},
      threads_(other.threads_),
      most_columns_(other.most_columns_),
      most_below_(other.most_below_),
      values_(other.values_.size()),
      failed_(other.failed_.load()),
      negative_(other.negative_) {
  std::copy_n(other.values_.data(), other.values_.size(), values_.data());
}

MultifrontalFactor::~MultifrontalFactor() = default;

void MultifrontalFactor::find_items() {
  const auto count = static_cast<std::size_t>(fronts_.count());
  std::vector<double> work(count);
  std::vector<std::int32_t> size(count, 1), item_of(count, -1);
  double total = 0;
  for (std::size_t f = 0; f < count; ++f) {
    const double own = fronts_.front_operations(f);
    work[f] += own;
    total += own;
    if (fronts_.parent[f] < 0) continue;
    const auto p = static_cast<std::size_t>(fronts_.parent[f]);
    work[p] += work[f];
    size[p] += size[f];
  }
  const double most = threads_ == 1 ? total : std::max(total * item_share / threads_, least_item);
  for (std::size_t f = 0; f < count; ++f) {
    const bool small = work[f] <= most;
    const std::int32_t p = fronts_.parent[f];
    if (small && p >= 0 && work[static_cast<std::size_t>(p)] <= most) continue;  // goes with its parent
    const auto last = static_cast<std::int32_t>(f);
    item_of[f] = static_cast<std::int32_t>(items_.size());
    items_.push_back({small ? last - size[f] + 1 : last, last});
  }
  for (const Item& item : items_) {
    const std::int32_t p = fronts_.parent[static_cast<std::size_t>(item.last)];
    item_parent_.push_back(p < 0 ? -1 : item_of[static_cast<std::size_t>(p)]);
  }
}

void MultifrontalFactor::find_stacks() {
  for (const Item& item : items_) {
    std::size_t used[2] = {0, 0};
    for (std::int32_t i = item.first; i < item.last; ++i) {
      const auto f = static_cast<std::size_t>(i);
      std::size_t& own = used[static_cast<std::size_t>(odd_[f])];
      own += entries_of_update(fronts_.rows(f) - fronts_.columns(f));
      std::size_t& most = stack_entries_[static_cast<std::size_t>(odd_[f])];
      most = std::max(most, own);
      for (auto k = child_start_[f]; k < child_start_[f + 1]; ++k) {
        const auto c = static_cast<std::size_t>(child_[static_cast<std::size_t>(k)]);
        used[static_cast<std::size_t>(odd_[c])] -= entries_of_update(fronts_.rows(c) - fronts_.columns(c));
      }
    }
  }
}

std::int64_t MultifrontalFactor::factorise(const SparseSymmetric& matrix) {
  indefinite_ = false;
  negative_.clear();
  return factorise_with(matrix);
}

std::int64_t MultifrontalFactor::factorise_indefinite(const SparseSymmetric& matrix) {
  indefinite_ = true;
  negative_.clear();
  negative_of_front_.assign(static_cast<std::size_t>(fronts_.count()), {});
  const std::int64_t done = factorise_with(matrix);
  for (std::size_t f = 0; f < negative_of_front_.size(); ++f)
    for (const int column : negative_of_front_[f]) negative_.push_back(fronts_.first[f] + column);
  negative_of_front_.clear();
  return done;
}

std::int64_t MultifrontalFactor::factorise_with(const SparseSymmetric& matrix) {
  const auto count = static_cast<std::size_t>(fronts_.count());
  if (values_.size() == 0) values_ = LargeBuffer(static_cast<std::size_t>(fronts_.value_start.back()));
  update_.assign(count, nullptr);
  kept_update_.resize(count);
  failed_ = std::numeric_limits<std::int64_t>::max();
  TaskTeam team(items_.size() > 1 && fronts_.operations >= least_parallel ? threads_ : 1);
  std::vector<Worker> workers(static_cast<std::size_t>(team.threads()));
  team.run_tree(item_parent_, [&](int item, int worker) {
    run_item(static_cast<std::size_t>(item), workers[static_cast<std::size_t>(worker)], matrix, team);
  });
  kept_update_.clear();
  spare_.clear();
  return std::min(failed_.load(), static_cast<std::int64_t>(fronts_.order.size()));
}

void MultifrontalFactor::run_item(std::size_t item, Worker& worker, const SparseSymmetric& matrix, TaskTeam& team) {
  const auto [first, last] = items_[item];
  for (std::size_t parity : {0, 1}) {
    worker.used[parity] = 0;
    if (first != last && worker.stack[parity].size() < stack_entries_[parity])
      worker.stack[parity] = LargeBuffer(stack_entries_[parity]);
  }
  for (std::int32_t f = first; f <= last; ++f) {
    const auto front = static_cast<std::size_t>(f);
    // Columns before the first that failed are eliminated all the same: which one is reported must not depend on who
    // came first.
    if (fronts_.first[front] > failed_.load()) return;
    const bool large = fronts_.front_operations(front) >= least_split;
    if (process(front, f == last, worker, matrix, large ? &team : nullptr)) continue;
    return;
  }
}

bool MultifrontalFactor::process(std::size_t f, bool keep_update, Worker& worker, const SparseSymmetric& matrix,
                                 TaskTeam* team) {
  Front front;
  front.rows = fronts_.rows(f);
  front.pivots = fronts_.columns(f);
  front.panel = values_.data() + fronts_.value_start[f];
  const std::size_t update = entries_of_update(front.below());
  if (keep_update) {
    kept_update_[f] = spare_.acquire(update);
    front.update = kept_update_[f].data();
  } else {
    const auto parity = static_cast<std::size_t>(odd_[f]);
    front.update = worker.stack[parity].data() + worker.used[parity];
    worker.used[parity] += update;
  }
  update_[f] = front.update;
  map_children(f, worker);
  assemble(f, front, worker, 0, front.pivots, team);
  add_entries(f, matrix);
  const int done = eliminate(front, worker.workspace, team, indefinite_ ? &negative_of_front_[f] : nullptr);
  if (done == front.pivots) {
    assemble(f, front, worker, front.pivots, front.rows, team);
    drop_updates(f, worker);
    return true;
  }
  const std::int64_t column = fronts_.first[f] + done;
  std::int64_t known = failed_.load();
  while (column < known && !failed_.compare_exchange_weak(known, column)) {
  }
  return false;
}

/// Which rows of the children's updates lie where in the front.
void MultifrontalFactor::map_children(std::size_t f, Worker& worker) const {
  worker.runs.clear();
  worker.run_start.assign(1, 0);
  const std::int64_t* own = fronts_.row.data() + fronts_.row_start[f];
  for (auto k = child_start_[f]; k < child_start_[f + 1]; ++k) {
    const auto c = static_cast<std::size_t>(child_[static_cast<std::size_t>(k)]);
    const std::int64_t* rows = fronts_.row.data() + fronts_.row_start[c] + fronts_.columns(c);
    const std::int32_t count = fronts_.rows(c) - fronts_.columns(c);
    std::int32_t at = 0;
    for (std::int32_t i = 0; i < count;) {
      while (own[at] != rows[i]) ++at;
      RowRun run{i, at, 1};
      while (i + run.count < count && own[at + run.count] == rows[i + run.count]) ++run.count;
      i += run.count;
      at += run.count;
      worker.runs.push_back(run);
    }
    worker.run_start.push_back(worker.runs.size());
  }
}

/// Columns [begin, end), in chunks.
void MultifrontalFactor::assemble(std::size_t f, const Front& front, const Worker& worker, int begin, int end,
                                  TaskTeam* team) const {
  const int columns = std::max(assembly_entries / front.rows, 8), chunks = (end - begin + columns - 1) / columns;
  const auto work = [&](int chunk) {
    const int from = begin + chunk * columns;
    assemble_columns(f, front, worker, from, std::min(from + columns, end));
  };
  if (team != nullptr) {
    team->split(chunks, work);
  } else {
    for (int chunk = 0; chunk < chunks; ++chunk) work(chunk);
  }
}

/// Clears columns of the panel and adds to these, or to columns of the update, what the children hand on, one child
/// after the other.
void MultifrontalFactor::assemble_columns(std::size_t f, const Front& front, const Worker& worker, int begin,
                                          int end) const {
  const auto column = [&](int j) { return front.panel + static_cast<std::ptrdiff_t>(j) * front.rows; };
  const bool in_panel = begin < front.pivots;
  const UpdateLayout layout(front.below());
  // Whole strips only: what lies above them is never read, and a large front's pages there are never touched.
  if (in_panel)
    for (int j = begin; j < end; ++j) std::fill(column(j) + j / strip_rows * strip_rows, column(j + 1), 0.0);
  const FrontKernels& kernels = front_kernels();
  for (auto k = child_start_[f]; k < child_start_[f + 1]; ++k) {
    const auto index = static_cast<std::size_t>(k - child_start_[f]);
    const auto c = static_cast<std::size_t>(child_[static_cast<std::size_t>(k)]);
    const UpdateLayout child(fronts_.rows(c) - fronts_.columns(c));
    const RowRun* last = worker.runs.data() + worker.run_start[index + 1];
    for (const RowRun* run = worker.runs.data() + worker.run_start[index]; run != last; ++run) {
      for (int i = std::max(0, begin - run->to); i < std::min(run->count, end - run->to); ++i) {
        const int j = run->to + i, own = j - front.pivots;
        double* to = in_panel ? column(j) : front.update;
        const std::ptrdiff_t skip = in_panel ? 0 : front.pivots - layout.column(own);
        const std::ptrdiff_t from = child.column(run->from + i);
        const RowRun rest{run->from + i, j, run->count - i};
        kernels.add_runs(to, skip, update_[c], from, &rest, 1);
        kernels.add_runs(to, skip, update_[c], from, run + 1, static_cast<int>(last - run) - 1);
      }
    }
  }
}

void MultifrontalFactor::add_entries(std::size_t f, const SparseSymmetric& matrix) {
  double* values = values_.data();
  for (auto k = fronts_.entry_start[f]; k < fronts_.entry_start[f + 1]; ++k) {
    const EntryRun& run = fronts_.entry[static_cast<std::size_t>(k)];
    const double* source = matrix.value.data() + run.source;
    double* to = values + run.place;
    for (std::int32_t i = 0; i < run.count; ++i) to[static_cast<std::ptrdiff_t>(i) * run.stride] += source[i];
  }
}

void MultifrontalFactor::drop_updates(std::size_t f, Worker& worker) {
  for (auto k = child_start_[f]; k < child_start_[f + 1]; ++k) {
    const auto c = static_cast<std::size_t>(child_[static_cast<std::size_t>(k)]);
    update_[c] = nullptr;
    if (kept_update_[c].size() > 0) {
      spare_.give_back(std::move(kept_update_[c]));
    } else {
      worker.used[static_cast<std::size_t>(odd_[c])] -= entries_of_update(fronts_.rows(c) - fronts_.columns(c));
    }
  }
}

void MultifrontalFactor::solve(Eigen::Ref<Eigen::MatrixXd> right_hand_sides) const {
  const auto n = static_cast<Eigen::Index>(fronts_.order.size());
  // So many together: more would not fit the caches beside a panel. Several threads go through the factor side by side,
  // each with columns of its own.
  constexpr Eigen::Index most_together = 12;
  // The factor is read once for a group: for fewer than this, reading it in each thread takes as long as the
  // arithmetic.
  constexpr Eigen::Index worth_a_group = 4;
  constexpr std::int64_t worth_a_thread = 1000000;  // entries of the factor: less is done before a thread has started
  const int threads = fronts_.value_start.back() >= worth_a_thread ? threads_ : 1;
  const Eigen::Index columns = right_hand_sides.cols();
  const auto groups = static_cast<int>(
      std::max<Eigen::Index>((columns + most_together - 1) / most_together,
                             std::min<Eigen::Index>(threads, (columns + worth_a_group - 1) / worth_a_group)));
  parallel_for(groups, threads, [&](int g) {
    const Eigen::Index first = g * columns / groups, count = (g + 1) * columns / groups - first;
    Eigen::MatrixXd y(n, count);
    for (Eigen::Index j = 0; j < count; ++j)
      for (Eigen::Index i = 0; i < n; ++i)
        y(i, j) = right_hand_sides(fronts_.order[static_cast<std::size_t>(i)], first + j);
    solve_in_order(y);
    for (Eigen::Index j = 0; j < count; ++j)
      for (Eigen::Index i = 0; i < n; ++i)
        right_hand_sides(fronts_.order[static_cast<std::size_t>(i)], first + j) = y(i, j);
  });
}

/// In the order of elimination: y := L^-T S L^-1 y.
void MultifrontalFactor::solve_in_order(Eigen::MatrixXd& y) const {
  const auto count = static_cast<int>(y.cols());
  std::vector<double> own_rows(static_cast<std::size_t>(most_columns_) * static_cast<std::size_t>(count)),
      below_rows(static_cast<std::size_t>(most_below_) * static_cast<std::size_t>(count));
  double *own = own_rows.data(), *below = below_rows.data();
  const auto each_front = [&](std::size_t f, auto&& work) {
    const std::int64_t* row = fronts_.row.data() + fronts_.row_start[f];
    work(values_.data() + fronts_.value_start[f], fronts_.columns(f), fronts_.rows(f), row);
  };
  const auto each_column = [&](auto&& work) {
    for (int j = 0; j < count; ++j) work(y.col(j).data(), j);
  };
  for (std::size_t f = 0; f < fronts_.parent.size(); ++f)
    each_front(f, [&](const double* L, int columns, int rows, const std::int64_t* row) {
      const int rest = rows - columns;
      each_column([&](const double* from, int j) { std::copy_n(from + row[0], columns, own + j * columns); });
      eliminate_right_hand_sides(L, columns, rows, own, count, below);
      each_column([&](double* to, int j) {
        std::copy_n(own + j * columns, columns, to + row[0]);
        const double* update = below + static_cast<std::ptrdiff_t>(j) * rest;
        for (int i = 0; i < rest; ++i) to[row[columns + i]] -= update[i];
      });
    });
  for (const std::int64_t k : negative_) y.row(k) *= -1;
  for (std::size_t f = fronts_.parent.size(); f-- > 0;)
    each_front(f, [&](const double* L, int columns, int rows, const std::int64_t* row) {
      const int rest = rows - columns;
      each_column([&](const double* from, int j) {
        std::copy_n(from + row[0], columns, own + j * columns);
        double* right = below + static_cast<std::ptrdiff_t>(j) * rest;
        for (int i = 0; i < rest; ++i) right[i] = from[row[columns + i]];
      });
      substitute_back(L, columns, rows, own, count, below);
      each_column([&](double* to, int j) { std::copy_n(own + j * columns, columns, to + row[0]); });
    });
}

}  // namespace topple::solver
