#include "factor/triangular.h"

#include <algorithm>
#include <cmath>

#include "factor/multiple_right_hand_sides.h"
#include "factor/panel_substitution.h"
#include "factor/vector_versions.h"
#include "reanalysis/work_count.h"

namespace topple::solver {
namespace {

/// One block of the factor: `columns` dense columns of `rows` entries, the triangle first.
struct Block {
  const double* value;
  int columns, rows;
  [[nodiscard]] int below() const { return rows - columns; }
};

template <class Eight>
[[gnu::always_inline]] inline void subtract(const double* from, const RowsInLine& run, double* to) {
  each_lanes<Eight>(
      run.count, [&]([[maybe_unused]] auto lanes, int i) __attribute__((always_inline)) {
        lanes_at<decltype(lanes)>(to + i) -= lanes_at<decltype(lanes)>(from + run.from + i);
      });
}

template <class Eight>
[[gnu::always_inline]] inline void gather_runs(std::span<const RowsInLine> runs, const double* y, double* compact) {
  for (const RowsInLine& run : runs)
    each_lanes<Eight>(
        run.count, [&]([[maybe_unused]] auto lanes, int i) __attribute__((always_inline)) {
          lanes_at<decltype(lanes)>(compact + run.from + i) = lanes_at<decltype(lanes)>(y + run.row + i);
        });
}
template <class Eight>
[[gnu::always_inline]] inline void subtract_runs(std::span<const RowsInLine> runs, const double* compact, double* y) {
  for (const RowsInLine& run : runs) subtract<Eight>(compact, run, y + run.row);
}
template <class Eight>
[[gnu::always_inline]] inline void subtract_runs_from_end(std::span<const RowsInLine> runs, const double* compact,
                                                          double* end) {
  for (const RowsInLine& run : runs) subtract<Eight>(compact, run, end - run.from_end);
}

/// compact := the runs' rows of y.
TOPPLE_EIGHT_LANES(void gather_rows(std::span<const RowsInLine> runs, const double* y, double* compact),
                   gather_runs<Eight>(runs, y, compact);)

/// The runs' rows of y -= compact.
TOPPLE_EIGHT_LANES(void subtract_rows(std::span<const RowsInLine> runs, const double* compact, double* y),
                   subtract_runs<Eight>(runs, compact, y);)

/// The same on a path that ends there.
TOPPLE_EIGHT_LANES(void subtract_rows_from_end(std::span<const RowsInLine> runs, const double* compact, double* end),
                   subtract_runs_from_end<Eight>(runs, compact, end);)

}  // namespace

std::span<const RowsInLine> TriangularSolver::runs(std::size_t b) const {
  return std::span(run_).subspan(static_cast<std::size_t>(run_start_[b]),
                                 static_cast<std::size_t>(run_start_[b + 1] - run_start_[b]));
}

void TriangularSolver::permute(const Eigen::VectorXd& natural, Eigen::VectorXd& eliminated) const {
  eliminated.resize(size_);
  for (int k = 0; k < size_; ++k) eliminated(k) = natural(order_[static_cast<std::size_t>(k)]);
}

void TriangularSolver::restore(const Eigen::VectorXd& eliminated, Eigen::VectorXd& natural) const {
  natural.resize(size_);
  for (int k = 0; k < size_; ++k) natural(order_[static_cast<std::size_t>(k)]) = eliminated(k);
}

void TriangularSolver::multiply(const EliminationPath& path, const Eigen::MatrixXd& W, const Eigen::VectorXd& y,
                                double* product) const {
  std::fill(product, product + W.cols(), 0.0);
  for (std::size_t k = 0; k < path.block.size(); ++k)
    add_products(W.data() + path.offset[k], static_cast<int>(W.rows()), path.offset[k + 1] - path.offset[k],
                 static_cast<int>(W.cols()), y.data() + first_[static_cast<std::size_t>(path.block[k])], product);
}

void TriangularSolver::subtract(const EliminationPath& path, const Eigen::MatrixXd& W, const double* c,
                                Eigen::VectorXd& y) const {
  for (std::size_t k = 0; k < path.block.size(); ++k)
    subtract_combination(W.data() + path.offset[k], static_cast<int>(W.rows()), path.offset[k + 1] - path.offset[k],
                         static_cast<int>(W.cols()), c, y.data() + first_[static_cast<std::size_t>(path.block[k])]);
}

void TriangularSolver::forward(Eigen::VectorXd& y, const std::vector<char>* marked) const {
  double* below = below_.data();
  double work = 0;
  for (std::size_t b = 0; b < parent_.size(); ++b) {
    if (marked != nullptr && (*marked)[b] == 0) continue;
    work += pass_cost(static_cast<int>(b));
    eliminate_right_hand_sides(value_.data() + value_start_[b], static_cast<int>(first_[b + 1] - first_[b]),
                               static_cast<int>(row_start_[b + 1] - row_start_[b]), y.data() + first_[b], 1, below);
    subtract_rows(runs(b), below, y.data());
  }
  count_work(work);
}

TriangularSolver::BlockRows TriangularSolver::block(int block) const {
  const auto b = static_cast<std::size_t>(block);
  const auto columns = static_cast<std::size_t>(first_[b + 1] - first_[b]);
  const auto start = static_cast<std::size_t>(row_start_[b]), end = static_cast<std::size_t>(row_start_[b + 1]);
  return {static_cast<int>(first_[b]), static_cast<int>(columns), row_.subspan(start + columns, end - start - columns)};
}

void TriangularSolver::backward(int block, double* x, const double* below, int count) const {
  const auto b = static_cast<std::size_t>(block);
  substitute_back(value_.data() + value_start_[b], static_cast<int>(first_[b + 1] - first_[b]),
                  static_cast<int>(row_start_[b + 1] - row_start_[b]), x, count, below);
}

void TriangularSolver::backward(Eigen::VectorXd& y, const std::vector<char>* marked) const {
  double* below = below_.data();
  double work = 0;
  for (std::size_t b = parent_.size(); b-- > 0;) {
    if (marked != nullptr && (*marked)[b] == 0) continue;
    work += pass_cost(static_cast<int>(b));
    gather_rows(runs(b), y.data(), below);
    backward(static_cast<int>(b), y.data() + first_[b], below);
  }
  count_work(work);
}

/// The block's own rows of all columns, one after the other, in the scratch `together_`; room for the rows below them
/// in `below_`.
double* TriangularSolver::own_rows(std::size_t b, const Eigen::MatrixXd& y) const {
  const auto count = static_cast<std::size_t>(y.cols());
  const auto columns = static_cast<std::size_t>(first_[b + 1] - first_[b]);
  const auto rows = static_cast<std::size_t>(row_start_[b + 1] - row_start_[b]);
  if (below_.size() < (rows - columns) * count) below_.resize((rows - columns) * count);
  if (together_.size() < columns * count) together_.resize(columns * count);
  for (std::size_t c = 0; c < count; ++c)
    std::copy_n(y.col(static_cast<Eigen::Index>(c)).data() + first_[b], columns, together_.data() + c * columns);
  return together_.data();
}

void TriangularSolver::put_own_rows(std::size_t b, Eigen::MatrixXd& y) const {
  const auto columns = static_cast<std::size_t>(first_[b + 1] - first_[b]);
  for (std::size_t c = 0; c < static_cast<std::size_t>(y.cols()); ++c)
    std::copy_n(together_.data() + c * columns, columns, y.col(static_cast<Eigen::Index>(c)).data() + first_[b]);
}

void TriangularSolver::forward(Eigen::MatrixXd& y, const std::vector<char>* marked) const {
  const auto count = static_cast<int>(y.cols());
  double work = 0;
  for (std::size_t b = 0; b < parent_.size(); ++b) {
    if (marked != nullptr && (*marked)[b] == 0) continue;
    work += pass_cost(static_cast<int>(b), count);
    const auto columns = static_cast<int>(first_[b + 1] - first_[b]);
    const auto rows = static_cast<int>(row_start_[b + 1] - row_start_[b]);
    double* own = own_rows(b, y);
    eliminate_right_hand_sides(value_.data() + value_start_[b], columns, rows, own, count, below_.data());
    put_own_rows(b, y);
    for (int c = 0; c < count; ++c)
      subtract_rows(runs(b), below_.data() + static_cast<std::ptrdiff_t>(c) * (rows - columns), y.col(c).data());
  }
  count_work(work);
}

void TriangularSolver::backward(Eigen::MatrixXd& y, const std::vector<char>* marked) const {
  const auto count = static_cast<int>(y.cols());
  double work = 0;
  for (std::size_t b = parent_.size(); b-- > 0;) {
    if (marked != nullptr && (*marked)[b] == 0) continue;
    work += pass_cost(static_cast<int>(b), count);
    double* own = own_rows(b, y);
    const std::ptrdiff_t below_rows = row_start_[b + 1] - row_start_[b] - (first_[b + 1] - first_[b]);
    for (int c = 0; c < count; ++c) gather_rows(runs(b), y.col(c).data(), below_.data() + c * below_rows);
    backward(static_cast<int>(b), own, below_.data(), count);
    put_own_rows(b, y);
  }
  count_work(work);
}

void TriangularSolver::forward(std::span<const PathColumns> groups, Eigen::VectorXd* y,
                               const std::vector<char>* marked) const {
  // More are no faster together, and take longer before anything else can be done.
  constexpr Eigen::Index most_together = 48;
  Eigen::Index columns = 0;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    columns += groups[g].columns->cols();
    if (columns <= most_together || g == 0) continue;
    forward(groups.first(g), y, marked);
    return forward(groups.subspan(g));
  }
  next_.assign(groups.size(), 0);
  double work = 0;
  for (std::size_t b = 0; b < parent_.size(); ++b) {
    // Paths ascend.
    sharing_.clear();
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const std::vector<int>& path = groups[g].path->block;
      if (next_[g] == path.size() || path[next_[g]] != static_cast<int>(b)) continue;
      sharing_.push_back(g);
      ++next_[g];
    }
    const bool along = y != nullptr && (marked == nullptr || (*marked)[b] != 0);
    if (!along && sharing_.empty()) continue;
    int count = along ? 1 : 0;
    for (const std::size_t g : sharing_) count += static_cast<int>(groups[g].columns->cols());
    work += pass_cost(static_cast<int>(b), count);
    forward_block_of(b, groups, along ? y : nullptr);
  }
  count_work(work);
}

