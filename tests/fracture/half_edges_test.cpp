// How triangles hang together when they are split, flipped and merged, whatever their shapes.
#include "half_edges.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

using namespace topple::fracture;

namespace {

/// What a triangulation may do with its half-edges.
class Open : public HalfEdges {
 public:
  Open() : HalfEdges(Vec2(0, 0), Vec2(4, 4)) {}
  using HalfEdges::fill;
  using HalfEdges::flip;
  using HalfEdges::merge_around;
  using HalfEdges::split_edge;
  using HalfEdges::split_triangle;

  [[nodiscard]] double doubled_area_of_all() const {
    double sum = 0;
    for (int triangle = 0; triangle < triangle_slots(); ++triangle)
      if (alive(triangle)) sum += doubled_area(triangle);
    return sum;
  }
};

}  // namespace

TEST_CASE("a vertex that is put into a triangle and taken away again leaves the triangle as it was") {
  Open all;
  all.set_label(0, 3);
  all.settle_sides(0);
  const int vertex = all.split_triangle(0, Vec2(3, 1));
  REQUIRE(all.valid());
  CHECK(all.star(vertex).size() == 3);
  for (const int triangle : all.star(vertex)) CHECK(all.label(triangle) == 3);
  all.clear_touched();

  const int merged = all.merge_around(vertex);
  REQUIRE(merged != HalfEdges::none);
  CHECK(all.valid());
  CHECK(all.label(merged) == 3);
  CHECK(all.doubled_area(merged) == 16);
  CHECK(all.touched().size() == 3);  // what remains and the two that are gone
  CHECK(all.fixed(all.find_edge(0, 2)));
  // Its place is given to the next one.
  CHECK(all.split_triangle(merged, Vec2(3, 2)) == vertex);
}

TEST_CASE("an edge that is split is fixed and tagged in both its parts as it was") {
  Open all;
  const int diagonal = all.find_edge(0, 2);
  REQUIRE(diagonal != HalfEdges::none);
  all.fix(diagonal, 7);
  const int vertex = all.split_edge(diagonal, Vec2(2, 2));
  CHECK(all.valid());
  CHECK(all.star(vertex).size() == 4);
  for (const int corner : {0, 2}) {
    const int part = all.find_edge(corner, vertex);
    REQUIRE(part != HalfEdges::none);
    CHECK((all.fixed(part) && all.tag(part) == 7 && all.tag(all.twin(part)) == 7));
  }
  for (const int corner : {1, 3}) CHECK_FALSE(all.fixed(all.find_edge(corner, vertex)));
  CHECK(all.find_edge(0, 2) == HalfEdges::none);
}

TEST_CASE("however triangles are split and flipped, they cover the box, and a loop encloses what lies inside") {
  std::mt19937 random(5);
  const auto pick = [&](int count) { return std::uniform_int_distribution<int>(0, count - 1)(random); };
  Open all;
  for (int step = 0; step < 300; ++step) {
    const int triangle = pick(all.triangle_slots()), edge = HalfEdges::half(triangle, pick(3)), twin = all.twin(edge);
    const Vec2 &a = all.point(all.origin(edge)), &b = all.point(all.target(edge)), &c = all.point(all.apex(edge));
    if (step % 3 != 0) {
      (void)all.split_triangle(triangle, (a + b + c) / 3);
    } else if (twin != HalfEdges::none) {
      // Only where the two triangles are convex together.
      const Vec2& d = all.point(all.apex(twin));
      const auto turn = [](const Vec2& p, const Vec2& q, const Vec2& r) {
        return (q - p).x() * (r - p).y() - (q - p).y() * (r - p).x();
      };
      if (turn(a, d, c) > 1e-3 && turn(d, b, c) > 1e-3) all.flip(edge);
    }
  }
  REQUIRE(all.valid());
  CHECK(all.doubled_area_of_all() == Approx(32).epsilon(1e-12));

  const std::vector<int> corners{0, 1, 2, 3};
  std::vector<int> border, inside;
  for (std::size_t i = 0; i < 4; ++i) border.push_back(all.find_edge(corners[i], corners[(i + 1) % 4]));
  all.fill(border, inside);
  CHECK(static_cast<int>(inside.size()) == all.triangle_slots());
  // Around one vertex: its star, by its outer edges and by a search from it.
  const int vertex = 10;
  std::vector<int> star = all.star(vertex), ring;
  for (const int triangle : star)
    for (const int edge : HalfEdges::sides(triangle))
      if (all.apex(edge) == vertex) ring.push_back(edge);
  std::vector<int> filled;
  all.fill(ring, filled);
  const auto found =
      all.collect({vertex}, [&](int triangle) { return std::find(star.begin(), star.end(), triangle) != star.end(); });
  for (std::vector<int>* list : {&star, &filled}) std::sort(list->begin(), list->end());
  CHECK(filled == star);
  CHECK(found.size() == star.size());
}
