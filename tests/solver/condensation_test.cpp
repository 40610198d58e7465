// A sparse matrix condensed to its last rows, against dense algebra over the whole of it.
#include "elements/condensation.h"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <numeric>
#include <random>

using topple::solver::Condensation;
using topple::solver::SparseSymmetric;

namespace {

constexpr int nodes = 40, per_node = 3, kept_nodes = 7;
constexpr int size = per_node * nodes, inner = per_node * (nodes - kept_nodes);

/// A ring of nodes with some chords; the kept ones are all coupled. Positive semidefinite springs between them.
struct Springs {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(size, size);
  SparseSymmetric sparse;

  explicit Springs(bool held) {
    std::mt19937 random(5);
    const auto number = [&] { return static_cast<double>(random() % 1000) / 500 - 1; };
    for (int n = 0; n < nodes; ++n)
      for (const int other : {(n + 1) % nodes, (n * 7 + 3) % nodes}) {
        if (other == n) continue;
        const Eigen::Vector3d along(number(), number(), number() + 1.5);
        const Eigen::Matrix3d k = along * along.transpose() + 0.3 * Eigen::Matrix3d::Identity();
        for (const auto& [a, b, sign] : {std::tuple{n, n, 1}, {other, other, 1}, {n, other, -1}, {other, n, -1}})
          dense.block<3, 3>(per_node * a, per_node * b) += sign * k;
      }
    if (held) dense.diagonal().array() += 0.1;
    sparse.size = size;
    sparse.start = {0};
    for (int c = 0; c < size; ++c) {
      for (int r = c; r < size; ++r) {
        // Whole nodes, so that blocks are what they are in a patch of shells.
        const bool coupled = !dense.block<3, 3>(r / per_node * per_node, c / per_node * per_node).isZero(0);
        if (!coupled && c < inner) continue;
        sparse.row.push_back(r);
        sparse.value.push_back(dense(r, c));
      }
      sparse.start.push_back(static_cast<std::int64_t>(sparse.row.size()));
    }
  }
};

std::vector<int> last_nodes_first() {
  std::vector<int> order(inner);
  std::iota(order.begin(), order.end(), 0);
  for (int k = kept_nodes; k-- > 0;)
    for (int c = 0; c < per_node; ++c) order.push_back(inner + per_node * k + c);
  return order;
}

}  // namespace

TEST_CASE("condensed to its last rows a matrix is its Schur complement, also where that is singular") {
  for (const bool held : {true, false}) {
    const Springs springs(held);
    Condensation condensation(springs.sparse, inner, last_nodes_first());
    REQUIRE(condensation.factorise(springs.sparse));
    const int kept = size - inner;
    const Eigen::MatrixXd first = springs.dense.topLeftCorner(inner, inner),
                          between = springs.dense.topRightCorner(inner, kept);
    const Eigen::PartialPivLU<Eigen::MatrixXd> solved(first);
    const Eigen::MatrixXd expected =
        springs.dense.bottomRightCorner(kept, kept) - between.transpose() * solved.solve(between);
    // Rounding of a condition of some thousands.
    CHECK((condensation.schur() - expected).norm() < 1e-12 * expected.norm());
    CHECK((condensation.schur() - condensation.schur().transpose()).norm() == 0);
    if (!held) {  // free in space: it moves without force
      Eigen::VectorXd shift = Eigen::VectorXd::Zero(kept);
      for (int k = 0; k < kept; k += per_node) shift(k) = 1;
      CHECK((condensation.schur() * shift).norm() < 1e-12 * expected.norm());
    }

    Eigen::VectorXd loads(size), displaced(kept);
    for (int k = 0; k < size; ++k) loads(k) = std::sin(2.3 * k);
    for (int k = 0; k < kept; ++k) displaced(k) = std::cos(1.1 * k);
    const Eigen::VectorXd on_kept = loads.tail(kept) - between.transpose() * solved.solve(loads.head(inner).eval());
    CHECK((condensation.condense(loads) - on_kept).norm() < 1e-12 * on_kept.norm());
    const Eigen::VectorXd moved = solved.solve((loads.head(inner) - between * displaced).eval());
    const Eigen::VectorXd all = condensation.recover(loads, displaced);
    CHECK((all.head(inner) - moved).norm() < 1e-12 * moved.norm());
    CHECK((all.tail(kept) - displaced).norm() == 0);
  }
}

TEST_CASE("a matrix whose inner part is not positive definite is refused, and the next one is taken") {
  const Springs springs(true);
  Condensation condensation(springs.sparse, inner, last_nodes_first());
  SparseSymmetric bad = springs.sparse;
  bad.value[static_cast<std::size_t>(bad.start[10])] = -1;
  CHECK_FALSE(condensation.factorise(bad));
  CHECK(condensation.factorise(springs.sparse));
}

TEST_CASE("kept rows that are not the last to be eliminated are refused") {
  const Springs springs(true);
  std::vector<int> order(size);
  std::iota(order.begin(), order.end(), 0);
  std::swap(order.front(), order.back());
  CHECK_THROWS_AS(Condensation(springs.sparse, inner, order), std::invalid_argument);
}
