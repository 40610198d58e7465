// Voronoi cells on a jittered grid against the diagram over all sites.
#include <algorithm>
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

namespace {

/// The farthest neighbour of a cell, in cells of the grid; 24 x 24 cells `aspect` times as long as wide.
int farthest_neighbour(double aspect, std::uint64_t seed, int index, int n = 24) {
  const VoronoiGrid grid(rectangle(n * aspect, n), {1.0, 1.0, seed, {n, n}});
  int farthest = 0;
  for (const int label : grid.cell(index).polygon.labels)
    if (label >= 0) farthest = std::max({farthest, std::abs(label % n - index % n), std::abs(label / n - index / n)});
  return farthest;
}

}  // namespace

TEST_CASE("random sites have neighbours three cells away where cells are square, up to six where they are long") {
  // Found by search over seeds; brute force (above) agrees with such cells.
  CHECK(farthest_neighbour(1.0, 175, 450) == 3);
  CHECK(farthest_neighbour(1.5, 1, 161) == 3);
  CHECK(farthest_neighbour(2.0, 57, 332) == 4);
  CHECK(farthest_neighbour(3.0, 1, 288) == 5);
  CHECK(farthest_neighbour(3.0, 1521, 360) == 6);
}

TEST_CASE("a bound of two rings gives wrong cells at every aspect, as one of three does where cells are long") {
  struct Case {
    double aspect;
    std::uint64_t seed;
    int index, enough;
  };
  for (const Case& c : {Case{1.0, 175, 450, 3}, Case{1.5, 1, 161, 3}, Case{2.0, 57, 332, 4}, Case{3.0, 1, 288, 5},
                        Case{3.0, 1521, 360, 6}}) {
    const auto outline = rectangle(24 * c.aspect, 24);
    const VoronoiGrid grid(outline, {1.0, 1.0, c.seed, {24, 24}});
    const double exact = area(brute_force(grid, outline, c.index).vertices);
    CHECK(area(grid.cell(c.index).polygon.vertices) == Approx(exact).epsilon(1e-13));
    for (int bound = 2; bound <= c.enough; ++bound) {
      LabelledPolygon polygon{Polygon(outline.begin(), outline.end()), {-1, -2, -3, -4}};
      for (int other = 0; other < grid.size(); ++other) {
        const int columns = std::abs(other % 24 - c.index % 24), rows = std::abs(other / 24 - c.index / 24);
        if (other == c.index || columns > bound || rows > bound) continue;
        const Vec2 away = grid.site(other) - grid.site(c.index);
        clip(polygon, grid.site(c.index) + away / 2, away, other);
      }
      if (bound < c.enough)
        CHECK(area(polygon.vertices) > exact * (1 + 1e-9));
      else
        CHECK(area(polygon.vertices) == Approx(exact).epsilon(1e-13));
    }
  }
}

namespace {

/// Sites of 24 x 24 cells such that two of them, `apart` columns from each other, see each other past all between: both
/// lie on the line between two rows, the others as far from the circle through the two as their cells let them.
std::vector<Vec2> places_around(int apart, int column, int row) {
  constexpr int n = 24;
  std::vector<Vec2> places;
  for (int r = 0; r < n; ++r)
    for (int c = 0; c < n; ++c) {
      const double away = c + 0.5 - (column + 0.5 * (apart + 1));
      places.emplace_back(away < 0 ? 0 : 1, r < row ? 0 : 1);
      if (r == row && c == column) places.back() = Vec2(1, 0);
      if (r == row && c == column + apart) places.back() = Vec2(0, 0);
    }
  return places;
}

}  // namespace

TEST_CASE("sites can lie so that neighbours are three, four, five and seven cells away") {
  // The circle of diameter apart - 1 between the two must leave a corner of each cell between them outside: of the
  // middle ones at a^2 + 1 (apart odd) or a^2 + 1/4 from its centre, a the cells' length over their width.
  constexpr int n = 24, row = 12, column = 8;
  for (const auto& [aspect, apart] : {std::pair{1.0, 3}, {1.5, 4}, {2.0, 5}, {3.0, 7}}) {
    CAPTURE(aspect);
    const auto outline = rectangle(n, n * aspect);
    const VoronoiGrid grid(outline, {1.0, 1.0, 1, {n, n}}, places_around(apart, column, row));
    const int index = row * n + column;
    const VoronoiCell cell = grid.cell(index);
    CHECK(std::count(cell.polygon.labels.begin(), cell.polygon.labels.end(), index + apart) == 1);
    const double exact = area(brute_force(grid, outline, index).vertices);
    CHECK(area(cell.polygon.vertices) == Approx(exact).epsilon(1e-12));
    LabelledPolygon bounded{Polygon(outline.begin(), outline.end()), {-1, -2, -3, -4}};
    for (int other = 0; other < grid.size(); ++other) {
      if (other == index || std::max(std::abs(other % n - column), std::abs(other / n - row)) >= apart) continue;
      const Vec2 away = grid.site(other) - grid.site(index);
      clip(bounded, grid.site(index) + away / 2, away, other);
    }
    CHECK(area(bounded.vertices) > exact * (1 + 1e-9));
  }
}

TEST_CASE("chosen sites must lie in their cells, one in each") {
  const auto outline = rectangle(2, 1);
  const VoronoiSettings settings{1.0, 1.0, 1, {2, 1}};
  CHECK_THROWS_AS(VoronoiGrid(outline, settings, std::vector<Vec2>{Vec2(0.5, 0.5)}), std::invalid_argument);
  const std::vector<Vec2> outside{Vec2(0.5, 0.5), Vec2(0.5, 1.1)};
  CHECK_THROWS_AS(VoronoiGrid(outline, settings, outside), std::invalid_argument);
  const VoronoiGrid grid(outline, settings, std::vector<Vec2>{Vec2(0.5, 0.5), Vec2(0.25, 1)});
  CHECK(grid.site(1) == Vec2(1.25, 1));
}

TEST_CASE("the nearest site and those within a distance are those of all sites") {
  std::mt19937 random(8);
  const std::array<Vec2, 4> outline{Vec2(0, 0), Vec2(9, 1), Vec2(8, 4), Vec2(-1, 3)};
  const VoronoiGrid grid(outline, {0.4, 1.0, 5});
  for (int k = 0; k < 500; ++k) {
    const Vec2 point(-3 + 14.0 * (random() % 1009) / 1009, -2 + 8.0 * (random() % 1009) / 1009);
    const double radius = 2.0 * (random() % 101) / 101;
    int nearest = 0;
    std::vector<int> within;
    for (int i = 0; i < grid.size(); ++i) {
      if ((grid.site(i) - point).norm() < (grid.site(nearest) - point).norm()) nearest = i;
      if ((grid.site(i) - point).norm() <= radius) within.push_back(i);
    }
    REQUIRE(grid.nearest(point) == nearest);
    REQUIRE(grid.within(point, radius) == within);
  }
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
