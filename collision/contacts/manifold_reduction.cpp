#include "contacts/manifold_reduction.h"

#include <algorithm>
#include <cmath>

namespace topple::collision {

namespace {

/// m: points within this of the deepest bear like it; it is more than what springs give way under a heap.
constexpr double same_depth = 0.003;
/// Of the patch's squared extent: what adds less to its width or area adds no bearing.
constexpr double least_aspect = 0.02;

}  // namespace

void reduce_to_four(const Vec3& normal, std::vector<ManifoldPoint>& points, std::vector<Vec3>& places,
                    Manifold& manifold) {
  const auto keep = [&](std::size_t i) {
    manifold.points[static_cast<std::size_t>(manifold.count++)] = points[i];
    points[i] = points.back(), points.pop_back();
    places[i] = places.back(), places.pop_back();
  };
  manifold.count = 0;
  if (points.size() <= Manifold::most) {
    for (const ManifoldPoint& point : points) manifold.points[static_cast<std::size_t>(manifold.count++)] = point;
    return;
  }
  // What nearly touches bears before what is only near: a body that lost a corner under it each step would rock on it.
  const auto deepest = std::min_element(points.begin(), points.end(),
                                        [](const auto& p, const auto& q) { return p.separation < q.separation; });
  auto chosen = static_cast<std::size_t>(deepest - points.begin());
  const double bearing = points[chosen].separation + same_depth;
  const auto most = [&](double useful, const auto& value) {
    std::size_t best = 0;
    double largest = -1;
    bool bears = false;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double now = std::max(0.0, value(i));
      const bool as_deep = points[i].separation <= bearing && now > useful;
      if (as_deep < bears || (as_deep == bears && now <= largest)) continue;
      largest = now, best = i, bears = as_deep;
    }
    return best;
  };
  const Vec3 a = places[chosen];
  keep(chosen);
  double extent = 0;  // squared
  for (const Vec3& place : places) extent = std::max(extent, (place - a).squaredNorm());
  const double enough = least_aspect * extent;
  chosen = most(enough, [&](std::size_t i) { return (places[i] - a).squaredNorm(); });
  const Vec3 b = places[chosen];
  keep(chosen);
  const auto area = [&](const Vec3& p, const Vec3& q, std::size_t i) {
    return normal.dot((p - places[i]).cross(q - places[i]));
  };
  chosen = most(enough, [&](std::size_t i) { return std::abs(area(a, b, i)); });
  const Vec3 c = places[chosen];
  const double side = area(a, b, chosen) < 0 ? -1 : 1;
  keep(chosen);
  // What adds most to the triangle, outside of any of its sides.
  chosen = most(enough, [&](std::size_t i) {
    return std::max({-side * area(a, b, i), -side * area(b, c, i), -side * area(c, a, i)});
  });
  keep(chosen);
}

}  // namespace topple::collision
