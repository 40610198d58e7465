#pragma once
// The lowest critical factors and shapes together: pairs (factor, x) with T(factor) x = 0, T the tangent stiffness,
// which is not linear in the factor where members are exact. Residual inverse iteration (Neumaier 1985) in a subspace
// that grows (Voss 2004): the factors are the zeros of the eigenvalues of V' T V, the k-th of the k-th smallest
// (safeguarded iteration, Werner 1970), so that none is found twice; the subspace takes in T(shift)^-1 of the
// residuals, with one factorisation at a shift beyond the last of them, whose count of negative eigenvalues proves that
// none is missing.
#include <Eigen/Core>
#include <functional>
#include <vector>

#include "assembly/sparse.h"
#include "eigen/buckling_start.h"

namespace topple::solver {

struct TangentOperators {
  std::function<SparseSymmetric(double factor)> tangent;   ///< T, always in the same scale and on the same pattern
  std::function<int(double factor)> count;                 ///< critical factors below this one, poles included
  std::function<int(double factor)> factorise;             ///< the same, and keeps T(factor) for solve
  std::function<void(Eigen::Ref<Eigen::MatrixXd>)> solve;  ///< x := T(factorised)^-1 x
};

struct BucklingPair {
  double factor = 0;  ///< to 1e-12 of itself, or to what rounding leaves of the Rayleigh quotient
  Eigen::VectorXd vector;
};

/// At least `count` pairs in order, proved to be the lowest ones by a count; empty where the iteration does not get
/// there (too few starts, poles below: members that buckle between ends at rest), which leaves the factors to
/// bisection.
[[nodiscard]] std::vector<BucklingPair> buckling_pairs(const TangentOperators& operators,
                                                       const std::vector<BucklingStart>& starts, int count);

}  // namespace topple::solver
