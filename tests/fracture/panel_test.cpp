// Panels that break: which cells, which pieces, what they weigh.
#include "topple/fracture/panel.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <set>

#include "topple/fracture/local_damage.h"
#include "topple/fracture/quadrilaterals.h"
#include "topple/fracture/voronoi.h"

using namespace topple::fracture;

namespace {

PanelShape wall(double width = 6, double height = 3) {
  return {{Vec2(0, 0), Vec2(width, 0), Vec2(width, height), Vec2(0, height)}, 0.2, {}, {}};
}

PanelSettings settings(Method method, double cell = 0.5) {
  PanelSettings s;
  s.method = method;
  s.cell = cell;
  return s;
}

constexpr Method kMethods[] = {Method::voronoi, Method::quadrilateral, Method::local};

double hit_area(const Fracture& fracture) {
  double sum = 0;
  for (const Chunk& chunk : fracture.chunks) sum += area(chunk.outline);
  return sum;
}

/// Texture coordinates in metres and normals, as the place in the panel has them.
void require_places_of_panel(const Mesh& mesh) {
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3 &p = mesh.positions[i], &n = mesh.normals[i];
    if (std::abs(n.z()) > 0.5) {
      REQUIRE(mesh.texture[i] == Vec2(p.x(), p.y()));
      REQUIRE(n.z() == (p.z() > 0 ? 1.0 : -1.0));
    } else {
      REQUIRE(mesh.texture[i].y() == p.z());
      REQUIRE(mesh.texture[i].x() == Approx(-n.y() * p.x() + n.x() * p.y()).margin(1e-12));
    }
  }
}

}  // namespace

TEST_CASE("a voronoi hit breaks the cells whose sites lie within the radius, as they are") {
  const std::array<Vec2, 4> corners{Vec2(0, 0), Vec2(6, 0), Vec2(6, 3), Vec2(0, 3)};
  const VoronoiGrid grid(corners, {0.5, 1.0, 3});
  PanelSettings s = settings(Method::voronoi);
  s.seed = 3;
  BreakablePanel panel(wall(), s);
  const Fracture fracture = panel.hit(Vec2(3, 1.4), 0.8);
  double expected = 0;
  std::size_t count = 0;
  for (int i = 0; i < grid.size(); ++i)
    if ((grid.site(i) - Vec2(3, 1.4)).norm() <= 0.8) {
      expected += area(grid.cell(i).polygon.vertices);
      ++count;
    }
  CHECK(count > 4);
  CHECK(fracture.cells == count);
  CHECK(fracture.chunks.size() == count);
  CHECK(hit_area(fracture) == Approx(expected).epsilon(1e-12));
}

TEST_CASE("without a radius, or with one of zero, the cell that was hit breaks and no other") {
  for (const Method method : {Method::voronoi, Method::quadrilateral}) {
    BreakablePanel one(wall(), settings(method)), other(wall(), settings(method));
    CHECK(one.hit(Vec2(2, 1)).chunks.size() == 1);
    CHECK_FALSE(one.holds(Vec2(2, 1)));
    if (method == Method::voronoi) CHECK(other.hit(Vec2(2, 1), 0.0).chunks.size() == 1);
    CHECK(one.hit(Vec2(2, 1)).chunks.empty());  // it is gone
    CHECK(one.hit(Vec2(-3, 1)).chunks.empty());
  }
  BreakablePanel local(wall(), settings(Method::local));
  CHECK(local.hit(Vec2(2, 1), 0.0).chunks.empty());
  CHECK(local.area() == 18.0);
}

TEST_CASE("the quadrilateral that was hit is the one that holds the point, at any jitter and on every side") {
  std::mt19937 random(4);
  const std::array<Vec2, 4> corners{Vec2(0, 0), Vec2(5, 0.3), Vec2(6, 4), Vec2(-0.5, 3)};
  for (const double jitter : {0.0, 0.5, 1.0}) {
    const QuadrilateralGrid grid(corners, {0.4, jitter, 9});
    double sum = 0;
    for (int i = 0; i < grid.size(); ++i) sum += area(grid.cell(i));
    CHECK(sum == Approx(area(Polygon(corners.begin(), corners.end()))).epsilon(1e-13));
    int rounding_errs = 0;
    for (int k = 0; k < 2000; ++k) {
      const Vec2 point(-1 + 8.0 * (random() % 10007) / 10007, -0.5 + 5.0 * (random() % 10007) / 10007);
      int expected = -1;
      for (int i = grid.size() - 1; i >= 0; --i)
        if (encloses(grid.cell(i), point)) expected = i;
      REQUIRE(grid.holding(point) == expected);
      if (expected < 0) continue;
      // What rounding to the nearest grid point's cell would have said on the regular grid.
      const QuadrilateralGrid regular(corners, {0.4, 0.0, 9});
      if (k < 200) rounding_errs += regular.holding(point) != expected ? 1 : 0;
    }
    CHECK((rounding_errs > 0) == (jitter > 0));
    const int first = grid.holding(grid.point(3, 2));  // a corner of four cells
    CHECK(first >= 0);
    CHECK(encloses(grid.cell(first), grid.point(3, 2)));
  }
}

