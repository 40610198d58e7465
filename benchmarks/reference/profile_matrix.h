#pragma once
// A symmetric positive definite matrix by rows, each from its first entry that is not zero to the diagonal, and its
// factorisation in place: L D L', so that no square root is needed in any precision.
#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <vector>

namespace reference {

template <typename Real>
class ProfileMatrix {
 public:
  /// `first[i]`: column of the first entry of row i.
  explicit ProfileMatrix(std::vector<std::size_t> first) : first_(std::move(first)), rows_(first_.size()) {
    for (std::size_t i = 0; i < rows_.size(); ++i) rows_[i].assign(i + 1 - first_[i], Real(0));
  }

  [[nodiscard]] Real& at(std::size_t row, std::size_t column) { return rows_[row][column - first_[row]]; }

  /// Throws std::runtime_error when a pivot is not positive.
  void factorise() {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      Real* row = rows_[i].data();
      const std::size_t start = first_[i];
      for (std::size_t j = start; j < i; ++j) row[j - start] -= product(i, j);
      Real pivot = row[i - start];
      for (std::size_t j = start; j < i; ++j) {
        const Real entry = row[j - start] / rows_[j].back();
        pivot -= entry * row[j - start];
        row[j - start] = entry;
      }
      if (!(pivot > 0)) throw std::runtime_error("reference solution: the model is not stable");
      row[i - start] = pivot;
    }
  }

  void solve(std::vector<Real>& x) const {
    for (std::size_t i = 0; i < rows_.size(); ++i)
      for (std::size_t j = first_[i]; j < i; ++j) x[i] -= rows_[i][j - first_[i]] * x[j];
    for (std::size_t i = 0; i < rows_.size(); ++i) x[i] /= rows_[i].back();
    for (std::size_t i = rows_.size(); i-- > 0;)
      for (std::size_t j = first_[i]; j < i; ++j) x[j] -= rows_[i][j - first_[i]] * x[i];
  }

 private:
  /// Of row i, not yet divided by the pivots, with row j of L, over the columns before j.
  [[nodiscard]] Real product(std::size_t i, std::size_t j) const {
    const std::size_t from = std::max(first_[i], first_[j]);
    if (from >= j) return 0;
    const Real* a = rows_[i].data() + (from - first_[i]);
    const Real* b = rows_[j].data() + (from - first_[j]);
    // Four sums side by side: each waits for its own last addition only.
    Real sum[4] = {0, 0, 0, 0};
    std::size_t k = 0;
    for (; k + 4 <= j - from; k += 4)
      for (std::size_t s = 0; s < 4; ++s) sum[s] += a[k + s] * b[k + s];
    for (; k < j - from; ++k) sum[0] += a[k] * b[k];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
  }

  std::vector<std::size_t> first_;
  std::vector<std::vector<Real>> rows_;
};

}  // namespace reference
