#pragma once
// Sparse Cholesky factor of a symmetric positive definite matrix under a given permutation: our own multifrontal one,
// or one of CHOLMOD's.
#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

#include "assembly/sparse.h"
#include "factor/factor_view.h"
#include "topple/solver/static_analysis.h"

namespace topple::solver {

class Factor {
 public:
  /// Symbolic analysis. `permutation[k]` is the row eliminated k-th. What comes out does not depend on `threads`.
  /// `automatic`: our own, which is the fastest at every size. The others are CHOLMOD's: supernodal is simplicial where
  /// its GPL modules are left out.
  Factor(const SparseSymmetric& pattern, const std::vector<int>& permutation, Factorisation kind, int threads = 1);
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
  /// L S L', S of signs, of a matrix that need not be positive definite: returns its negative pivots, as many as it has
  /// negative eigenvalues (Sylvester's law of inertia). In the order given and without pivoting: as in every Sturm
  /// count, a shift within rounding of an eigenvalue of a leading part may be miscounted. For the kind `automatic`
  /// alone. Throws std::runtime_error where a pivot is not finite.
  [[nodiscard]] int factorise_indefinite(const SparseSymmetric& matrix);
  /// Solves in place, all columns together.
  void solve(Eigen::Ref<Eigen::MatrixXd> right_hand_sides) const;

  [[nodiscard]] std::size_t entries() const;
  [[nodiscard]] double operations() const;
  /// Borrowed from the last numeric factorisation, until the next.
  [[nodiscard]] FactorView view() const;
  [[nodiscard]] Factorisation kind() const;
  [[nodiscard]] const char* name() const;  ///< "multifrontal" (ours), "CHOLMOD supernodal" or "CHOLMOD simplicial"

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace topple::solver
