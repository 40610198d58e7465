#pragma once
// Sparse Cholesky factor of a symmetric positive definite matrix under a given permutation. CHOLMOD behind it, on one BLAS
// thread, always.
#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "sparse.h"
#include "topple/solver/static_analysis.h"

namespace topple::solver {

class Factor {
 public:
  /// Symbolic analysis. `permutation[k]` is the row eliminated k-th.
  Factor(const SparseSymmetric& pattern, std::vector<int> permutation, Factorisation kind);
  ~Factor();
  Factor(Factor&&) noexcept;
  Factor& operator=(Factor&&) noexcept;

  struct Outcome {
    bool positive_definite = false;
    int worst_row = -1;        ///< row (original numbering) of the failed or smallest pivot
    double worst_pivot = 0;    ///< that pivot over the matrix's diagonal entry
  };
  /// Numeric factorisation of a matrix with the pattern given at construction.
  [[nodiscard]] Outcome factorise(const SparseSymmetric& matrix);
  /// Solves in place, all columns together.
  void solve(Eigen::Ref<Eigen::MatrixXd> right_hand_sides) const;

  [[nodiscard]] std::size_t entries() const;
  [[nodiscard]] double operations() const;
  [[nodiscard]] Factorisation kind() const;  ///< simplicial or supernodal, as chosen

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace topple::solver