TEST_CASE("flags on cells keep the strip between two lost ones, flags on points would lose it") {
  const std::array<Vec2, 4> corners{Vec2(0, 0), Vec2(5, 0), Vec2(5, 1), Vec2(0, 1)};
  const QuadrilateralGrid grid(corners, {1.0, 0.0, 1});  // one row of five cells
  PanelShape shape = wall(5, 1);
  PanelSettings s = settings(Method::quadrilateral, 1.0);
  s.jitter = 0.0;
  BreakablePanel panel(shape, s);
  (void)panel.hit(Vec2(1.5, 0.5));
  (void)panel.hit(Vec2(3.5, 0.5));
  CHECK(panel.holds(Vec2(2.5, 0.5)));
  CHECK(panel.area() == Approx(3.0).epsilon(1e-14));
  CHECK(audit(panel.mesh()).sound());
  // The same damage on points: the lost cells' points are gone, and with them every cell that has one of them.
  std::set<std::pair<int, int>> lost;
  for (const int column : {1, 2, 3, 4})
    for (const int row : {0, 1}) lost.insert({column, row});
  double kept = 0;
  for (int column = 0; column < 5; ++column) {
    bool whole = true;
    for (const int c : {column, column + 1})
      for (const int row : {0, 1}) whole = whole && lost.count({c, row}) == 0;
    if (whole) kept += area(grid.cell(column));
  }
  CHECK(kept == 0);  // the strip of width 1, and the ends as well
}

TEST_CASE("local damage surrounds the hit, ends convex, and its cells tile it") {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    LocalDamageSettings s;
    s.points = {3, 3 + static_cast<int>(seed % 10)};
    s.length = {0.1, 1.0};
    const Vec2 hit(2, 1);
    const LocalDamage damage = local_damage(hit, 1.0, s, seed, 0, 100);
    REQUIRE(contains(damage.outline, hit));
    const std::size_t n = damage.outline.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Vec2 along = damage.outline[(i + 1) % n] - damage.outline[i];
      const Vec2 next = damage.outline[(i + 2) % n] - damage.outline[(i + 1) % n];
      REQUIRE(along.x() * next.y() - along.y() * next.x() >= 0);  // no concave corner is left
    }
    const auto count = static_cast<double>(damage.corners.size());
    for (std::size_t i = 0; i < damage.corners.size(); ++i) {  // each corner in its own part of the circle
      const Vec2 arm = damage.corners[i] - hit;
      const double share =
          std::remainder(std::atan2(arm.y(), arm.x()) / (2 * M_PI) - static_cast<double>(i) / count, 1.0);
      REQUIRE(std::abs(share) <= 0.5 / count + 1e-12);
    }
    for (std::size_t i = 0; i < damage.corners.size(); ++i) {
      const Vec2 a = damage.corners[i] - hit, b = damage.corners[(i + 1) % damage.corners.size()] - hit;
      REQUIRE(a.x() * b.y() - a.y() * b.x() > 0);  // no gap of 180 degrees or more
      REQUIRE(a.norm() <= 1.0 + 1e-12);
      REQUIRE(a.norm() >= 0.1 - 1e-12);
    }
    double sum = 0;
    for (const Polygon& cell : damage.cells) {
      sum += area(cell);
      REQUIRE(area(cell) > 0);
      for (const Vec2& corner : cell) REQUIRE(contains(cell, corner));
    }
    REQUIRE(sum == Approx(area(damage.outline)).epsilon(1e-12));
  }
}

TEST_CASE("local damage: the radius is reached, and ring cracks cut what is long") {
  LocalDamageSettings s;
  s.points = {9, 9};
  s.length = {0.5, 1.0};
  s.ring = 0.2;
  const LocalDamage plain = local_damage(Vec2(0, 0), 1.0, s, 4, 0, 100),
                    doubled = local_damage(Vec2(0, 0), 2.0, s, 4, 0, 100);
  for (std::size_t i = 0; i < 9; ++i) CHECK((2 * plain.corners[i] - doubled.corners[i]).norm() < 1e-12);
  CHECK(doubled.cells.size() > plain.cells.size());
  s.ring = 10;
  CHECK(local_damage(Vec2(0, 0), 1.0, s, 4, 0, 100).cells.size() <= 18);  // sectors and closed corners alone
}

