#pragma once
// The largest eigenvalues of K^-1 M, K positive definite, M semi-definite, by block Krylov subspaces with restarts: a
// block as wide as what is sought finds equal eigenvalues together, where single vectors find one of them. Method:
// Rayleigh-Ritz in the M inner product over [X, A X, A2 X], A = K^-1 M, restarted with its best vectors (Saad,
// Numerical Methods for Large Eigenvalue Problems, ch. 6). Vectors that M does not see never enter: all are made by A.
#include <Eigen/Core>
#include <functional>

namespace topple::solver {

struct KrylovOperators {
  Eigen::Index size = 0;
  std::function<void(Eigen::Ref<Eigen::MatrixXd>)> solve;                             ///< x := K^-1 x
  std::function<Eigen::MatrixXd(const Eigen::Ref<const Eigen::MatrixXd>&)> multiply;  ///< M x
  int threads = 1;
};

struct KrylovAnswer {
  Eigen::VectorXd values;   ///< of A, largest first; `converged` of them, then less certain ones
  Eigen::MatrixXd vectors;  ///< M-orthonormal
  int converged = 0;
  bool complete = false;  ///< the subspace is all that M sees: there are no more eigenvalues
  double residual = 0;    ///< the largest among those asked for, relative
  bool settled = true;    ///< false: not `count` of them converged in as many restarts as were allowed
};

/// At least `count` converged values unless the subspace is complete before, or `restarts` do not settle them: so where
/// many eigenvalues lie as close to each other as the block is wide. `extra`: width of the block beyond `count`.
[[nodiscard]] KrylovAnswer largest_eigenvalues(const KrylovOperators& operators, int count, int extra, int restarts);

}  // namespace topple::solver
