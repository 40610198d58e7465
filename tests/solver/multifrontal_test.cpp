// Our own factorisation against arithmetic in extended precision, whatever the matrix and the number of threads.
#include "factor/multifrontal.h"

#include <Eigen/Dense>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <random>

#include "factor/factor.h"

using namespace topple::solver;

namespace {

using ExtendedMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// A matrix made of elements between random nodes, each node with its own number of freedoms. Not all nodes need to be
/// connected.
struct RandomSystem {
  Eigen::MatrixXd dense;
  SparseSymmetric sparse;
  std::vector<int> order;
};

SparseSymmetric lower_triangle(const Eigen::MatrixXd& dense, const Eigen::MatrixXi& pattern) {
  SparseSymmetric sparse;
  sparse.size = static_cast<std::int32_t>(dense.rows());
  sparse.start.push_back(0);
  for (Eigen::Index j = 0; j < dense.cols(); ++j) {
    for (Eigen::Index i = j; i < dense.rows(); ++i) {
      if (i != j && pattern(i, j) == 0) continue;
      sparse.row.push_back(static_cast<std::int32_t>(i));
      sparse.value.push_back(dense(i, j));
    }
    sparse.start.push_back(static_cast<std::int64_t>(sparse.row.size()));
  }
  return sparse;
}

RandomSystem random_system(unsigned seed, int nodes, int elements, int most_freedoms, bool random_order) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(-1, 1);
  std::vector<int> first{0};
  for (int n = 0; n < nodes; ++n)
    first.push_back(first.back() + 1 + static_cast<int>(random() % static_cast<unsigned>(most_freedoms)));
  const int size = first.back();
  RandomSystem system;
  system.dense = Eigen::MatrixXd::Zero(size, size);
  Eigen::MatrixXi pattern = Eigen::MatrixXi::Zero(size, size);
  for (int e = 0; e < elements; ++e) {
    // Neighbours in number are more likely: long chains and bushes both occur.
    const auto a = static_cast<int>(random() % static_cast<unsigned>(nodes));
    const int b = random() % 4 == 0 ? static_cast<int>(random() % static_cast<unsigned>(nodes)) : (a + 1) % nodes;
    std::vector<int> freedoms;
    for (const int n : {a, b})
      for (int f = first[static_cast<std::size_t>(n)]; f < first[static_cast<std::size_t>(n) + 1]; ++f)
        if (freedoms.empty() || a != b || n == a) freedoms.push_back(f);
    const auto count = static_cast<Eigen::Index>(freedoms.size());
    const Eigen::MatrixXd half = Eigen::MatrixXd::NullaryExpr(count, count, [&] { return value(random); });
    const Eigen::MatrixXd element = half * half.transpose();
    for (Eigen::Index p = 0; p < count; ++p)
      for (Eigen::Index q = 0; q < count; ++q) {
        system.dense(freedoms[static_cast<std::size_t>(p)], freedoms[static_cast<std::size_t>(q)]) += element(p, q);
        pattern(freedoms[static_cast<std::size_t>(p)], freedoms[static_cast<std::size_t>(q)]) = 1;
      }
  }
  system.dense.diagonal().array() += 0.1;
  system.dense = (system.dense + system.dense.transpose()).eval() / 2;
  system.sparse = lower_triangle(system.dense, pattern);
  if (random_order) {
    system.order.resize(static_cast<std::size_t>(size));
    std::iota(system.order.begin(), system.order.end(), 0);
    std::shuffle(system.order.begin(), system.order.end(), random);
  } else {
    std::vector<int> node_order(static_cast<std::size_t>(nodes));
    std::iota(node_order.begin(), node_order.end(), 0);
    std::shuffle(node_order.begin(), node_order.end(), random);
    for (const int n : node_order)
      for (int f = first[static_cast<std::size_t>(n)]; f < first[static_cast<std::size_t>(n) + 1]; ++f)
        system.order.push_back(f);
  }
  return system;
}

/// L in the order of elimination, from the fronts.
ExtendedMatrix dense_factor(const MultifrontalFactor& factor) {
  const Supernodes& fronts = factor.fronts();
  const auto n = static_cast<Eigen::Index>(fronts.order.size());
  ExtendedMatrix L = ExtendedMatrix::Zero(n, n);
  for (std::size_t f = 0; f < fronts.parent.size(); ++f)
    for (int c = 0; c < fronts.columns(f); ++c)
      for (int r = c; r < fronts.rows(f); ++r)
        L(fronts.row[static_cast<std::size_t>(fronts.row_start[f] + r)], fronts.first[f] + c) =
            factor.values()[static_cast<std::size_t>(fronts.value_start[f] +
                                                     static_cast<std::int64_t>(c) * fronts.rows(f) + r)];
  return L;
}