TEST_CASE("openings and the border clip what breaks") {
  for (const Method method : kMethods) {
    PanelShape shape = wall();
    shape.openings = {{Vec2(2, 1), Vec2(4, 1), Vec2(4, 2), Vec2(2, 2)},
                      {Vec2(5, -1), Vec2(5.5, -1), Vec2(5.5, 1), Vec2(5, 1)}};
    BreakablePanel panel(shape, settings(method));
    CHECK(panel.intact_area() == Approx(18 - 2 - 0.5).epsilon(1e-14));
    CHECK_FALSE(panel.holds(Vec2(3, 1.5)));
    CHECK(panel.intact_length(0) == Approx(5.5));
    double sum = 0;
    for (const Vec2& at : {Vec2(3, 1.5), Vec2(2, 1), Vec2(0, 0), Vec2(5.2, 1.2)}) {
      const Fracture fracture = panel.hit(at, 0.7);
      sum += hit_area(fracture);
      for (const Chunk& chunk : fracture.chunks)
        for (const Vec2& corner : chunk.outline) {
          CHECK(corner.x() >= -1e-12);
          CHECK(corner.y() >= -1e-12);
          CHECK_FALSE((corner.x() > 2.001 && corner.x() < 3.999 && corner.y() > 1.001 && corner.y() < 1.999));
        }
    }
    CHECK(sum > 1);
    CHECK(panel.area() + sum == Approx(15.5).epsilon(1e-13));
  }
}

TEST_CASE("what no held edge holds any more comes loose, in convex pieces") {
  for (const Method method : kMethods) {
    PanelShape shape = wall(6, 3);
    shape.held = {true, false, false, false};
    PanelSettings s = settings(method, 0.4);
    s.local.length = {0.5, 0.6};
    BreakablePanel panel(shape, s);
    // A cut right across at half the height: all above it falls.
    double sum = 0;
    std::size_t loose = 0;
    for (double x = 0; x <= 6; x += 0.3) {
      const Fracture fracture = panel.hit(Vec2(x, 1.5), 0.5);
      sum += hit_area(fracture);
      for (const Chunk& chunk : fracture.chunks) loose += chunk.hit ? 0 : 1;
    }
    CHECK(loose > 0);
    CHECK_FALSE(panel.holds(Vec2(3, 2.9)));
    CHECK(panel.holds(Vec2(3, 0.2)));
    CHECK(panel.area() + sum == Approx(18).epsilon(1e-13));
    CHECK(panel.intact_length(0) == Approx(6).epsilon(1e-14));
    CHECK(panel.intact_length(2) == 0);
  }
}

