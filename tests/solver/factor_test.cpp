// The sparse factor and the node ordering against dense algebra.
#include "factor/factor.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <random>

#include "factor/ordering.h"

extern "C" {
void openblas_set_num_threads(int);
int openblas_get_num_threads();
}

using namespace topple::solver;

namespace {

/// A grid's stiffness: each node holds `block` freedoms, neighbours are joined by full random blocks.
struct GridSystem {
  Eigen::MatrixXd dense;
  SparseSymmetric sparse;
  std::vector<int> permutation;
};

GridSystem make_grid(int side, int block, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(-1, 1);
  const int nodes = side * side, n = nodes * block;
  GridSystem system;
  system.dense = Eigen::MatrixXd::Zero(n, n);
  std::vector<std::pair<int, int>> edges;
  const auto join = [&](int a, int b) {
    edges.emplace_back(a, b);
    Eigen::MatrixXd half = Eigen::MatrixXd::NullaryExpr(2 * block, 2 * block, [&] { return value(random); });
    const Eigen::MatrixXd element = half * half.transpose();
    const int at[2] = {a * block, b * block};
    for (int p = 0; p < 2; ++p)
      for (int q = 0; q < 2; ++q)
        system.dense.block(at[p], at[q], block, block) += element.block(p * block, q * block, block, block);
  };
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      if (x + 1 < side) join(y * side + x, y * side + x + 1);
      if (y + 1 < side) join(y * side + x, (y + 1) * side + x);
    }
  system.dense.diagonal().array() += 0.5;
  system.sparse.size = n;
  system.sparse.start.push_back(0);
  for (int j = 0; j < n; ++j) {
    for (int i = j; i < n; ++i)
      if (i == j || system.dense(i, j) != 0) {
        system.sparse.row.push_back(i);
        system.sparse.value.push_back(system.dense(i, j));
      }
    system.sparse.start.push_back(static_cast<std::int64_t>(system.sparse.row.size()));
  }
  const std::vector<int> freedoms(static_cast<std::size_t>(nodes), block);
  for (const int node : order_nodes(nodes, edges, freedoms))
    for (int k = 0; k < block; ++k) system.permutation.push_back(node * block + k);
  return system;
}

}  // namespace

TEST_CASE("every factorisation solves as dense algebra does") {
  const GridSystem grid = make_grid(9, 6, 1);
  const Eigen::MatrixXd b = Eigen::MatrixXd::Random(grid.sparse.size, 3);
  const Eigen::MatrixXd expected = grid.dense.ldlt().solve(b);
  for (const Factorisation kind : {Factorisation::simplicial, Factorisation::supernodal, Factorisation::automatic}) {
    Factor factor(grid.sparse, grid.permutation, kind);
    const Factor::Outcome outcome = factor.factorise(grid.sparse);
    REQUIRE(outcome.positive_definite);
    CHECK(outcome.worst_pivot > 0);
    CHECK(outcome.worst_pivot <= 1);
    Eigen::MatrixXd x = b;
    factor.solve(x);
    // Condition about 1e3 here: 1e-12 leaves three digits of room.
    CHECK((x - expected).norm() < 1e-12 * expected.norm());
    CHECK(factor.entries() > grid.sparse.row.size());
    CHECK(factor.operations() > 0);
  }
}

TEST_CASE("a factor is made again for new values on the same pattern") {
  GridSystem grid = make_grid(5, 3, 2);
  Factor factor(grid.sparse, grid.permutation, Factorisation::automatic);
  REQUIRE(factor.factorise(grid.sparse).positive_definite);
  for (double& value : grid.sparse.value) value *= 4;
  REQUIRE(factor.factorise(grid.sparse).positive_definite);
  Eigen::MatrixXd x = Eigen::MatrixXd::Ones(grid.sparse.size, 1);
  factor.solve(x);
  CHECK((4 * grid.dense * x).isOnes(1e-11));
}

TEST_CASE("an indefinite matrix is told, with the row where it failed") {
  GridSystem grid = make_grid(4, 2, 3);
  const std::size_t bad = static_cast<std::size_t>(grid.sparse.start[11]);
  grid.sparse.value[bad] = -100;
  Factor simplicial(grid.sparse, grid.permutation, Factorisation::simplicial);
  const Factor::Outcome outcome = simplicial.factorise(grid.sparse);
  CHECK_FALSE(outcome.positive_definite);
  CHECK(outcome.worst_row >= 0);
#ifdef TOPPLE_GPL
  Factor supernodal(grid.sparse, grid.permutation, Factorisation::supernodal);
  CHECK_FALSE(supernodal.factorise(grid.sparse).positive_definite);
#endif
}

TEST_CASE("the node order is a permutation, the same in every call, and dissects") {
  std::vector<std::pair<int, int>> edges;
  const int side = 30;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      if (x + 1 < side) edges.emplace_back(y * side + x, y * side + x + 1);
      if (y + 1 < side) edges.emplace_back(y * side + x, (y + 1) * side + x);
    }
  const std::vector<int> freedoms(side * side, 6);
  const std::vector<int> order = order_nodes(side * side, edges, freedoms);
  CHECK(order == order_nodes(side * side, edges, freedoms));
  std::vector<int> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  std::vector<int> all(side * side);
  std::iota(all.begin(), all.end(), 0);
  CHECK(sorted == all);
}

TEST_CASE("BLAS runs on one thread once there is a factor, whichever it is") {
  const GridSystem system = make_grid(3, 6, 5);
  for (const Factorisation kind : {Factorisation::automatic, Factorisation::simplicial}) {
    openblas_set_num_threads(2);
    const Factor factor(system.sparse, system.permutation, kind, 1);
    CHECK(openblas_get_num_threads() == 1);
  }
}
