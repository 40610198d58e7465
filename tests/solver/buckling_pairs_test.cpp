// Lowest zeros of a matrix that depends on a factor, against roots that are known in closed form.
#include "eigen/buckling_pairs.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <catch2/catch.hpp>
#include <cmath>

using namespace topple::solver;

namespace {

constexpr int size = 40;
constexpr double bend = 0.08;

/// T = Q D Q' with D_i = 1 - f/a_i - bend (f/a_i)^2 (1 + f/(10 a_i)): each vanishes at a_i times the same number.
struct Problem {
  explicit Problem(Eigen::VectorXd places) : a(std::move(places)) {
    const Eigen::MatrixXd random = Eigen::MatrixXd::Random(size, size);
    Q = Eigen::HouseholderQR<Eigen::MatrixXd>(random).householderQ();
  }

  static double d(double r) { return 1 - r - bend * r * r * (1 + r / 10); }
  static double root() {
    double low = 0, high = 1;
    for (int i = 0; i < 200; ++i) (d((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
    return low;
  }

  [[nodiscard]] Eigen::MatrixXd T(double factor) const {
    Eigen::VectorXd D(size);
    for (int i = 0; i < size; ++i) D(i) = d(factor / a(i));
    return Q * D.asDiagonal() * Q.transpose();
  }
  [[nodiscard]] int below(double factor) const {
    int count = 0;
    for (int i = 0; i < size; ++i) count += d(factor / a(i)) < 0 ? 1 : 0;
    return count;
  }

  [[nodiscard]] TangentOperators operators() {
    TangentOperators result;
    result.tangent = [this](double factor) {
      const Eigen::MatrixXd full = T(factor);
      SparseSymmetric A;
      A.size = size;
      A.start.push_back(0);
      for (int c = 0; c < size; ++c) {
        for (int r = c; r < size; ++r) {
          A.row.push_back(r);
          A.value.push_back(full(r, c));
        }
        A.start.push_back(static_cast<std::int64_t>(A.row.size()));
      }
      return A;
    };
    result.count = [this](double factor) { return below(factor) + hidden; };
    result.factorise = [this](double factor) {
      kept = T(factor).inverse();
      return below(factor) + hidden;
    };
    result.solve = [this](Eigen::Ref<Eigen::MatrixXd> x) { x = (kept * x).eval(); };
    return result;
  }

  /// Rough vectors of the lowest ones, and factors that are too high.
  [[nodiscard]] std::vector<BucklingStart> starts(int count) const {
    std::vector<BucklingStart> result;
    for (int i = 0; i < count; ++i)
      result.push_back({a(i), Q.col(i) + 0.1 * Q.col((i + 11) % size) + 0.05 * Q.col((7 * i + 20) % size)});
    return result;
  }

  Eigen::VectorXd a;
  Eigen::MatrixXd Q, kept;
  int hidden = 0;  ///< what a count finds and the matrix does not show
};

Eigen::VectorXd spread() {
  Eigen::VectorXd a(size);
  for (int i = 0; i < size; ++i) a(i) = 2 + 0.1 * i * (1 + 0.2 * i);
  return a;
}

}  // namespace

TEST_CASE("pairs of a matrix that is not linear in the factor are found to rounding, equal ones too") {
  Eigen::VectorXd a = spread();
  a(2) = a(1);
  Problem problem(a);
  const auto pairs = buckling_pairs(problem.operators(), problem.starts(7), 4);
  REQUIRE(pairs.size() >= 4);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const double exact = a(static_cast<Eigen::Index>(k)) * Problem::root();
    CHECK(std::abs(pairs[k].factor / exact - 1) < 1e-11);  // asked: 1e-12 of itself, and rounding of the matrix
    // The residual of a unit vector: some 1e-7 leaves the factor right to its square.
    CHECK((problem.T(pairs[k].factor) * pairs[k].vector).norm() < 1e-5);
  }
  CHECK(std::abs(pairs[1].vector.dot(pairs[2].vector)) < 1e-5);  // of equal factors: two shapes, not one twice
}

TEST_CASE("pairs that a count does not prove to be all are not given") {
  Problem problem(spread());
  problem.hidden = 1;
  CHECK(buckling_pairs(problem.operators(), problem.starts(7), 4).empty());
}

TEST_CASE("no pairs where there are fewer starts than factors sought") {
  Problem problem(spread());
  CHECK(buckling_pairs(problem.operators(), problem.starts(3), 4).empty());
}