TEST_CASE("every chunk is convex to the panel's tolerance and lies where it was") {
  for (const Method method : kMethods) {
    BreakablePanel panel(wall(), settings(method));
    for (const Vec2& at : {Vec2(2, 1), Vec2(2.6, 1.3), Vec2(0, 3)})
      for (const Chunk& chunk : panel.hit(at, 0.9).chunks) {
        const std::size_t n = chunk.outline.size();
        for (std::size_t i = 0; i < n; ++i) {
          const Vec2 &a = chunk.outline[i], &b = chunk.outline[(i + 1) % n];
          for (const Vec2& c : chunk.outline) {
            const double off = ((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x()) / (b - a).norm();
            CHECK(off >
                  -1e-5);  // an edge may be a few tolerances (7e-7 m) long: its direction is less sure than its place
          }
        }
      }
  }
}

TEST_CASE("mass, centre and inertia of a chunk are those of its solid") {
  // A right triangle 3 x 4 of thickness 2: textbook values about its centre.
  const Chunk chunk{{Vec2(1, 1), Vec2(4, 1), Vec2(1, 5)}, {{0, 1, 2}}, true};
  const MassProperties p = properties_of(chunk, 2, 10);
  const double m = 6 * 2 * 10;
  CHECK(p.volume == Approx(12).epsilon(1e-15));
  CHECK(p.mass == Approx(m).epsilon(1e-15));
  CHECK((p.centre - Vec3(2, 7.0 / 3, 0)).norm() < 1e-14);
  CHECK(p.inertia(0, 0) == Approx(m * (16.0 / 18 + 4.0 / 12)).epsilon(1e-14));  // h^2/18 and t^2/12
  CHECK(p.inertia(1, 1) == Approx(m * (9.0 / 18 + 4.0 / 12)).epsilon(1e-14));
  CHECK(p.inertia(2, 2) == Approx(m * (25.0 / 18)).epsilon(1e-14));
  CHECK(p.inertia(0, 1) == Approx(m * 12.0 / 36).epsilon(1e-14));  // product of inertia -b h/36, with its sign
  // A box, against the box's own formula.
  const Chunk box{{Vec2(-1, 0), Vec2(2, 0), Vec2(2, 1), Vec2(-1, 1)}, {{0, 1, 2}, {0, 2, 3}}, true};
  const MassProperties b = properties_of(box, 0.5, 2400);
  CHECK(b.inertia(2, 2) == Approx(b.mass * (9 + 1) / 12).epsilon(1e-14));
  CHECK(std::abs(b.inertia(0, 1)) < 1e-12 * b.mass);
}

TEST_CASE("texture and normals of what remains stay where they were") {
  for (const Method method : kMethods) {
    BreakablePanel panel(wall(), settings(method));
    (void)panel.hit(Vec2(2, 1), 0.6);
    for (int k = 0; k < 2; ++k) {
      const Mesh mesh = compact(panel.mesh());
      require_places_of_panel(mesh);
      (void)panel.hit(Vec2(4, 2), 0.6);
    }
  }
}

TEST_CASE("only the edges between intact and broken cells, and the border, become sides") {
  const std::array<Vec2, 4> corners{Vec2(0, 0), Vec2(6, 0), Vec2(6, 3), Vec2(0, 3)};
  const VoronoiGrid cells(corners, {0.5, 1.0, 1});
  const QuadrilateralGrid quads(corners, {0.5, 0.5, 1});
  const Vec2 at(2, 1.4);
  const double radius = 0.6;  // what breaks stays off the border
  // The edges of broken cells that no other broken cell has, and those on the border, by the cells' own neighbours.
  const std::vector<int> broken_cells = cells.within(at, radius), broken_quads = quads.within(at, radius);
  const auto is_broken = [](const std::vector<int>& broken, int index) {
    return std::binary_search(broken.begin(), broken.end(), index);
  };
  double cell_edges = 0, quad_edges = 0;
  for (const int index : broken_cells) {
    const LabelledPolygon& polygon = cells.cell(index).polygon;
    const std::size_t n = polygon.vertices.size();
    for (std::size_t i = 0; i < n; ++i) {
      REQUIRE(polygon.labels[i] >= 0);  // none on the border here
      if (!is_broken(broken_cells, polygon.labels[i]))
        cell_edges += (polygon.vertices[(i + 1) % n] - polygon.vertices[i]).norm();
    }
  }
  for (const int index : broken_quads) {
    const Polygon cell = quads.cell(index);
    const int n = quads.columns(), neighbours[] = {index - n, index + 1, index + n, index - 1};
    REQUIRE((index >= n && index < quads.size() - n));
    for (std::size_t i = 0; i < 4; ++i)
      if (!is_broken(broken_quads, neighbours[i])) quad_edges += (cell[(i + 1) % 4] - cell[i]).norm();
  }
  for (const Method method : {Method::voronoi, Method::quadrilateral}) {
    BreakablePanel panel(wall(), settings(method));
    const std::size_t border = 8;  // two triangles for each side
    CHECK(panel.mesh().triangles.size() == 4 + border);
    const Fracture fracture = panel.hit(at, radius);
    REQUIRE(fracture.chunks.size() == (method == Method::voronoi ? broken_cells : broken_quads).size());
    const Mesh& mesh = panel.mesh();
    double sides = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
      const auto corner = [&](int i) -> const Vec3& { return mesh.positions[static_cast<std::size_t>(i)]; };
      if (mesh.normals[static_cast<std::size_t>(a)].z() == 0)
        sides += (corner(b) - corner(a)).cross(corner(c) - corner(a)).norm() / 2;
    }
    const double edges = 18 + (method == Method::voronoi ? cell_edges : quad_edges);
    CHECK(sides == Approx(0.2 * edges).epsilon(1e-9));  // corners are joined within 7e-7 m at most
  }
}

TEST_CASE("chunks have the texture and normals of the panel that they were") {
  for (const Method method : kMethods) {
    BreakablePanel panel(wall(), settings(method));
    for (const Chunk& chunk : panel.hit(Vec2(2, 1), 0.8).chunks) {
      const Mesh mesh = mesh_of(chunk, 0.2);
      for (const Vec3& p : mesh.positions) REQUIRE(std::abs(p.z()) == 0.1);
      require_places_of_panel(mesh);
    }
  }
}