ExtendedMatrix reordered(const Eigen::MatrixXd& dense, const std::vector<std::int64_t>& order) {
  const auto n = static_cast<Eigen::Index>(order.size());
  ExtendedMatrix result(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      result(i, j) = dense(order[static_cast<std::size_t>(i)], order[static_cast<std::size_t>(j)]);
  return result;
}

/// On and below the diagonals.
bool same_bits(const MultifrontalFactor& a, const MultifrontalFactor& b) {
  const Supernodes& fronts = a.fronts();
  for (std::size_t f = 0; f < fronts.parent.size(); ++f)
    for (int c = 0; c < fronts.columns(f); ++c) {
      const auto at =
          static_cast<std::size_t>(fronts.value_start[f] + static_cast<std::int64_t>(c) * fronts.rows(f) + c);
      const auto count = static_cast<std::size_t>(fronts.rows(f) - c);
      if (std::memcmp(a.values().data() + at, b.values().data() + at, count * sizeof(double)) != 0) return false;
    }
  return a.values().size() == b.values().size();
}

}  // namespace

TEST_CASE("L L' is the matrix, for systems of all shapes") {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const int nodes = 1 + static_cast<int>(seed * 7 % 60), elements = static_cast<int>(seed * 13 % 150);
    const RandomSystem system = random_system(seed, nodes, elements, 1 + static_cast<int>(seed % 8), seed % 3 == 0);
    MultifrontalFactor factor(system.sparse, system.order, 1 + static_cast<int>(seed % 3));
    const auto n = static_cast<std::int64_t>(system.order.size());
    REQUIRE(factor.factorise(system.sparse) == n);
    std::vector<std::int64_t> sorted = factor.fronts().order;
    std::sort(sorted.begin(), sorted.end());
    for (std::int64_t i = 0; i < n; ++i) REQUIRE(sorted[static_cast<std::size_t>(i)] == i);
    const ExtendedMatrix L = dense_factor(factor), A = reordered(system.dense, factor.fronts().order);
    const ExtendedMatrix error = (L * L.transpose() - A).cwiseAbs();
    // Higham, Accuracy and Stability of Numerical Algorithms, theorem 10.3: |A - L L'| <= (n + 1) u |L| |L'|, whatever
    // the order of summation.
    const ExtendedMatrix bound =
        (L.cwiseAbs() * L.transpose().cwiseAbs()) * static_cast<long double>(static_cast<double>(n + 2) * epsilon);
    REQUIRE((error.array() <= bound.array() + 1e-300L).all());
  }
}

TEST_CASE("the factor's bits do not depend on the number of threads") {
  // Large enough for several items, fronts that are cut into tiles, and more threads than this machine may have.
  RandomSystem system = random_system(5, 400, 2600, 6, false);
  MultifrontalFactor one(system.sparse, system.order, 1);
  REQUIRE(one.fronts().operations > 1e8);
  REQUIRE(one.factorise(system.sparse) == static_cast<std::int64_t>(system.order.size()));
  for (const int threads : {2, 3, 7}) {
    MultifrontalFactor several(system.sparse, system.order, threads);
    for (int again = 0; again < 3; ++again) {
      REQUIRE(several.factorise(system.sparse) == static_cast<std::int64_t>(system.order.size()));
      CHECK(same_bits(one, several));
    }
  }
  // Several pivots that are not positive, in different subtrees: the first is told, whoever comes upon his first.
  for (const std::int32_t row : {100, 300, 500})
    system.sparse.value[static_cast<std::size_t>(system.sparse.start[static_cast<std::size_t>(row)])] = -1;
  const std::int64_t done = one.factorise(system.sparse);
  CHECK(done < static_cast<std::int64_t>(system.order.size()));
  MultifrontalFactor several(system.sparse, system.order, 3);
  for (int again = 0; again < 5; ++again) CHECK(several.factorise(system.sparse) == done);
}

