#pragma once
// Where to begin to look for critical factors: the largest eigenvalues of K^-1 G, K positive definite and G the loss of
// stiffness per unit of load factor, linearised where nothing is loaded. Block Lanczos in the K inner product, all
// vectors kept orthogonal (Saad, Numerical Methods for Large Eigenvalue Problems, ch. 6).
#include <Eigen/Core>
#include <functional>
#include <vector>

namespace topple::solver {

struct LinearisedBuckling {
  Eigen::Index size = 0;
  std::function<void(Eigen::Ref<Eigen::MatrixXd>)> solve;                             ///< x := K^-1 x
  std::function<Eigen::MatrixXd(const Eigen::Ref<const Eigen::MatrixXd>&)> multiply;  ///< G x
  int threads = 1;
};

struct BucklingStart {
  double factor = 0;
  Eigen::VectorXd vector;
};

/// The lowest positive factors in order, at most `count`: estimates, good to some digits where they are well apart.
/// None may be trusted before it is counted.
[[nodiscard]] std::vector<BucklingStart> estimate_buckling(const LinearisedBuckling& operators, int count);

}  // namespace topple::solver