TEST_CASE("the same hits give the same pieces, and a copy goes its own way") {
  for (const Method method : kMethods) {
    BreakablePanel one(wall(), settings(method)), two(wall(), settings(method));
    (void)one.hit(Vec2(1, 1), 0.5);
    (void)two.hit(Vec2(1, 1), 0.5);
    BreakablePanel copy(one);
    const Fracture a = one.hit(Vec2(3, 2), 0.7), b = two.hit(Vec2(3, 2), 0.7), c = copy.hit(Vec2(3, 2), 0.7);
    REQUIRE(a.chunks.size() == b.chunks.size());
    REQUIRE(a.chunks.size() == c.chunks.size());
    for (std::size_t i = 0; i < a.chunks.size(); ++i) {
      CHECK(a.chunks[i].outline == b.chunks[i].outline);
      CHECK(a.chunks[i].outline == c.chunks[i].outline);
    }
    CHECK(one.mesh().triangles == two.mesh().triangles);
  }
}

TEST_CASE("a panel that cannot be is refused") {
  PanelShape shape = wall();
  shape.thickness = 0;
  CHECK_THROWS_AS(BreakablePanel(shape, {}), std::invalid_argument);
  shape = wall();
  std::swap(shape.outline[0], shape.outline[1]);
  CHECK_THROWS_AS(BreakablePanel(shape, {}), std::invalid_argument);
  shape = wall();
  shape.outline.push_back(Vec2(-1, 1.5));
  CHECK_THROWS_AS(BreakablePanel(shape, settings(Method::voronoi)), std::invalid_argument);
  CHECK_NOTHROW(BreakablePanel(shape, settings(Method::local)));
  BreakablePanel panel(wall(), {});
  CHECK_THROWS_AS(panel.hit(Vec2(std::nan(""), 0)), std::invalid_argument);
  CHECK_THROWS_AS(panel.hit(Vec2(0, 0), -1.0), std::invalid_argument);
  CHECK_THROWS_AS(panel.hit(Vec2(0, 0), INFINITY), std::invalid_argument);
}

TEST_CASE("more cells than can be of use are refused before any is made") {
  PanelShape vast = wall();
  // Nearly 1e10 cells, of which no row is too long.
  vast.outline = {Vec2(0, 0), Vec2(99'000, 0), Vec2(99'000, 99'000), Vec2(0, 99'000)};
  for (const Method method : {Method::voronoi, Method::quadrilateral}) {
    PanelSettings fine = settings(method);
    fine.cell = 1;
    CHECK_THROWS_WITH(expect_fit(vast, fine), Catch::Contains("cell is too small for the panel"));
    CHECK_THROWS_WITH(BreakablePanel(vast, fine), Catch::Contains("cell is too small for the panel"));
    fine.cell = 1000;
    CHECK_NOTHROW(expect_fit(vast, fine));
  }
  PanelSettings rings = settings(Method::local);
  rings.local.ring = 0.01;
  CHECK_THROWS_WITH(expect_fit(vast, rings), Catch::Contains("ring is too small for the panel"));
}

TEST_CASE("the work of a hit grows with its damage, not with the wall nor with earlier damage elsewhere") {
  for (const Method method : kMethods) {
    BreakablePanel small(wall(10, 10), settings(method)), large(wall(100, 100), settings(method));
    const std::size_t alone = small.hit(Vec2(5, 5), 1.0).triangles_changed;
    (void)large.hit(Vec2(50, 50), 1.0);
    std::size_t most = 0, wide = 0;
    for (int k = 0; k < 60; ++k) {
      const Fracture fracture = large.hit(Vec2(5 + k % 8 * 11, 5 + k / 8 * 11), 1.0);
      most = std::max(most, fracture.triangles_changed);
    }
    CHECK(most < 3 * alone);  // places differ in the number of their cells, by less than this
    BreakablePanel fresh(wall(100, 100), settings(method));
    wide = fresh.hit(Vec2(50, 50), 4.0).triangles_changed;
    CHECK(wide > alone);
    CHECK(wide < 20 * alone);  // sixteen times the cells
  }
}

TEST_CASE("a panel that comes off leaves altogether, whatever was broken before") {
  for (const Method method : kMethods) {
    BreakablePanel panel(wall(), settings(method));
    const double first = hit_area(panel.hit(Vec2(2, 1), 0.6));
    const Fracture rest = panel.leave();
    CHECK(rest.chunks.size() > 1);  // with a hole in it, it is not convex
    CHECK(first + hit_area(rest) == Approx(18).epsilon(1e-13));
    CHECK(panel.area() == 0);
    CHECK(panel.mesh().triangles.empty());
    CHECK(panel.leave().chunks.empty());
    CHECK(panel.valid());
  }
}
