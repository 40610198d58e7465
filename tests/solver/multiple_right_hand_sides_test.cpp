// Passes over a dense block of a factor for a few right-hand sides, against sums in extended precision: every number of
// columns, of rows and of right-hand sides takes another way through them.
#include "factor/multiple_right_hand_sides.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "factor/panel_substitution.h"
#include "random_values.h"

using namespace topple::solver;
using topple::test::random_values;

namespace {

/// Columns of a factor: a firm diagonal, and nothing that may be read above it.
std::vector<double> block_of(int columns, int rows, unsigned seed) {
  std::vector<double> L = random_values(static_cast<std::size_t>(columns * rows), seed);
  for (int j = 0; j < columns; ++j) {
    for (int i = 0; i < j; ++i) L[static_cast<std::size_t>(j * rows + i)] = std::numeric_limits<double>::quiet_NaN();
    double& diagonal = L[static_cast<std::size_t>(j * rows + j)];
    diagonal = 3 + std::abs(diagonal);
  }
  return L;
}

template <class Check>
void each_shape(const Check& check) {
  for (const int columns : {1, 2, 3, 5, 6, 7, 8, 9, 12, 14, 16, 23})
    for (const int below : {0, 1, 2, 3, 4, 5, 6, 7, 8, 13, 16, 31})
      for (const int count : {1, 2, 3, 4, 5, 6, 7, 13}) check(columns, columns + below, count);
}

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// A sum of this many terms of this size in all may be off by so much.
double rounding(int terms, long double size) { return 4 * (terms + 4) * epsilon * static_cast<double>(size); }

}  // namespace

TEST_CASE("eliminating with a block gives back its right-hand side, whatever the shape") {
  each_shape([](int columns, int rows, int count) {
    INFO(columns << " columns of " << rows << " rows, " << count << " right-hand sides");
    const std::vector<double> L = block_of(columns, rows, 1),
                              right = random_values(static_cast<std::size_t>(columns * count), 2);
    std::vector<double> x = right, below(static_cast<std::size_t>((rows - columns) * count), 7.0);
    eliminate_right_hand_sides(L.data(), columns, rows, x.data(), count, below.data());
    for (int c = 0; c < count; ++c)
      for (int i = 0; i < rows; ++i) {
        long double sum = 0, size = 0;
        for (int k = 0; k <= std::min(i, columns - 1); ++k) {
          const long double term = static_cast<long double>(L[static_cast<std::size_t>(k * rows + i)]) *
                                   x[static_cast<std::size_t>(c * columns + k)];
          sum += term;
          size += std::abs(term);
        }
        const double expected = i < columns ? right[static_cast<std::size_t>(c * columns + i)]
                                            : below[static_cast<std::size_t>(c * (rows - columns) + i - columns)];
        REQUIRE(std::abs(static_cast<double>(sum - expected)) <= rounding(columns, size));
      }
    // Each right-hand side has the bits that it has alone.
    std::vector<double> alone(right.begin(), right.begin() + columns), rest(below.size());
    eliminate_right_hand_sides(L.data(), columns, rows, alone.data(), 1, rest.data());
    REQUIRE(std::equal(alone.begin(), alone.end(), x.begin()));
    REQUIRE(std::equal(rest.begin(), rest.begin() + (rows - columns), below.begin()));
  });
}

TEST_CASE("substituting back with a block solves its transpose, whatever the shape") {
  each_shape([](int columns, int rows, int count) {
    INFO(columns << " columns of " << rows << " rows, " << count << " right-hand sides");
    const std::vector<double> L = block_of(columns, rows, 3),
                              right = random_values(static_cast<std::size_t>(columns * count), 4),
                              below = random_values(static_cast<std::size_t>((rows - columns) * count), 5);
    std::vector<double> x = right;
    substitute_back(L.data(), columns, rows, x.data(), count, below.data());
    for (int c = 0; c < count; ++c)
      for (int j = 0; j < columns; ++j) {
        long double sum = 0, size = 0;
        for (int i = j; i < rows; ++i) {
          const double other = i < columns ? x[static_cast<std::size_t>(c * columns + i)]
                                           : below[static_cast<std::size_t>(c * (rows - columns) + i - columns)];
          const long double term = static_cast<long double>(L[static_cast<std::size_t>(j * rows + i)]) * other;
          sum += term;
          size += std::abs(term);
        }
        REQUIRE(std::abs(static_cast<double>(sum - right[static_cast<std::size_t>(c * columns + j)])) <=
                rounding(rows, size));
      }
    std::vector<double> alone(right.begin(), right.begin() + columns);
    substitute_back(L.data(), columns, rows, alone.data(), 1, below.data());
    REQUIRE(std::equal(alone.begin(), alone.end(), x.begin()));
  });
}

TEST_CASE("products with a few columns and their combinations are those of plain sums") {
  for (const int rows : {1, 5, 8, 11, 40})
    for (const int columns : {1, 3, 6, 7, 12, 17}) {
      INFO(rows << " rows, " << columns << " columns");
      const int stride = rows + 3;
      const std::vector<double> W = random_values(static_cast<std::size_t>(stride * columns), 6),
                                y = random_values(static_cast<std::size_t>(rows), 7),
                                before = random_values(static_cast<std::size_t>(columns), 8);
      std::vector<double> c = before, left = y;
      add_products(W.data(), stride, rows, columns, y.data(), c.data());
      subtract_combination(W.data(), stride, rows, columns, before.data(), left.data());
      for (int k = 0; k < columns; ++k) {
        long double sum = before[static_cast<std::size_t>(k)];
        for (int i = 0; i < rows; ++i)
          sum += static_cast<long double>(W[static_cast<std::size_t>(k * stride + i)]) * y[static_cast<std::size_t>(i)];
        REQUIRE(std::abs(static_cast<double>(sum - c[static_cast<std::size_t>(k)])) <= rounding(rows, rows));
      }
      for (int i = 0; i < rows; ++i) {
        long double sum = y[static_cast<std::size_t>(i)];
        for (int k = 0; k < columns; ++k)
          sum -= static_cast<long double>(W[static_cast<std::size_t>(k * stride + i)]) *
                 before[static_cast<std::size_t>(k)];
        REQUIRE(std::abs(static_cast<double>(sum - left[static_cast<std::size_t>(i)])) <= rounding(columns, columns));
      }
    }
}
