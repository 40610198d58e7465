// Products of two matrices of one pattern with several vectors at once: the bits of one product after the other.
#include "dynamics/products.h"

#include <catch2/catch.hpp>
#include <random>

using namespace topple::solver;

namespace {

SparseSymmetric random_matrix(int size, std::mt19937_64& random) {
  std::uniform_real_distribution<double> number(-1, 1);
  SparseSymmetric A;
  A.size = size;
  A.start.push_back(0);
  for (int c = 0; c < size; ++c) {
    for (int r = c; r < size; ++r)
      if (r == c || random() % 3 == 0) A.row.push_back(r);
    A.start.push_back(static_cast<std::int64_t>(A.row.size()));
  }
  for (std::size_t k = 0; k < A.row.size(); ++k) A.value.push_back(number(random));
  return A;
}

}  // namespace

TEST_CASE("Products of two matrices with four vectors each are, to the bit, those of one matrix and one vector") {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> number(-1, 1);
  for (const int size : {1, 2, 7, 30}) {
    const SparseSymmetric A = random_matrix(size, random);
    SparseSymmetric B = A;
    for (double& value : B.value) value = number(random);
    SideBySide<8> X(8, size), Y;
    for (Eigen::Index i = 0; i < X.size(); ++i) X.data()[i] = number(random);
    multiply_by_two(A, B, X, Y);
    REQUIRE(Y.cols() == size);
    for (int row = 0; row < 8; ++row) {
      SideBySide<1> x = X.row(row), y;
      multiply<1>(row < 4 ? A : B, x, y);
      CHECK(y == Y.row(row));
    }
  }
}
