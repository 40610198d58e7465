// The structure of a TriangularSolver: its blocks of columns as the factor has them, elimination paths, and costs.
#include <algorithm>
#include <cmath>

#include "factor/triangular.h"
#include "reanalysis/work_count.h"

namespace topple::solver {

TriangularSolver::TriangularSolver(const Factor& factor) {
  const FactorView view = factor.view();
  size_ = static_cast<int>(view.order.size());
  order_.assign(view.order.begin(), view.order.end());
  if (view.supernodal) {
    load_supernodal(view);
  } else {
    load_simplicial(view);
  }
  finish();
}

void TriangularSolver::load_supernodal(const FactorView& view) {
  first_ = view.first;
  row_start_ = view.row_start;
  value_start_ = view.start;
  row_ = view.row;
  value_ = view.value;
}

/// Gathers runs of columns in which each one's pattern is the next one's and the next one itself.
void TriangularSolver::load_simplicial(const FactorView& view) {
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
  cost_ = solver::pass_cost(entries_);
  find_runs();
}

double TriangularSolver::pass_cost(int block, int count) const {
  const auto b = static_cast<std::size_t>(block);
  const double entries =
      static_cast<double>(first_[b + 1] - first_[b]) * static_cast<double>(row_start_[b + 1] - row_start_[b]);
  return cost_.block + entries * (cost_.entry + cost_.further * (count - 1));
}

/// Rows that follow each other also do so on every path that both lie on: the next block is then the parent.
void TriangularSolver::find_runs() {
  run_start_.push_back(0);
  for (std::size_t b = 0; b < parent_.size(); ++b) {
    const std::span<const std::int64_t> below = block(static_cast<int>(b)).below;
    for (std::size_t i = 0; i < below.size(); ++i) {
      if (i > 0 && below[i] == below[i - 1] + 1) {
        ++run_.back().count;
        continue;
      }
      const int row = static_cast<int>(below[i]);
      const auto of = static_cast<std::size_t>(block_of_[static_cast<std::size_t>(row)]);
      run_.push_back({static_cast<int>(i), row, 1, rows_to_root_[of] - (row - static_cast<int>(first_[of]))});
    }
    run_start_.push_back(static_cast<std::int64_t>(run_.size()));
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

void TriangularSolver::mark_paths(std::span<const int> rows, std::vector<char>& marked) const {
  marked.assign(parent_.size(), 0);
  for (const int row : rows) {
    for (int block = block_of_[static_cast<std::size_t>(position(row))];
         block >= 0 && marked[static_cast<std::size_t>(block)] == 0; block = parent_[static_cast<std::size_t>(block)])
      marked[static_cast<std::size_t>(block)] = 1;
  }
}

}  // namespace topple::solver
