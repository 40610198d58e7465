#include "renderer/shapes/triangulation.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace topple::viewer {
namespace {

struct Polygon {
  std::vector<glm::vec2> points;  ///< of all loops
  std::vector<int> ring;          ///< indices, counter-clockwise; bridges run there and back
};

float cross(glm::vec2 a, glm::vec2 b) { return a.x * b.y - a.y * b.x; }
float turn(glm::vec2 a, glm::vec2 b, glm::vec2 c) { return cross(b - a, c - b); }

bool inside(glm::vec2 p, glm::vec2 a, glm::vec2 b, glm::vec2 c) {
  return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
}

std::vector<int> oriented(const Loop& loop, int first, bool counter_clockwise) {
  std::vector<int> ring(loop.size());
  for (std::size_t i = 0; i < loop.size(); ++i) ring[i] = first + static_cast<int>(i);
  if ((doubled_area(loop) > 0) != counter_clockwise) std::reverse(ring.begin(), ring.end());
  return ring;
}

/// Do the open segments a-b and c-d cross?
bool cross_properly(glm::vec2 a, glm::vec2 b, glm::vec2 c, glm::vec2 d) {
  return turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
}

/// Does any point other than its ends lie on the segment, or any edge cross it?
bool blocked(const Polygon& polygon, const std::vector<std::vector<int>>& rings, glm::vec2 a, glm::vec2 b) {
  for (const auto& ring : rings)
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const glm::vec2 c = polygon.points[ring[i]], d = polygon.points[ring[(i + 1) % ring.size()]];
      if (cross_properly(a, b, c, d)) return true;
      const bool between = turn(a, b, c) == 0 && (c.x - a.x) * (c.x - b.x) + (c.y - a.y) * (c.y - b.y) < 0;
      if (between) return true;
    }
  return false;
}

/// Splices a hole into the ring by the shortest bridge that crosses nothing.
void join_hole(Polygon& polygon, const std::vector<int>& hole, const std::vector<std::vector<int>>& other_rings) {
  float best = std::numeric_limits<float>::max();
  std::size_t at_ring = 0, at_hole = 0;
  std::vector<std::vector<int>> rings = other_rings;
  rings.push_back(polygon.ring);
  rings.push_back(hole);
  for (std::size_t i = 0; i < polygon.ring.size(); ++i)
    for (std::size_t j = 0; j < hole.size(); ++j) {
      const glm::vec2 a = polygon.points[polygon.ring[i]], b = polygon.points[hole[j]];
      const float distance = (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y);
      if (distance >= best || blocked(polygon, rings, a, b)) continue;
      best = distance, at_ring = i, at_hole = j;
    }
  std::vector<int> joined(polygon.ring.begin(), polygon.ring.begin() + static_cast<std::ptrdiff_t>(at_ring) + 1);
  for (std::size_t j = 0; j <= hole.size(); ++j) joined.push_back(hole[(at_hole + j) % hole.size()]);
  joined.insert(joined.end(), polygon.ring.begin() + static_cast<std::ptrdiff_t>(at_ring), polygon.ring.end());
  polygon.ring = std::move(joined);
}

bool is_ear(const Polygon& polygon, std::size_t i) {
  const auto& ring = polygon.ring;
  const std::size_t n = ring.size();
  const int ia = ring[(i + n - 1) % n], ib = ring[i], ic = ring[(i + 1) % n];
  const glm::vec2 a = polygon.points[ia], b = polygon.points[ib], c = polygon.points[ic];
  if (turn(a, b, c) <= 0) return false;
  return std::none_of(ring.begin(), ring.end(), [&](int k) {
    const glm::vec2 p = polygon.points[k];
    return p != a && p != b && p != c && inside(p, a, b, c);
  });
}

}  // namespace

float doubled_area(const Loop& loop) {
  float sum = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) sum += cross(loop[i], loop[(i + 1) % loop.size()]);
  return sum;
}

std::vector<std::array<int, 3>> triangulate(const Loop& outline, const std::vector<Loop>& holes) {
  Polygon polygon;
  polygon.points = outline;
  polygon.ring = oriented(outline, 0, true);
  std::vector<std::vector<int>> open;
  for (const Loop& hole : holes) {
    open.push_back(oriented(hole, static_cast<int>(polygon.points.size()), false));
    polygon.points.insert(polygon.points.end(), hole.begin(), hole.end());
  }
  while (!open.empty()) {
    const std::vector<int> hole = open.back();
    open.pop_back();
    join_hole(polygon, hole, open);
  }
  std::vector<std::array<int, 3>> triangles;
  auto& ring = polygon.ring;
  while (ring.size() > 3) {
    std::size_t ear = 0;
    while (ear < ring.size() && !is_ear(polygon, ear)) ++ear;
    if (ear == ring.size()) ear = 0;  // only slivers of rounding are left: any corner serves
    const std::size_t n = ring.size();
    triangles.push_back({ring[(ear + n - 1) % n], ring[ear], ring[(ear + 1) % n]});
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  triangles.push_back({ring[0], ring[1], ring[2]});
  return triangles;
}

}  // namespace topple::viewer