TEST_CASE("the first pivot that is not positive is told, whatever the number of threads") {
  int failures = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    RandomSystem system = random_system(seed, 60, 120, 6, false);
    std::mt19937 random(seed);
    // Some rows lose what makes them definite.
    for (int bad = 0; bad < 3; ++bad) {
      const auto row = static_cast<Eigen::Index>(random() % static_cast<unsigned>(system.sparse.size));
      system.dense(row, row) -= 6 * (1 + bad);
      system.sparse.value[static_cast<std::size_t>(system.sparse.start[static_cast<std::size_t>(row)])] =
          system.dense(row, row);
    }
    MultifrontalFactor factor(system.sparse, system.order, 1), parallel(system.sparse, system.order, 4);
    const std::int64_t done = factor.factorise(system.sparse);
    CHECK(parallel.factorise(system.sparse) == done);
    // The same in extended precision, in the same order.
    ExtendedMatrix A = reordered(system.dense, factor.fronts().order);
    Eigen::Index expected = 0;
    while (expected < A.rows() && A(expected, expected) > 0) {
      const Eigen::Index rest = A.rows() - expected - 1;
      const ExtendedMatrix column = A.col(expected).tail(rest);
      A.bottomRightCorner(rest, rest) -= column * column.transpose() / A(expected, expected);
      ++expected;
    }
    CHECK(done == expected);
    if (done < static_cast<std::int64_t>(system.order.size())) ++failures;
  }
  CHECK(failures > 20);
}

TEST_CASE("no rows, one row, and rows that nothing joins") {
  SparseSymmetric empty;
  empty.start = {0};
  MultifrontalFactor none(empty, {}, 2);
  CHECK(none.factorise(empty) == 0);

  SparseSymmetric diagonal;
  diagonal.start.push_back(0);
  std::vector<int> order;
  for (int i = 0; i < 500; ++i) {
    diagonal.row.push_back(i);
    diagonal.value.push_back(i + 1);
    diagonal.start.push_back(i + 1);
    order.insert(order.begin(), i);
    diagonal.size = i + 1;
    if (i > 2 && i < 499) continue;
    MultifrontalFactor factor(diagonal, order, 2);
    REQUIRE(factor.factorise(diagonal) == i + 1);
    Eigen::MatrixXd x = Eigen::MatrixXd::Ones(i + 1, 2);
    factor.solve(x);
    // One square root, two divisions.
    for (int k = 0; k <= i; ++k) CHECK(x(k, 1) == Approx(1.0 / (k + 1)).epsilon(4 * epsilon));
  }
}

TEST_CASE("several right-hand sides are solved as each by itself") {
  const RandomSystem system = random_system(11, 80, 300, 6, false);
  MultifrontalFactor factor(system.sparse, system.order, 2);
  REQUIRE(factor.factorise(system.sparse) == static_cast<std::int64_t>(system.order.size()));
  std::srand(3);
  for (const Eigen::Index count : {1, 2, 3, 8, 13}) {
    const Eigen::MatrixXd b = Eigen::MatrixXd::Random(system.sparse.size, count);
    Eigen::MatrixXd x = b;
    factor.solve(x);
    const Eigen::MatrixXd residual = system.dense * x - b;
    // Each column's normwise backward error.
    for (Eigen::Index j = 0; j < count; ++j)
      CHECK(residual.col(j).norm() < 20 * epsilon * system.dense.norm() * x.col(j).norm());
  }
}

TEST_CASE("our factor and CHOLMOD's give the same answers") {
  const RandomSystem system = random_system(17, 120, 400, 6, false);
  const Eigen::MatrixXd b = Eigen::MatrixXd::Random(system.sparse.size, 1);
  Eigen::MatrixXd x = b, y = b;
  Factor own(system.sparse, system.order, Factorisation::automatic);
  Factor reference(system.sparse, system.order, Factorisation::simplicial);
  const Factor::Outcome mine = own.factorise(system.sparse), theirs = reference.factorise(system.sparse);
  REQUIRE(mine.positive_definite);
  REQUIRE(theirs.positive_definite);
  CHECK(own.operations() == Approx(reference.operations()));
  own.solve(x);
  reference.solve(y);
  const double condition = 1 / Eigen::PartialPivLU<Eigen::MatrixXd>(system.dense).rcond();
  CHECK((x - y).norm() < 10 * condition * epsilon * y.norm());
  // The order within subtrees differs, and with it the least pivot; both bound the least eigenvalue from above.
  CHECK(mine.worst_pivot > 0);
  CHECK(mine.worst_pivot <= 1);
}
