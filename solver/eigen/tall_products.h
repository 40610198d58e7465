#pragma once
// Products of matrices with many rows and few columns, by blocks of rows on several threads. Sums go block by block in
// order, so that their bits do not depend on the number of threads.
#include <Eigen/Core>

namespace topple::solver {

/// A' B.
[[nodiscard]] Eigen::MatrixXd tall_product(const Eigen::Ref<const Eigen::MatrixXd>& A,
                                           const Eigen::Ref<const Eigen::MatrixXd>& B, int threads);

/// Y -= A C.
void subtract_tall(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::MatrixXd& C, Eigen::Ref<Eigen::MatrixXd> Y,
                   int threads);

}  // namespace topple::solver
