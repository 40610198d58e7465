// The strip kernels of each kind of processor against sums in extended precision, and against each other.
#include "factor/front_kernels.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "random_values.h"

using namespace topple::solver;
using topple::test::random_values;

namespace {

std::vector<const FrontKernels*> available() {
  std::vector<const FrontKernels*> all{&plain_front_kernels()};
  for (const FrontKernels* kernels : {avx2_front_kernels(), avx512_front_kernels()})
    if (kernels != nullptr) all.push_back(kernels);
  return all;
}

constexpr double epsilon = std::numeric_limits<double>::epsilon();

}  // namespace

TEST_CASE("products of strips touch their rows and columns only, and round as a sum does") {
  constexpr int depth = 37, stride = 29;
  const std::vector<double> a = random_values(strip_rows * depth, 1), b = random_values(strip_rows * depth, 2),
                            before = random_values(stride * (strip_columns + 1), 3);
  std::vector<std::vector<double>> wide;
  for (const FrontKernels* kernels : available()) {
    INFO(kernels->name);
    for (const bool subtract : {true, false})
      for (int rows = 1; rows <= strip_rows; ++rows)
        for (int columns = 1; columns <= strip_columns; ++columns) {
          std::vector<double> c = before;
          const auto product = subtract ? kernels->subtract_product : kernels->negative_product;
          product(a.data(), b.data() + 8, depth, c.data(), stride, rows, columns);
          for (int j = 0; j <= strip_columns; ++j)
            for (int i = 0; i < stride; ++i) {
              const auto at = static_cast<std::size_t>(j * stride + i);
              if (i >= rows || j >= columns) {
                REQUIRE(c[at] == before[at]);
                continue;
              }
              long double sum = subtract ? -static_cast<long double>(before[at]) : 0, size = std::abs(sum);
              for (int k = 0; k < depth; ++k) {
                const long double term = static_cast<long double>(a[static_cast<std::size_t>(k * strip_rows + i)]) *
                                         b[static_cast<std::size_t>(k * strip_rows + j + 8)];
                sum += term;
                size += std::abs(term);
              }
              REQUIRE(std::abs(static_cast<double>(c[at] + sum)) <= (depth + 2) * epsilon * static_cast<double>(size));
            }
          if (rows == strip_rows && columns == strip_columns && kernels != &plain_front_kernels()) wide.push_back(c);
        }
  }
  // Vectors of both widths give the same bits: [subtract, assign] for each.
  if (wide.size() == 4) {
    CHECK(wide[0] == wide[2]);
    CHECK(wide[1] == wide[3]);
  }
}

TEST_CASE("triangles are solved for all numbers of columns") {
  std::vector<double> triangle = random_values(strip_rows * strip_columns, 4), inverse(strip_columns);
  for (int j = 0; j < strip_columns; ++j) {
    double& diagonal = triangle[static_cast<std::size_t>(j * strip_rows + j)];
    diagonal = 2 + std::abs(diagonal);
    inverse[static_cast<std::size_t>(j)] = 1 / diagonal;
  }
  const std::vector<double> right = random_values(strip_rows * strip_columns, 5);
  for (const FrontKernels* kernels : available()) {
    INFO(kernels->name);
    for (int columns = 1; columns <= strip_columns; ++columns) {
      std::vector<double> x = right;
      kernels->solve_triangle(x.data(), triangle.data(), inverse.data(), columns);
      for (int i = 0; i < strip_rows; ++i)
        for (int j = 0; j < strip_columns; ++j) {
          const auto at = static_cast<std::size_t>(j * strip_rows + i);
          if (j >= columns) {
            REQUIRE(x[at] == right[at]);
            continue;
          }
          // X T' is the right-hand side again.
          long double sum = -static_cast<long double>(right[at]), size = std::abs(sum);
          for (int k = 0; k <= j; ++k) {
            const long double term = static_cast<long double>(x[static_cast<std::size_t>(k * strip_rows + i)]) *
                                     triangle[static_cast<std::size_t>(k * strip_rows + j)];
            sum += term;
            size += std::abs(term);
          }
          REQUIRE(std::abs(static_cast<double>(sum)) <= (strip_columns + 3) * epsilon * static_cast<double>(size));
        }
    }
  }
}

TEST_CASE("runs of rows are added where they belong") {
  const std::vector<double> from = random_values(100, 6), before = random_values(80, 7);
  const std::vector<RowRun> runs{{0, 3, 6}, {6, 12, 1}, {7, 20, 19}, {26, 45, 8}};
  std::vector<double> expected = before;
  for (const RowRun& run : runs)
    for (int i = 0; i < run.count; ++i)
      expected[static_cast<std::size_t>(run.to - 2 + i)] += from[static_cast<std::size_t>(run.from + 5 + i)];
  for (const FrontKernels* kernels : available()) {
    INFO(kernels->name);
    std::vector<double> to = before;
    kernels->add_runs(to.data(), 2, from.data(), 5, runs.data(), static_cast<int>(runs.size()));
    CHECK(to == expected);
  }
}
