#pragma once
// CHOLMOD's factorisations, on one BLAS thread, always. This is the only file that knows of CHOLMOD.
#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "assembly/sparse.h"
#include "factor/factor_view.h"
#include "topple/solver/static_analysis.h"

namespace topple::solver {

class CholmodFactor {
 public:
  /// Symbolic analysis. `permutation[k]` is the row eliminated k-th. `kind`: simplicial or supernodal; without
  /// CHOLMOD's GPL modules it is simplicial.
  CholmodFactor(const SparseSymmetric& pattern, const std::vector<int>& permutation, Factorisation kind);
  ~CholmodFactor();

  /// Returns how many columns, in the order of elimination, come before one without a pivot: all, when there is none.
  /// (Simplicial: L D L', whose pivots may be negative.)
  [[nodiscard]] std::int64_t factorise(const SparseSymmetric& matrix);
  /// Solves in place, all columns together.
  void solve(Eigen::Ref<Eigen::MatrixXd> right_hand_sides) const;

  [[nodiscard]] std::size_t entries() const;
  [[nodiscard]] double operations() const;
  [[nodiscard]] FactorView view() const;
  [[nodiscard]] Factorisation kind() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace topple::solver
