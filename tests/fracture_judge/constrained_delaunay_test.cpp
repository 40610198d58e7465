// The triangulation that panels are cut in, against CGAL's: with the same vertices and the same fixed edges there is
// one constrained Delaunay triangulation (but for four points on a circle, which random places do not give).
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <catch2/catch.hpp>
#include <random>
#include <set>
#include <tuple>

#include "topple/fracture/local_damage.h"
#include "triangulation.h"

using namespace topple::fracture;

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Judge = CGAL::Constrained_Delaunay_triangulation_2<Kernel>;
using Edge = std::tuple<double, double, double, double>;

Edge edge_between(const Vec2& a, const Vec2& b) {
  const auto first = std::pair(a.x(), a.y()), second = std::pair(b.x(), b.y());
  const auto& [low, high] = std::minmax(first, second);
  return {low.first, low.second, high.first, high.second};
}

struct Edges {
  std::set<Edge> all, fixed;
};

Edges edges_of(const Triangulation& t) {
  Edges edges;
  for (int triangle = 0; triangle < t.triangle_slots(); ++triangle) {
    if (!t.alive(triangle)) continue;
    for (const int edge : Triangulation::sides(triangle)) {
      const Edge own = edge_between(t.point(t.origin(edge)), t.point(t.target(edge)));
      edges.all.insert(own);
      if (t.fixed(edge)) edges.fixed.insert(own);
    }
  }
  return edges;
}

std::set<Edge> judged(const Edges& ours) {
  Judge judge;
  for (const auto& [ax, ay, bx, by] : ours.all) {
    judge.insert({ax, ay});
    judge.insert({bx, by});
  }
  for (const auto& [ax, ay, bx, by] : ours.fixed) judge.insert_constraint({ax, ay}, {bx, by});
  std::set<Edge> edges;
  for (const auto& edge : judge.finite_edges()) {
    const auto segment = judge.segment(edge);
    edges.insert(
        edge_between({segment.source().x(), segment.source().y()}, {segment.target().x(), segment.target().y()}));
  }
  return edges;
}

}  // namespace

TEST_CASE("cut after cut the triangulation is the constrained Delaunay one that CGAL finds") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    const auto number = [&](double most) { return most * (random() % 100003) / 100003; };
    Triangulation t(Vec2(-5.3, -5.1), Vec2(11.2, 9.4), 1e-9);
    for (std::uint64_t k = 0; k < 10; ++k) {
      const LocalDamage hit =
          local_damage(Vec2(number(6), number(4)), 1.0, {{5, 12}, {0.2, 1.3}, 0.3}, 100 * seed + k, 0, 100);
      std::vector<int> corners, chain;
      for (const Vec2& point : hit.outline) corners.push_back(t.add_point(point));
      for (std::size_t i = 0; i < corners.size(); ++i)
        t.add_segment(corners[i], corners[(i + 1) % corners.size()], chain);
      REQUIRE(t.unfinished() == 0);
      const Edges ours = edges_of(t);
      CHECK(ours.fixed.size() >= corners.size());
      CHECK(judged(ours) == ours.all);
    }
  }
}
