// The triangulation under segments of every kind: it stays whole, and labels keep their areas.
#include "triangulation.h"

#include <catch2/catch.hpp>
#include <map>
#include <random>

#include "predicates.h"

using namespace topple::fracture;

namespace {

std::map<int, double> areas(const Triangulation& t) {
  std::map<int, double> result;
  for (int triangle = 0; triangle < t.triangle_slots(); ++triangle)
    if (t.alive(triangle)) result[t.label(triangle)] += t.doubled_area(triangle) / 2;
  return result;
}

std::vector<int> add_loop(Triangulation& t, const Polygon& polygon) {
  std::vector<int> corners, chain;
  for (const Vec2& point : polygon) corners.push_back(t.add_point(point));
  for (std::size_t i = 0; i < corners.size(); ++i) t.add_segment(corners[i], corners[(i + 1) % corners.size()], chain);
  return chain;
}

}  // namespace

TEST_CASE("random points and crossing segments leave a valid triangulation of the whole box") {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    const auto number = [&] { return static_cast<double>(random() % 1000) / (seed % 2 ? 100.0 : 333.3); };
    Triangulation t(Vec2(-1, -1), Vec2(11, 11), 1e-6);
    std::vector<int> chain;
    for (int k = 0; k < 60; ++k)
      t.add_segment(t.add_point(Vec2(number(), number())), t.add_point(Vec2(number(), number())), chain);
    REQUIRE(t.valid());
    CHECK(t.unfinished() == 0);
    CHECK(areas(t)[0] == Approx(144).epsilon(1e-14));
  }
}

TEST_CASE("segments through existing vertices, along edges and back again add nothing twice") {
  Triangulation t(Vec2(-1, -1), Vec2(5, 5), 1e-6);
  std::vector<int> chain;
  const int a = t.add_point(Vec2(0, 0)), b = t.add_point(Vec2(1, 1)), c = t.add_point(Vec2(3, 3));
  t.add_segment(a, c, chain);
  CHECK(chain == std::vector<int>{b, c});
  const int slots = t.triangle_slots();
  chain.clear();
  t.add_segment(c, a, chain);
  CHECK(chain == std::vector<int>{b, a});
  CHECK(t.triangle_slots() == slots);
  CHECK(t.add_point(Vec2(1 + 4e-7, 1)) == b);     // within the tolerance
  const int on = t.add_point(Vec2(2, 2 + 4e-7));  // beside a fixed edge: on it
  CHECK(orientation(t.point(a), t.point(on), t.point(c)) == 0);
  CHECK(t.find_edge(b, on) != Triangulation::none);
  CHECK(t.fixed(t.find_edge(b, on)));
  CHECK(t.valid());
}

TEST_CASE("the union of overlapping squares has its area, whatever crosses what") {
  // Squares of side 2 at steps of 1 along a diagonal: n squares cover 4 + 3 (n - 1).
  Triangulation t(Vec2(-3, -3), Vec2(14, 14), 1e-6);
  for (int k = 0; k < 8; ++k) {
    const double x = k + 1.0 / 3;
    const Polygon square{Vec2(x, x), Vec2(x + 2, x), Vec2(x + 2, x + 2), Vec2(x, x + 2)};
    const auto chain = add_loop(t, square);
    for (const int triangle : t.collect(chain, [&](int i) {
           const Vec2 middle =
               (t.point(t.origin(t.half(i, 0))) + t.point(t.origin(t.half(i, 1))) + t.point(t.origin(t.half(i, 2)))) /
               3;
           return encloses(square, middle);
         }))
      t.set_label(triangle, 7);
    CHECK(areas(t)[7] == Approx(4 + 3 * k).epsilon(1e-14));
  }
  for (int triangle = 0; triangle < t.triangle_slots(); ++triangle) t.settle_sides(triangle);
  CHECK(t.valid());
}

TEST_CASE("the inside of a loop is what lies on its left, and a loop that is none is told") {
  Triangulation t(Vec2(-1, -1), Vec2(5, 5), 1e-6);
  const std::vector<int> chain = add_loop(t, {Vec2(0, 0), Vec2(3, 0), Vec2(3, 3), Vec2(0, 3)});
  const std::vector<int> inner = add_loop(t, {Vec2(1, 1.1), Vec2(2, 0.7), Vec2(1.4, 2.3)});
  for (const Vec2& point : {Vec2(4, 4), Vec2(-0.5, 2)}) (void)t.add_point(point);
  std::vector<int> triangles, edges;
  const auto inside = [&] {
    double doubled = 0;
    for (const int triangle : triangles) doubled += t.doubled_area(triangle);
    return doubled / 2;
  };
  REQUIRE(t.enclose(inner, triangles, edges));
  CHECK(triangles.size() == 1);
  CHECK(inside() == Approx((1.0 * 1.2 + 0.4 * 0.4) / 2).epsilon(1e-14));
  REQUIRE(t.enclose(chain, triangles, edges));  // other borders inside, and an earlier search, do not matter
  CHECK(edges.size() == 4);
  CHECK(triangles.size() == 4 - 2 + 2 * 3);  // of four corners and three points inside
  CHECK(inside() == Approx(9).epsilon(1e-14));
  const std::vector<int> clockwise(chain.rbegin(), chain.rend());
  CHECK_FALSE(t.enclose(clockwise, triangles, edges));
  // A loop with a spike passes a vertex twice; one with a gap has no edge there.
  std::vector<int> spike = chain, rest;
  const int tip = t.add_point(Vec2(4, 0.5));
  t.add_segment(chain[1], tip, rest);
  REQUIRE(rest.size() == 1);
  spike.insert(spike.begin() + 2, {tip, chain[1]});
  CHECK_FALSE(t.enclose(spike, triangles, edges));
  CHECK_FALSE(t.enclose({chain[0], chain[2], tip}, triangles, edges));
}

TEST_CASE("what is fixed is the border between labels, and vertices that no border needs can go") {
  Triangulation t(Vec2(-1, -1), Vec2(5, 5), 1e-6);
  std::vector<int> chain = add_loop(t, {Vec2(0, 0), Vec2(2, 0), Vec2(2, 2), Vec2(0, 2)});
  for (int triangle = 0; triangle < t.triangle_slots(); ++triangle) t.settle_sides(triangle);
  for (const int vertex : chain) CHECK(t.remove_vertex(vertex));
  CHECK(t.valid());
  int left = 0;
  for (int triangle = 0; triangle < t.triangle_slots(); ++triangle) left += t.alive(triangle) ? 1 : 0;
  CHECK(left == 2);
}

TEST_CASE("without obstacles the triangulation is Delaunay's") {
  std::mt19937 random(11);
  Triangulation t(Vec2(-1, -1), Vec2(11, 11), 1e-6);
  std::vector<Vec2> points;
  for (int k = 0; k < 300; ++k)
    points.emplace_back(static_cast<double>(random() % 100000) / 1e4, static_cast<double>(random() % 100000) / 1e4);
  for (const Vec2& point : points) (void)t.add_point(point);
  int inside = 0;
  for (int triangle = 0; triangle < t.triangle_slots(); ++triangle)
    for (const Vec2& point : points)
      inside += certainly_in_circle(t.point(t.origin(t.half(triangle, 0))), t.point(t.origin(t.half(triangle, 1))),
                                    t.point(t.origin(t.half(triangle, 2))), point)
                    ? 1
                    : 0;
  CHECK(inside == 0);
}
