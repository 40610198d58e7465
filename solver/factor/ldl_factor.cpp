#include "factor/ldl_factor.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "parallel/one_blas_thread.h"

extern "C" {
void dgemm_(const char*, const char*, const int*, const int*, const int*, const double*, const double*, const int*,
            const double*, const int*, const double*, double*, const int*);
void dtrsm_(const char*, const char*, const char*, const char*, const int*, const int*, const double*, const double*,
            const int*, double*, const int*);
}

namespace topple::solver {
namespace {

/// For each place in the order, the earlier places that it couples with, and where the matrix has the entry.
struct Rows {
  std::vector<std::int64_t> start;
  std::vector<std::int32_t> column;
  std::vector<std::int64_t> source, diagonal;
};

Rows permuted_rows(const SparseSymmetric& A, const std::vector<std::int32_t>& place) {
  const auto n = static_cast<std::size_t>(A.size);
  Rows rows{std::vector<std::int64_t>(n + 1, 0), {}, {}, std::vector<std::int64_t>(n, 0)};
  const auto each = [&](const auto& visit) {
    for (std::size_t c = 0; c < n; ++c)
      for (auto k = A.start[c]; k < A.start[c + 1]; ++k) {
        const std::int32_t i = place[static_cast<std::size_t>(A.row[static_cast<std::size_t>(k)])], j = place[c];
        visit(static_cast<std::size_t>(std::max(i, j)), std::min(i, j), k);
      }
  };
  each([&](std::size_t row, std::int32_t column, std::int64_t) {
    if (static_cast<std::size_t>(column) != row) ++rows.start[row + 1];
  });
  std::partial_sum(rows.start.begin(), rows.start.end(), rows.start.begin());
  rows.column.resize(static_cast<std::size_t>(rows.start.back()));
  rows.source.resize(rows.column.size());
  std::vector<std::int64_t> next(rows.start.begin(), rows.start.end() - 1);
  each([&](std::size_t row, std::int32_t column, std::int64_t source) {
    if (static_cast<std::size_t>(column) == row) {
      rows.diagonal[row] = source;
      return;
    }
    const auto at = static_cast<std::size_t>(next[row]++);
    rows.column[at] = column;
    rows.source[at] = source;
  });
  return rows;
}

/// Liu's elimination tree with path compression.
std::vector<std::int32_t> elimination_tree(const Rows& rows) {
  const std::size_t n = rows.diagonal.size();
  std::vector<std::int32_t> parent(n, -1), ancestor(n, -1);
  for (std::size_t i = 0; i < n; ++i)
    for (auto k = rows.start[i]; k < rows.start[i + 1]; ++k) {
      std::int32_t j = rows.column[static_cast<std::size_t>(k)];
      while (j != -1 && j < static_cast<std::int32_t>(i)) {
        const std::int32_t next = ancestor[static_cast<std::size_t>(j)];
        ancestor[static_cast<std::size_t>(j)] = static_cast<std::int32_t>(i);
        if (next == -1) parent[static_cast<std::size_t>(j)] = static_cast<std::int32_t>(i);
        j = next;
      }
    }
  return parent;
}

/// Children before their parents, subtrees together.
std::vector<std::int32_t> postorder(const std::vector<std::int32_t>& parent) {
  const std::size_t n = parent.size();
  std::vector<std::int32_t> first(n, -1), sibling(n, -1), order, stack;
  for (std::size_t i = n; i-- > 0;) {
    const std::int32_t p = parent[i];
    if (p < 0) continue;
    sibling[i] = first[static_cast<std::size_t>(p)];
    first[static_cast<std::size_t>(p)] = static_cast<std::int32_t>(i);
  }
  order.reserve(n);
  for (std::size_t root = 0; root < n; ++root) {
    if (parent[root] >= 0) continue;
    stack.push_back(static_cast<std::int32_t>(root));
    while (!stack.empty()) {
      const auto at = static_cast<std::size_t>(stack.back());
      if (first[at] >= 0) {
        const std::int32_t child = first[at];
        first[at] = sibling[static_cast<std::size_t>(child)];
        stack.push_back(child);
      } else {
        order.push_back(stack.back());
        stack.pop_back();
      }
    }
  }
  return order;
}

/// Entries below the diagonal of each column of L, by the row subtrees.
std::vector<std::int32_t> column_counts(const Rows& rows, const std::vector<std::int32_t>& parent) {
  const std::size_t n = parent.size();
  std::vector<std::int32_t> count(n, 0), mark(n, -1);
  for (std::size_t i = 0; i < n; ++i) {
    const auto row = static_cast<std::int32_t>(i);
    mark[i] = row;
    for (auto k = rows.start[i]; k < rows.start[i + 1]; ++k)
      for (std::int32_t j = rows.column[static_cast<std::size_t>(k)]; mark[static_cast<std::size_t>(j)] != row;
           j = parent[static_cast<std::size_t>(j)]) {
        ++count[static_cast<std::size_t>(j)];
        mark[static_cast<std::size_t>(j)] = row;
      }
  }
  return count;
}

/// L D L' of the square on the diagonal, in place: D on the diagonal, L D below. Returns the negative pivots.
int eliminate_square(Eigen::Ref<Eigen::MatrixXd> square) {
  int negative = 0;
  const Eigen::Index w = square.rows();
  for (Eigen::Index j = 0; j < w; ++j) {
    double d = square(j, j);
    // A pivot that is exactly zero stands for a shift that hits an eigenvalue of a part: it counts as positive.
    if (d == 0) d = std::numeric_limits<double>::epsilon();
    if (d < 0) ++negative;
    for (Eigen::Index c = j + 1; c < w; ++c) square.col(c).tail(w - c) -= square(c, j) / d * square.col(j).tail(w - c);
    square(j, j) = d;
  }
  return negative;
}

/// A -= B C' below the diagonal of the square A, by strips, so that little above it is touched.
void subtract_lower_product(Eigen::Ref<Eigen::MatrixXd> A, const Eigen::MatrixXd& B,
                            const Eigen::Ref<const Eigen::MatrixXd>& C) {
  constexpr int strip = 96;
  const int n = static_cast<int>(A.rows()), k = static_cast<int>(B.cols());
  const int lda = static_cast<int>(A.outerStride()), ldb = static_cast<int>(B.outerStride()),
            ldc = static_cast<int>(C.outerStride());
  const double minus = -1, plus = 1;
  for (int from = 0; from < n; from += strip) {
    const int rows = n - from, columns = std::min(strip, rows);
    dgemm_("N", "T", &rows, &columns, &k, &minus, B.data() + from, &ldb, C.data() + from, &ldc, &plus,
           A.data() + from + static_cast<std::ptrdiff_t>(from) * lda, &lda);
  }
}

/// Eliminates the leading columns of a dense front; returns the negative pivots and leaves the rest updated.
int eliminate(Eigen::MatrixXd& front, Eigen::Index pivots) {
  constexpr Eigen::Index width = 48;
  int negative = 0;
  const Eigen::Index m = front.rows();
  for (Eigen::Index from = 0; from < pivots; from += width) {
    const Eigen::Index w = std::min(width, pivots - from), behind = from + w, below = m - behind;
    negative += eliminate_square(front.block(from, from, w, w));
    if (below == 0) break;
    const Eigen::VectorXd inverse = front.diagonal().segment(from, w).cwiseInverse();
    const Eigen::MatrixXd unit = front.block(from, from, w, w) * inverse.asDiagonal();
    // What is below the square is L D times its unit triangle.
    auto LD = front.block(behind, from, below, w);
    const int rows = static_cast<int>(below), columns = static_cast<int>(w),
              lda = static_cast<int>(front.outerStride());
    const double one = 1;
    dtrsm_("R", "L", "T", "U", &rows, &columns, &one, unit.data(), &columns, LD.data(), &lda);
    const Eigen::MatrixXd L = LD * inverse.asDiagonal();
    subtract_lower_product(front.bottomRightCorner(below, below), L, LD);
  }
  return negative;
}

}  // namespace

/// What a front hands to its parent: a dense lower triangle on these rows.
struct LdlFactor::Update {
  std::vector<std::int32_t> rows;
  Eigen::MatrixXd values;
};

LdlFactor::LdlFactor(const SparseSymmetric& matrix, std::span<const int> order)
    : place_(order.size()), block_of_(order.size()), local_(order.size(), -1) {
  use_one_blas_thread();
  const std::size_t n = order.size();
  for (std::size_t k = 0; k < n; ++k) place_[static_cast<std::size_t>(order[k])] = static_cast<std::int32_t>(k);
  // Subtrees together: what a front hands on then waits as briefly as it can.
  const std::vector<std::int32_t> post = postorder(elimination_tree(permuted_rows(matrix, place_)));
  std::vector<std::int32_t> position(n);
  for (std::size_t k = 0; k < n; ++k) position[static_cast<std::size_t>(post[k])] = static_cast<std::int32_t>(k);
  for (std::int32_t& p : place_) p = position[static_cast<std::size_t>(p)];
  const Rows rows = permuted_rows(matrix, place_);
  diagonal_source_ = rows.diagonal;
  // Columns of the lower triangle, from the rows.
  start_.assign(n + 1, 0);
  for (const std::int32_t c : rows.column) ++start_[static_cast<std::size_t>(c) + 1];
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  row_.resize(rows.column.size());
  source_.resize(rows.column.size());
  std::vector<std::int64_t> next(start_.begin(), start_.end() - 1);
  for (std::size_t i = 0; i < n; ++i)
    for (auto k = static_cast<std::size_t>(rows.start[i]); k < static_cast<std::size_t>(rows.start[i + 1]); ++k) {
      const auto at = static_cast<std::size_t>(next[static_cast<std::size_t>(rows.column[k])]++);
      row_[at] = static_cast<std::int32_t>(i);
      source_[at] = rows.source[k];
    }
  // A column joins the one before it when their patterns are the same, or nearly so for the first of the block: some
  // zeros cost less than handing an update on.
  constexpr double zeros = 0.35;  // of the first column
  const std::vector<std::int32_t> parent = elimination_tree(rows), count = column_counts(rows, parent);
  for (std::size_t j = 0; j < n; ++j) {
    bool joins = j > 0 && parent[j - 1] == static_cast<std::int32_t>(j);
    if (joins && count[j - 1] != count[j] + 1) {
      const auto first = static_cast<std::size_t>(first_.back());
      const auto joined = count[j] + static_cast<std::int32_t>(j - first);
      joins = joined - count[first] <= zeros * joined;
    }
    if (!joins) first_.push_back(static_cast<std::int32_t>(j));
    block_of_[j] = static_cast<std::int32_t>(first_.size()) - 1;
  }
  first_.push_back(static_cast<std::int32_t>(n));
}

int LdlFactor::factorise(const SparseSymmetric& matrix, bool keep) {
  value_.resize(source_.size());
  for (std::size_t k = 0; k < source_.size(); ++k) value_[k] = matrix.value[static_cast<std::size_t>(source_[k])];
  diagonal_.resize(diagonal_source_.size());
  for (std::size_t k = 0; k < diagonal_.size(); ++k)
    diagonal_[k] = matrix.value[static_cast<std::size_t>(diagonal_source_[k])];
  rows_.clear();
  panel_.clear();
  int negative = 0;
  const std::size_t blocks = first_.size() - 1;
  std::vector<std::vector<Update>> waiting(blocks);
  for (std::size_t b = 0; b < blocks; ++b) {
    std::vector<Update> children = std::move(waiting[b]);
    std::vector<std::int32_t> rows = pattern(b, children);
    for (std::size_t i = 0; i < rows.size(); ++i)
      local_[static_cast<std::size_t>(rows[i])] = static_cast<std::int32_t>(i);
    Eigen::MatrixXd front = assemble(b, rows.size(), children);
    children.clear();
    const Eigen::Index pivots = first_[b + 1] - first_[b], rest = front.rows() - pivots;
    negative += eliminate(front, pivots);
    if (rest > 0) {
      Update update{{rows.begin() + pivots, rows.end()}, Eigen::MatrixXd(rest, rest)};
      for (Eigen::Index c = 0; c < rest; ++c)
        update.values.col(c).tail(rest - c) = front.col(pivots + c).tail(rest - c);
      const auto parent = static_cast<std::size_t>(block_of_[static_cast<std::size_t>(update.rows.front())]);
      waiting[parent].push_back(std::move(update));
    }
    if (!keep) continue;
    panel_.emplace_back(front.leftCols(pivots));
    rows_.push_back(std::move(rows));
  }
  return negative;
}

std::vector<std::int32_t> LdlFactor::pattern(std::size_t b, const std::vector<Update>& children) const {
  std::vector<std::int32_t> rows;
  for (std::int32_t j = first_[b]; j < first_[b + 1]; ++j) {
    rows.push_back(j);
    const auto c = static_cast<std::size_t>(j);
    rows.insert(rows.end(), row_.begin() + start_[c], row_.begin() + start_[c + 1]);
  }
  for (const Update& child : children) rows.insert(rows.end(), child.rows.begin(), child.rows.end());
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  return rows;
}

Eigen::MatrixXd LdlFactor::assemble(std::size_t b, std::size_t size, const std::vector<Update>& children) const {
  const auto m = static_cast<Eigen::Index>(size);
  Eigen::MatrixXd front(m, m);  // its lower triangle counts
  for (Eigen::Index c = 0; c < m; ++c) front.col(c).tail(m - c).setZero();
  for (std::int32_t j = first_[b]; j < first_[b + 1]; ++j) {
    const auto c = static_cast<std::size_t>(j);
    const Eigen::Index column = j - first_[b];
    front(column, column) += diagonal_[c];
    for (auto e = static_cast<std::size_t>(start_[c]); e < static_cast<std::size_t>(start_[c + 1]); ++e)
      front(local_[static_cast<std::size_t>(row_[e])], column) += value_[e];
  }
  for (const Update& child : children)
    for (std::size_t c = 0; c < child.rows.size(); ++c) {
      double* column = front.col(local_[static_cast<std::size_t>(child.rows[c])]).data();
      const double* update = child.values.col(static_cast<Eigen::Index>(c)).data();
      for (std::size_t r = c; r < child.rows.size(); ++r)
        column[local_[static_cast<std::size_t>(child.rows[r])]] += update[r];
    }
  return front;
}

void LdlFactor::solve(Eigen::VectorXd& x) const {
  Eigen::VectorXd y(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) y(place_[static_cast<std::size_t>(i)]) = x(i);
  Eigen::VectorXd z;  // a block's own part of y, then what lies below it
  const auto gather = [&](std::size_t b) {
    const std::vector<std::int32_t>& rows = rows_[b];
    z.resize(static_cast<Eigen::Index>(rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) z(static_cast<Eigen::Index>(i)) = y(rows[i]);
  };
  for (std::size_t b = 0; b < panel_.size(); ++b) {
    const Eigen::MatrixXd& panel = panel_[b];
    gather(b);
    for (Eigen::Index j = 0; j < panel.cols(); ++j) {
      const Eigen::Index below = panel.rows() - j - 1;
      z.tail(below) -= z(j) / panel(j, j) * panel.col(j).tail(below);
    }
    for (std::size_t i = 0; i < rows_[b].size(); ++i) y(rows_[b][i]) = z(static_cast<Eigen::Index>(i));
  }
  for (std::size_t b = panel_.size(); b-- > 0;) {
    const Eigen::MatrixXd& panel = panel_[b];
    gather(b);
    for (Eigen::Index j = panel.cols(); j-- > 0;) {
      const Eigen::Index below = panel.rows() - j - 1;
      z(j) = (z(j) - panel.col(j).tail(below).dot(z.tail(below))) / panel(j, j);
    }
    y.segment(first_[b], panel.cols()) = z.head(panel.cols());
  }
  for (Eigen::Index i = 0; i < x.size(); ++i) x(i) = y(place_[static_cast<std::size_t>(i)]);
}

}  // namespace topple::solver
