// L D L' of indefinite matrices against dense eigenvalues.
#include "factor/ldl_factor.h"

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <random>

using namespace topple::solver;

namespace {

/// A grid of n x n unknowns coupled to their neighbours, with random signs on the diagonal.
SparseSymmetric grid(int n, std::mt19937& random, double shift) {
  SparseSymmetric A;
  A.size = n * n;
  A.start.push_back(0);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int c = 0; c < A.size; ++c) {
    A.row.push_back(c);
    A.value.push_back(3 * uniform(random) + shift);
    for (const int r : {c % n + 1 < n ? c + 1 : -1, c + n < A.size ? c + n : -1})
      if (r >= 0) {
        A.row.push_back(r);
        A.value.push_back(uniform(random));
      }
    A.start.push_back(static_cast<std::int64_t>(A.row.size()));
  }
  return A;
}

Eigen::MatrixXd dense(const SparseSymmetric& A) {
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(A.size, A.size);
  for (int c = 0; c < A.size; ++c)
    for (auto k = A.start[static_cast<std::size_t>(c)]; k < A.start[static_cast<std::size_t>(c) + 1]; ++k) {
      const int r = A.row[static_cast<std::size_t>(k)];
      full(r, c) = full(c, r) = A.value[static_cast<std::size_t>(k)];
    }
  return full;
}

}  // namespace

TEST_CASE("an indefinite matrix has as many negative pivots as negative eigenvalues, in any order of elimination") {
  std::mt19937 random(7);
  for (const int n : {1, 2, 5, 14})
    for (const double shift : {-4.0, -1.0, 0.0, 0.7, 8.0}) {
      const SparseSymmetric A = grid(n, random, shift);
      const Eigen::MatrixXd full = dense(A);
      const Eigen::VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(full).eigenvalues();
      std::vector<int> order(static_cast<std::size_t>(A.size));
      for (int i = 0; i < A.size; ++i) order[static_cast<std::size_t>(i)] = i;
      for (int turn = 0; turn < 3; ++turn) {
        LdlFactor factor(A, order);
        CHECK(factor.factorise(A, true) == (eigenvalues.array() < 0).count());
        const Eigen::VectorXd b = Eigen::VectorXd::Random(A.size);
        Eigen::VectorXd x = b;
        factor.solve(x);
        // Pivots are not chosen by size: a growth of some 1e4 may be lost.
        CHECK((full * x - b).norm() < 1e-8 * b.norm() * std::max(1.0, x.norm()));
        for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random() % i]);
      }
    }
}
