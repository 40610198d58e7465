#include "triangular.h"

#include <algorithm>
#include <cmath>

#include "few_columns.h"

extern "C" {
void dtrsv_(const char*, const char*, const char*, const int*, const double*, const int*, double*, const int*);
void dgemv_(const char*, const int*, const int*, const double*, const double*, const int*, const double*, const int*,
            const double*, double*, const int*);
void dtrsm_(const char*, const char*, const char*, const char*, const int*, const int*, const double*, const double*,
            const int*, double*, const int*);
void dgemm_(const char*, const char*, const int*, const int*, const int*, const double*, const double*, const int*,
            const double*, const int*, const double*, double*, const int*);
}

namespace topple::solver {
namespace {

/// Blocks with fewer entries than this are done by plain loops: a call of BLAS costs more than they do.
constexpr int small_block = 1024;
/// Up to so many right-hand sides BLAS loses to a plain pass over the block.
constexpr int few_columns = 12;
constexpr int one = 1;
constexpr double plus = 1, minus = -1, none = 0;

/// One block of the factor: `columns` dense columns of `rows` entries, the triangle first.
struct Block {
  const double* value;
  int columns, rows;
  [[nodiscard]] int below() const { return rows - columns; }
  [[nodiscard]] bool small() const { return columns * rows < small_block; }
};

/// x (the block's own rows) := triangle^-1 x; below := rectangle x.
void forward_block(const Block& b, double* x, double* below) {
  if (b.small()) {
    std::fill(below, below + b.below(), 0.0);
    for (int j = 0; j < b.columns; ++j) {
      const double* column = b.value + static_cast<std::ptrdiff_t>(j) * b.rows;
      const double xj = x[j] /= column[j];
      for (int i = j + 1; i < b.columns; ++i) x[i] -= column[i] * xj;
      for (int i = 0; i < b.below(); ++i) below[i] += column[b.columns + i] * xj;
    }
    return;
  }
  dtrsv_("L", "N", "N", &b.columns, b.value, &b.rows, x, &one);
  const int below_rows = b.below();
  if (below_rows > 0)
    dgemv_("N", &below_rows, &b.columns, &plus, b.value + b.columns, &b.rows, x, &one, &none, below, &one);
}

/// x := triangle^-T (x - rectangle' below).
void backward_block(const Block& b, double* x, const double* below) {
  if (b.small()) {
    for (int j = b.columns - 1; j >= 0; --j) {
      const double* column = b.value + static_cast<std::ptrdiff_t>(j) * b.rows;
      double sum = x[j];
      for (int i = j + 1; i < b.columns; ++i) sum -= column[i] * x[i];
      for (int i = 0; i < b.below(); ++i) sum -= column[b.columns + i] * below[i];
      x[j] = sum / column[j];
    }
    return;
  }
  const int below_rows = b.below();
  if (below_rows > 0)
    dgemv_("T", &below_rows, &b.columns, &minus, b.value + b.columns, &b.rows, below, &one, &plus, x, &one);
  dtrsv_("L", "T", "N", &b.columns, b.value, &b.rows, x, &one);
}

/// The same as forward_block() for several columns.
void forward_block(const Block& b, double* x, int count, double* below) {
  const int below_rows = b.below();
  if (count <= few_columns || b.small()) {
    eliminate_few_columns(b.value, b.columns, b.rows, x, count, below);
    return;
  }
  dtrsm_("L", "L", "N", "N", &b.columns, &count, &plus, b.value, &b.rows, x, &b.columns);
  if (below_rows > 0)
    dgemm_("N", "N", &below_rows, &count, &b.columns, &plus, b.value + b.columns, &b.rows, x, &b.columns, &none, below,
           &below_rows);
}

}  // namespace

TriangularSolver::TriangularSolver(const Factor& factor) {
  const FactorView view = factor.view();
  size_ = static_cast<int>(view.order.size());
  order_.assign(view.order.begin(), view.order.end());
  if (view.supernodal) {
    take_supernodal(view);
  } else {
    take_simplicial(view);
  }
  finish();
}

void TriangularSolver::take_supernodal(const FactorView& view) {
  first_ = view.first;
  row_start_ = view.row_start;
  value_start_ = view.start;
  row_ = view.row;
  value_ = view.value;
}

/// Gathers runs of columns in which each one's pattern is the next one's and the next one itself.
void TriangularSolver::take_simplicial(const FactorView& view) {
  const auto n = static_cast<std::size_t>(size_);
  const auto begin = [&](std::size_t j) { return static_cast<std::size_t>(view.start[j]); };
  const auto count = [&](std::size_t j) { return static_cast<std::size_t>(view.count[j]); };
  own_row_start_.push_back(0);
  own_value_start_.push_back(0);
  for (std::size_t j = 0; j < n;) {
    std::size_t end = j + 1;
    while (end < n && count(end - 1) == count(end) + 1 &&
           view.row[begin(end - 1) + 1] == static_cast<std::int64_t>(end))
      ++end;
    const std::size_t rows = count(j);
    own_first_.push_back(static_cast<std::int64_t>(j));
    for (std::size_t k = 0; k < rows; ++k) own_row_.push_back(view.row[begin(j) + k]);
    for (std::size_t c = j; c < end; ++c) {
      const double* values = view.value.data() + begin(c);
      const double pivot = view.is_ll ? 1.0 : std::sqrt(values[0]);
      own_value_.insert(own_value_.end(), c - j, 0.0);
      own_value_.push_back(view.is_ll ? values[0] : pivot);
      for (std::size_t k = 1; k < count(c); ++k) own_value_.push_back(values[k] * pivot);
    }
    own_row_start_.push_back(static_cast<std::int64_t>(own_row_.size()));
    own_value_start_.push_back(static_cast<std::int64_t>(own_value_.size()));
    j = end;
  }
  own_first_.push_back(static_cast<std::int64_t>(n));
  first_ = own_first_;
  row_start_ = own_row_start_;
  value_start_ = own_value_start_;
  row_ = own_row_;
  value_ = own_value_;
}

void TriangularSolver::finish() {
  position_.resize(order_.size());
  for (std::size_t k = 0; k < order_.size(); ++k) position_[static_cast<std::size_t>(order_[k])] = static_cast<int>(k);
  const std::size_t count = first_.empty() ? 0 : first_.size() - 1;
  block_of_.resize(order_.size());
  for (std::size_t b = 0; b < count; ++b)
    std::fill(block_of_.begin() + first_[b], block_of_.begin() + first_[b + 1], static_cast<int>(b));
  parent_.assign(count, -1);
  std::int64_t most_below = 0;
  for (std::size_t b = 0; b < count; ++b) {
    const std::int64_t columns = first_[b + 1] - first_[b], rows = row_start_[b + 1] - row_start_[b];
    if (rows > columns)
      parent_[b] = block_of_[static_cast<std::size_t>(row_[static_cast<std::size_t>(row_start_[b] + columns)])];
    most_below = std::max(most_below, rows - columns);
    entries_ += static_cast<double>(columns) * static_cast<double>(rows);
  }
  below_.resize(static_cast<std::size_t>(most_below));
  rows_to_root_.assign(count, 0);
  for (std::size_t b = count; b-- > 0;) {
    rows_to_root_[b] = static_cast<int>(first_[b + 1] - first_[b]);
    if (parent_[b] >= 0) rows_to_root_[b] += rows_to_root_[static_cast<std::size_t>(parent_[b])];
  }
}

double TriangularSolver::entries(const EliminationPath& path) const {
  double sum = 0;
  for (const int block : path.block) {
    const auto b = static_cast<std::size_t>(block);
    sum += static_cast<double>(first_[b + 1] - first_[b]) * static_cast<double>(row_start_[b + 1] - row_start_[b]);
  }
  return sum;
}

double TriangularSolver::entries_on_paths(std::span<const int> rows, std::vector<char>& marked) const {
  mark_paths(rows, marked);
  double sum = 0;
  for (std::size_t b = 0; b < marked.size(); ++b)
    if (marked[b] != 0)
      sum += static_cast<double>(first_[b + 1] - first_[b]) * static_cast<double>(row_start_[b + 1] - row_start_[b]);
  return sum;
}

void TriangularSolver::permute(const Eigen::VectorXd& natural, Eigen::VectorXd& eliminated) const {
  eliminated.resize(size_);
  for (int k = 0; k < size_; ++k) eliminated(k) = natural(order_[static_cast<std::size_t>(k)]);
}

void TriangularSolver::restore(const Eigen::VectorXd& eliminated, Eigen::VectorXd& natural) const {
  natural.resize(size_);
  for (int k = 0; k < size_; ++k) natural(order_[static_cast<std::size_t>(k)]) = eliminated(k);
}

EliminationPath TriangularSolver::path(std::span<const int> rows) const {
  EliminationPath result;
  int least = size_;
  for (const int row : rows) least = std::min(least, position(row));
  int offset = 0;
  for (int block = least < size_ ? block_of_[static_cast<std::size_t>(least)] : -1; block >= 0;
       block = parent_[static_cast<std::size_t>(block)]) {
    const auto b = static_cast<std::size_t>(block);
    result.block.push_back(block);
    result.offset.push_back(offset);
    offset += static_cast<int>(first_[b + 1] - first_[b]);
  }
  result.offset.push_back(offset);
  return result;
}

int TriangularSolver::row_on_path(const EliminationPath& path, int row) const {
  const int at = position(row), block = block_of_[static_cast<std::size_t>(at)];
  const auto found = std::lower_bound(path.block.begin(), path.block.end(), block);
  return path.offset[static_cast<std::size_t>(found - path.block.begin())] + at -
         static_cast<int>(first_[static_cast<std::size_t>(block)]);
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

void TriangularSolver::mark_paths(std::span<const int> rows, std::vector<char>& marked) const {
  marked.assign(parent_.size(), 0);
  for (const int row : rows) {
    for (int block = block_of_[static_cast<std::size_t>(position(row))];
         block >= 0 && marked[static_cast<std::size_t>(block)] == 0; block = parent_[static_cast<std::size_t>(block)])
      marked[static_cast<std::size_t>(block)] = 1;
  }
}

void TriangularSolver::forward(Eigen::VectorXd& y, const std::vector<char>* marked) const {
  double* below = below_.data();
  for (std::size_t b = 0; b < parent_.size(); ++b) {
    if (marked != nullptr && (*marked)[b] == 0) continue;
    const Block block{value_.data() + value_start_[b], static_cast<int>(first_[b + 1] - first_[b]),
                      static_cast<int>(row_start_[b + 1] - row_start_[b])};
    forward_block(block, y.data() + first_[b], below);
    const std::int64_t* rows = row_.data() + row_start_[b] + block.columns;
    for (int i = 0; i < block.below(); ++i) y(rows[i]) -= below[i];
  }
}

TriangularSolver::BlockRows TriangularSolver::block(int block) const {
  const auto b = static_cast<std::size_t>(block);
  const auto columns = static_cast<std::size_t>(first_[b + 1] - first_[b]);
  const auto start = static_cast<std::size_t>(row_start_[b]), end = static_cast<std::size_t>(row_start_[b + 1]);
  return {static_cast<int>(first_[b]), static_cast<int>(columns), row_.subspan(start + columns, end - start - columns)};
}

void TriangularSolver::backward(int block, double* x, const double* below) const {
  const auto b = static_cast<std::size_t>(block);
  backward_block({value_.data() + value_start_[b], static_cast<int>(first_[b + 1] - first_[b]),
                  static_cast<int>(row_start_[b + 1] - row_start_[b])},
                 x, below);
}

void TriangularSolver::backward(Eigen::VectorXd& y, const std::vector<char>* marked) const {
  double* below = below_.data();
  for (std::size_t b = parent_.size(); b-- > 0;) {
    if (marked != nullptr && (*marked)[b] == 0) continue;
    const Block block{value_.data() + value_start_[b], static_cast<int>(first_[b + 1] - first_[b]),
                      static_cast<int>(row_start_[b + 1] - row_start_[b])};
    const std::int64_t* rows = row_.data() + row_start_[b] + block.columns;
    for (int i = 0; i < block.below(); ++i) below[i] = y(rows[i]);
    backward_block(block, y.data() + first_[b], below);
  }
}

void TriangularSolver::backward(Eigen::MatrixXd& y) const {
  const int count = static_cast<int>(y.cols());
  const std::ptrdiff_t stride = y.rows();
  const std::size_t needed = below_.size() * static_cast<std::size_t>(count);
  std::vector<double> right(needed);
  for (std::size_t b = parent_.size(); b-- > 0;) {
    const Block block{value_.data() + value_start_[b], static_cast<int>(first_[b + 1] - first_[b]),
                      static_cast<int>(row_start_[b + 1] - row_start_[b])};
    const std::int64_t* rows = row_.data() + row_start_[b] + block.columns;
    const int below_rows = block.below();
    for (int c = 0; c < count; ++c) {
      const double* from = y.data() + c * stride;
      double* to = right.data() + static_cast<std::ptrdiff_t>(c) * below_rows;
      for (int i = 0; i < below_rows; ++i) to[i] = from[rows[i]];
    }
    double* x = y.data() + first_[b];
    const int ld = static_cast<int>(stride);
    if (block.small()) {
      for (int c = 0; c < count; ++c)
        backward_block(block, x + c * stride, right.data() + static_cast<std::ptrdiff_t>(c) * below_rows);
      continue;
    }
    if (below_rows > 0)
      dgemm_("T", "N", &block.columns, &count, &below_rows, &minus, block.value + block.columns, &block.rows,
             right.data(), &below_rows, &plus, x, &ld);
    dtrsm_("L", "L", "T", "N", &block.columns, &count, &plus, block.value, &block.rows, x, &ld);
  }
}

void TriangularSolver::forward(std::span<const PathColumns> groups) const {
  next_.assign(groups.size(), 0);
  for (;;) {
    // Paths ascend: the least block that is next on any of them, and all whose next it is.
    int block = -1;
    sharing_.clear();
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const std::vector<int>& path = groups[g].path->block;
      if (next_[g] == path.size()) continue;
      const int own = path[next_[g]];
      if (block < 0 || own < block) {
        block = own;
        sharing_.clear();
      }
      if (own == block) sharing_.push_back(g);
    }
    if (block < 0) return;
    for (const std::size_t g : sharing_) ++next_[g];
    forward_block_of(static_cast<std::size_t>(block), groups);
  }
}

/// One block, for the groups in sharing_.
void TriangularSolver::forward_block_of(std::size_t b, std::span<const PathColumns> groups) const {
  const Block block{value_.data() + value_start_[b], static_cast<int>(first_[b + 1] - first_[b]),
                    static_cast<int>(row_start_[b + 1] - row_start_[b])};
  int count = 0;
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
  double* x = together_.data();
  const int own = rows_to_root_[b];
  each_column([&](double* end, int at) {
    std::copy(end - own, end - own + block.columns, x + static_cast<std::ptrdiff_t>(at) * block.columns);
  });
  forward_block(block, x, count, below_.data());
  const std::int64_t* rows = row_.data() + row_start_[b] + block.columns;
  const int below_rows = block.below();
  each_column([&](double* end, int at) {
    const double* from = x + static_cast<std::ptrdiff_t>(at) * block.columns;
    std::copy(from, from + block.columns, end - own);
  });
  if (from_end_.size() < static_cast<std::size_t>(below_rows)) from_end_.resize(static_cast<std::size_t>(below_rows));
  for (int i = 0; i < below_rows; ++i) {
    const auto of = static_cast<std::size_t>(block_of_[static_cast<std::size_t>(rows[i])]);
    from_end_[static_cast<std::size_t>(i)] = rows_to_root_[of] - (rows[i] - first_[of]);
  }
  const std::int64_t* from_end = from_end_.data();
  each_column([&](double* end, int at) {
    const double* source = below_.data() + static_cast<std::ptrdiff_t>(at) * below_rows;
    for (int i = 0; i < below_rows; ++i) *(end - from_end[i]) -= source[i];
  });
}

}  // namespace topple::solver
