#include "cap.h"

#include <algorithm>
#include <map>

#include "triangulation.h"

namespace topple::fracture {

namespace {

/// Of the lid's size: points closer together than this are one. Far below what a mesh resolves, since a joined point
/// would leave an opening.
constexpr double kCapTolerance = 1e-13;

}  // namespace

std::vector<std::array<int, 2>> lid_edges(const std::vector<std::array<int, 3>>& triangles) {
  std::map<std::array<int, 2>, int> balance;  // of the edge from the lower to the higher number
  for (const auto& triangle : triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = triangle[i], b = triangle[(i + 1) % 3];
      balance[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  std::vector<std::array<int, 2>> edges;
  for (const auto& [edge, count] : balance) {
    for (int k = 0; k < count; ++k) edges.push_back({edge[1], edge[0]});
    for (int k = 0; k > count; --k) edges.push_back(edge);
  }
  return edges;
}

std::vector<std::array<int, 3>> lid(const std::vector<Vec2>& points, const std::vector<std::array<int, 2>>& edges) {
  if (edges.empty()) return {};
  Vec2 lower = points[static_cast<std::size_t>(edges[0][0])], upper = lower;
  for (const auto& edge : edges) {
    lower = lower.cwiseMin(points[static_cast<std::size_t>(edge[0])]);
    upper = upper.cwiseMax(points[static_cast<std::size_t>(edge[0])]);
  }
  const double size = (upper - lower).norm();
  if (!(size > 0)) return {};
  Triangulation cut(lower - Vec2::Constant(size), upper + Vec2::Constant(size), kCapTolerance * size);
  std::map<int, int> vertex_of, point_of;
  for (const auto& edge : edges)
    for (const int point : edge) {
      if (vertex_of.count(point) > 0) continue;
      const int vertex = cut.add_point(points[static_cast<std::size_t>(point)]);
      vertex_of[point] = vertex;
      point_of.emplace(vertex, point);
    }
  std::map<std::array<int, 2>, int> turns;  // by which the winding number rises from right to left of an edge
  for (const auto& edge : edges) {
    std::vector<int> chain{vertex_of[edge[0]]};
    cut.add_segment(chain[0], vertex_of[edge[1]], chain);
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
      turns[{chain[i], chain[i + 1]}] += 1;
      turns[{chain[i + 1], chain[i]}] -= 1;
    }
  }
  std::vector<int> winding(static_cast<std::size_t>(cut.triangle_slots()), 0);
  std::vector<int> order = cut.star(0);  // at a corner of the box, outside
  std::vector<char> seen(winding.size(), 0);
  for (const int triangle : order) seen[static_cast<std::size_t>(triangle)] = 1;
  for (std::size_t i = 0; i < order.size(); ++i)
    for (const int edge : Triangulation::sides(order[i])) {
      const int twin = cut.twin(edge);
      if (twin == Triangulation::none || seen[static_cast<std::size_t>(Triangulation::triangle_of(twin))]) continue;
      const auto rise = turns.find({cut.origin(edge), cut.target(edge)});
      seen[static_cast<std::size_t>(Triangulation::triangle_of(twin))] = 1;
      winding[static_cast<std::size_t>(Triangulation::triangle_of(twin))] =
          winding[static_cast<std::size_t>(order[i])] - (rise == turns.end() ? 0 : rise->second);
      order.push_back(Triangulation::triangle_of(twin));
    }
  std::sort(order.begin(), order.end());
  std::vector<std::array<int, 3>> triangles;
  for (const int triangle : order) {
    if (winding[static_cast<std::size_t>(triangle)] <= 0) continue;
    std::array<int, 3> corners{};
    bool known = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto found = point_of.find(cut.origin(Triangulation::half(triangle, static_cast<int>(i))));
      known = known && found != point_of.end();
      corners[i] = known ? found->second : -1;
    }
    if (known) triangles.push_back(corners);
  }
  return triangles;
}

}  // namespace topple::fracture
