// Voronoi cells on a jittered grid against the diagram over all sites.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "topple/fracture/voronoi.h"

using namespace topple::fracture;

namespace {

std::array<Vec2, 4> rectangle(double width, double height) {
  return {Vec2(0, 0), Vec2(width, 0), Vec2(width, height), Vec2(0, height)};
}

/// The cell by clipping with every other site.
LabelledPolygon brute_force(const VoronoiGrid& grid, const std::array<Vec2, 4>& outline, int index) {
  LabelledPolygon polygon{Polygon(outline.begin(), outline.end()), {-1, -2, -3, -4}};
  for (int other = 0; other < grid.size(); ++other)
    if (other != index) {
      const Vec2 away = grid.site(other) - grid.site(index);
      clip(polygon, grid.site(index) + away / 2, away, other);
    }
  return polygon;
}

}  // namespace

TEST_CASE("cells are those of the whole diagram, and add up to the panel") {
  for (const double aspect : {1.0, 1.5, 2.0, 3.0})
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      // Cells `aspect` times as long as wide: the numbers of cells are equal, the sides are not.
      const auto outline = rectangle(6 * aspect, 6);
      VoronoiSettings settings{std::sqrt(aspect) * 6 / 14, 1.0, seed};
      const VoronoiGrid grid(outline, settings);
      double sum = 0;
      for (int i = 0; i < grid.size(); ++i) {
        const VoronoiCell cell = grid.cell(i);
        const LabelledPolygon expected = brute_force(grid, outline, i);
        CHECK(area(cell.polygon.vertices) == Approx(area(expected.vertices)).epsilon(1e-12));
        CHECK(contains(cell.polygon.vertices, cell.site));
        sum += area(cell.polygon.vertices);
      }
      CHECK(sum == Approx(36 * aspect).epsilon(1e-12));
    }
}

TEST_CASE("two rings of neighbours are not always enough") {
  int beyond_two = 0;
  for (std::uint64_t seed = 1; seed <= 400 && beyond_two == 0; ++seed) {
    const auto outline = rectangle(60, 1.4);  // one row of cells that are wider than long
    const VoronoiGrid grid(outline, {1.0, 1.0, seed});
    for (int i = 0; i < grid.size(); ++i)
      for (const int label : grid.cell(i).polygon.labels)
        if (label >= 0 && (std::abs(label % grid.columns() - i % grid.columns()) > 2 ||
                           std::abs(label / grid.columns() - i / grid.columns()) > 2))
          ++beyond_two;
  }
  CHECK(beyond_two > 0);
}

TEST_CASE("any convex quadrilateral is covered without gap, at every jitter") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(-0.8, 0.8);
  for (int k = 0; k < 60; ++k) {
    std::array<Vec2, 4> outline = rectangle(6, 4);
    for (Vec2& corner : outline) corner += Vec2(part(random), part(random));
    const double jitter = k % 4 / 3.0;
    const VoronoiGrid grid(outline, {0.7, jitter, static_cast<std::uint64_t>(k)});
    double sum = 0;
    for (int i = 0; i < grid.size(); ++i) sum += area(grid.cell(i).polygon.vertices);
    CHECK(sum == Approx(area(Polygon(outline.begin(), outline.end()))).epsilon(1e-12));
  }
}

TEST_CASE("edges know their neighbour, and the neighbour knows them") {
  const VoronoiGrid grid(rectangle(5, 5), {0.5, 1.0, 9});
  for (int i = 0; i < grid.size(); ++i)
    for (const int label : grid.cell(i).polygon.labels) {
      if (label < 0) continue;
      const auto back = grid.cell(label).polygon.labels;
      CHECK(std::find(back.begin(), back.end(), i) != back.end());
    }
}

TEST_CASE("an outline that is not convex and settings out of range are refused") {
  std::array<Vec2, 4> dented{Vec2(0, 0), Vec2(4, 0), Vec2(1, 1), Vec2(0, 4)};
  CHECK_THROWS_AS(VoronoiGrid(dented, {}), std::invalid_argument);
  CHECK_THROWS_AS(VoronoiGrid(rectangle(1, 1), {0, 1, 1}), std::invalid_argument);
  CHECK_THROWS_AS(VoronoiGrid(rectangle(1, 1), {1, 1.5, 1}), std::invalid_argument);
}
