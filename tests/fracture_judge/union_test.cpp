// Unions, differences and intersections of polygons as the triangulation makes them, against CGAL's exact ones.
#include <CGAL/Boolean_set_operations_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_set_2.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <list>
#include <random>

#include "predicates.h"
#include "topple/fracture/local_damage.h"
#include "triangulation.h"

using namespace topple::fracture;

namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Judge = CGAL::Polygon_set_2<Kernel>;
using JudgePolygon = CGAL::Polygon_2<Kernel>;

JudgePolygon to_judge(const Polygon& polygon) {
  JudgePolygon result;
  for (const Vec2& p : polygon) result.push_back(Kernel::Point_2(p.x(), p.y()));
  return result;
}

double judge_area(const Judge& set) {
  std::list<CGAL::Polygon_with_holes_2<Kernel>> parts;
  set.polygons_with_holes(std::back_inserter(parts));
  Kernel::FT sum = 0;
  for (const auto& part : parts) {
    sum += part.outer_boundary().area();
    for (auto hole = part.holes_begin(); hole != part.holes_end(); ++hole) sum += hole->area();  // clockwise: negative
  }
  return CGAL::to_double(sum);
}

/// Labels: 1 inside the first set, 2 inside the second, 3 in both.
void paint(Triangulation& t, const Polygon& polygon, int bit) {
  std::vector<int> corners, chain;
  for (const Vec2& point : polygon) corners.push_back(t.add_point(point));
  for (std::size_t i = 0; i < corners.size(); ++i) t.add_segment(corners[i], corners[(i + 1) % corners.size()], chain);
  for (const int triangle : t.collect(chain, [&](int i) {
         return encloses(
             polygon,
             (t.point(t.origin(t.half(i, 0))) + t.point(t.origin(t.half(i, 1))) + t.point(t.origin(t.half(i, 2)))) / 3);
       }))
    t.set_label(triangle, t.label(triangle) | bit);
  for (int triangle = 0; triangle < t.triangle_slots(); ++triangle) t.settle_sides(triangle);
}

double painted_area(const Triangulation& t, int mask) {
  double doubled = 0;
  for (int triangle = 0; triangle < t.triangle_slots(); ++triangle)
    if (t.alive(triangle) && (t.label(triangle) & mask) == mask) doubled += t.doubled_area(triangle);
  return doubled / 2;
}

}  // namespace

TEST_CASE("united, clipped and intersected damage has the areas that CGAL finds") {
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    const auto number = [&](double most) { return most * (random() % 100003) / 100003; };
    Triangulation t(Vec2(-5, -5), Vec2(11, 9), 1e-9);
    Judge damage, wall;
    const Polygon outline{Vec2(0, 0), Vec2(6, 0.2), Vec2(6.1, 3.9), Vec2(-0.3, 4)};
    wall.insert(to_judge(outline));
    paint(t, outline, 1);
    for (std::uint64_t k = 0; k < 12; ++k) {
      const LocalDamage hit =
          local_damage(Vec2(number(6), number(4)), 1.0, {{5, 12}, {0.2, 1.3}, 0.3}, 100 * seed + k, 0, 100);
      const Polygon& polygon = k % 2 == 0 ? hit.outline : hit.corners;  // convex and star-shaped
      damage.join(to_judge(polygon));
      paint(t, polygon, 2);
    }
    REQUIRE(t.valid());
    Judge both = wall;
    both.intersection(damage);
    // Joining at 1e-9 m moves an edge by no more, over less than 100 m of edges.
    CHECK(std::abs(painted_area(t, 2) - judge_area(damage)) < 1e-7);
    CHECK(std::abs(painted_area(t, 3) - judge_area(both)) < 1e-7);
    CHECK(std::abs(painted_area(t, 1) - judge_area(wall)) < 1e-12);
  }
}