/// One block, for the groups in sharing_ and y (unless null).
void TriangularSolver::forward_block_of(std::size_t b, std::span<const PathColumns> groups, Eigen::VectorXd* y) const {
  const Block block{value_.data() + value_start_[b], static_cast<int>(first_[b + 1] - first_[b]),
                    static_cast<int>(row_start_[b + 1] - row_start_[b])};
  int count = y != nullptr ? 1 : 0;
  for (const std::size_t g : sharing_) count += static_cast<int>(groups[g].columns->cols());
  const auto grow = [](std::vector<double>& store, int rows, int columns) {
    const std::size_t size = static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
    if (store.size() < size) store.resize(size);
  };
  grow(together_, block.columns, count);
  grow(below_, block.below(), count);
  const auto each_column = [&](auto&& work) {
    int at = 0;
    for (const std::size_t g : sharing_) {
      Eigen::MatrixXd& columns = *groups[g].columns;
      // Where the block's first row stands in a column, counted from the column's end.
      for (Eigen::Index c = 0; c < columns.cols(); ++c, ++at) work(columns.col(c).data() + columns.rows(), at);
    }
  };
  double *x = together_.data(), *below = below_.data();
  const int own = rows_to_root_[b];
  // That of y comes last.
  double *last = x + static_cast<std::ptrdiff_t>(count - 1) * block.columns, *y_own = nullptr;
  if (y != nullptr) {
    y_own = y->data() + first_[b];
    std::copy(y_own, y_own + block.columns, last);
  }
  each_column([&](double* end, int at) {
    std::copy(end - own, end - own + block.columns, x + static_cast<std::ptrdiff_t>(at) * block.columns);
  });
  eliminate_right_hand_sides(block.value, block.columns, block.rows, x, count, below);
  each_column([&](double* end, int at) {
    const double* from = x + static_cast<std::ptrdiff_t>(at) * block.columns;
    std::copy(from, from + block.columns, end - own);
    subtract_rows_from_end(runs(b), below + static_cast<std::ptrdiff_t>(at) * block.below(), end);
  });
  if (y == nullptr) return;
  std::copy(last, last + block.columns, y_own);
  subtract_rows(runs(b), below + static_cast<std::ptrdiff_t>(count - 1) * block.below(), y->data());
}

}  // namespace topple::solver
