// L S L' of indefinite matrices against dense eigenvalues.
#include "factor/factor.h"

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <limits>
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
  for (const int n : {1, 2, 5, 14, 30})
    for (const double shift : {-4.0, -1.0, 0.0, 0.7, 8.0}) {
      const SparseSymmetric A = grid(n, random, shift);
      const Eigen::MatrixXd full = dense(A);
      const Eigen::VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(full).eigenvalues();
      std::vector<int> order(static_cast<std::size_t>(A.size));
      for (int i = 0; i < A.size; ++i) order[static_cast<std::size_t>(i)] = i;
      for (int turn = 0; turn < 3; ++turn) {
        Factor factor(A, order, Factorisation::automatic, 1 + turn);
        CHECK(factor.factorise_indefinite(A) == (eigenvalues.array() < 0).count());
        const Eigen::MatrixXd b = Eigen::MatrixXd::Random(A.size, 2);
        Eigen::MatrixXd x = b;
        factor.solve(x);
        // Pivots are not chosen by size: a growth of some 1e4 may be lost.
        CHECK((full * x - b).norm() < 1e-8 * b.norm() * std::max(1.0, x.norm()));
        for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random() % i]);
      }
    }
}

TEST_CASE("large fronts count negative pivots to the same bits on any number of threads") {
  // Dense, so that one front has several blocks of columns and many strips: A = Q D Q' with known signs.
  constexpr int n = 330;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0.5, 2);
  Eigen::VectorXd D(n);
  for (int i = 0; i < n; ++i) D(i) = (i % 7 == 3 ? -1 : 1) * uniform(random);
  Eigen::MatrixXd L = Eigen::MatrixXd::Identity(n, n);  // its unit triangle keeps every pivot what D says
  for (int c = 0; c < n; ++c)
    for (int r = c + 1; r < n; ++r) L(r, c) = 0.02 * (uniform(random) - 1.25);
  const Eigen::MatrixXd full = L * D.asDiagonal() * L.transpose();
  SparseSymmetric A;
  A.size = n;
  A.start.push_back(0);
  for (int c = 0; c < n; ++c) {
    for (int r = c; r < n; ++r) {
      A.row.push_back(r);
      A.value.push_back(full(r, c));
    }
    A.start.push_back(static_cast<std::int64_t>(A.row.size()));
  }
  std::vector<int> order(n);
  for (int i = 0; i < n; ++i) order[static_cast<std::size_t>(i)] = i;
  const Eigen::MatrixXd b = Eigen::MatrixXd::Random(n, 3);
  Eigen::MatrixXd first;
  for (const int threads : {1, 2, 4}) {
    Factor factor(A, order, Factorisation::automatic, threads);
    CHECK(factor.factorise_indefinite(A) == (D.array() < 0).count());
    Eigen::MatrixXd x = b;
    factor.solve(x);
    CHECK((full * x - b).norm() < 1e-12 * full.norm() * x.norm());  // rounding alone: the pivots are what D says
    if (first.size() == 0) first = x;
    CHECK(x == first);
  }
}

TEST_CASE("a matrix with numbers that are not finite has no count") {
  std::mt19937 random(7);
  SparseSymmetric A = grid(3, random, 8.0);
  A.value[0] = std::numeric_limits<double>::quiet_NaN();
  std::vector<int> order(9);
  for (int i = 0; i < 9; ++i) order[static_cast<std::size_t>(i)] = i;
  Factor factor(A, order, Factorisation::automatic, 1);
  CHECK_THROWS_AS(factor.factorise_indefinite(A), std::runtime_error);
}
