#pragma once
// Sparse Cholesky factor of a symmetric positive definite matrix under a given permutation. CHOLMOD behind it, on one
// BLAS thread, always.
#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sparse.h"
#include "topple/solver/static_analysis.h"

namespace topple::solver {

/// The numbers of a factor as they lie, in elimination order. Supernodal, L L': block b has the columns first[b] ...
/// first[b + 1] - 1; row[row_start[b]] ... are its rows (its own first), and value[start[b]] ... its dense columns.
/// Simplicial: column j has row[start[j]] ... (count[j] of them, the diagonal first) and value[start[j]] ... of L, or
/// of L D L' with D in the place of L's unit diagonal.
struct FactorView {
  bool supernodal = false, is_ll = false;
  std::span<const std::int64_t> order, first, row_start, start, count, row;
  std::span<const double> value;
};

class Factor {
 public:
  /// Symbolic analysis. `permutation[k]` is the row eliminated k-th.
  Factor(const SparseSymmetric& pattern, std::vector<int> permutation, Factorisation kind);
  ~Factor();
  Factor(Factor&&) noexcept;
  Factor& operator=(Factor&&) noexcept;

  struct Outcome {
    bool positive_definite = false;
    int worst_row = -1;      ///< row (original numbering) of the failed or smallest pivot
    double worst_pivot = 0;  ///< that pivot over the matrix's diagonal entry
  };
  /// Numeric factorisation of a matrix with the pattern given at construction.
  [[nodiscard]] Outcome factorise(const SparseSymmetric& matrix);
  /// Solves in place, all columns together.
  void solve(Eigen::Ref<Eigen::MatrixXd> right_hand_sides) const;

  [[nodiscard]] std::size_t entries() const;
  [[nodiscard]] double operations() const;
  /// Borrowed from the last numeric factorisation, until the next.
  [[nodiscard]] FactorView view() const;
  [[nodiscard]] Factorisation kind() const;  ///< simplicial or supernodal, as chosen

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace topple::solver
