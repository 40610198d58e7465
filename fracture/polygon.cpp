#include "topple/fracture/polygon.h"

#include <array>

#include "predicates.h"

namespace topple::fracture {

namespace {

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

double area(const Polygon& polygon) {
  double twice = 0;
  // From the first vertex: large coordinates do not cancel.
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    twice += cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
  return twice / 2;
}

Vec2 centroid(const Polygon& polygon) {
  double twice = 0;
  Vec2 first = Vec2::Zero();
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const Vec2 a = polygon[i] - polygon[0], b = polygon[i + 1] - polygon[0];
    twice += cross(a, b);
    first += cross(a, b) * (a + b) / 3;
  }
  return polygon[0] + first / twice;
}

bool contains(const Polygon& convex, const Vec2& point) {
  for (std::size_t i = 0; i < convex.size(); ++i)
    if (cross(convex[(i + 1) % convex.size()] - convex[i], point - convex[i]) < 0) return false;
  return !convex.empty();
}

bool encloses(const Polygon& polygon, const Vec2& point) {
  bool inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if (a == point) return true;
    const bool rises = a.y() <= point.y() && b.y() > point.y(), falls = a.y() > point.y() && b.y() <= point.y();
    if (rises || falls) {
      const double side = orientation(a, b, point);
      if (side == 0) return true;
      if ((side > 0) == rises) inside = !inside;
    } else if (a.y() == point.y() && b.y() == point.y() && (a.x() <= point.x()) != (b.x() <= point.x())) {
      return true;  // on a horizontal edge
    }
  }
  return inside;
}

namespace {

bool between(const Vec2& a, const Vec2& b, const Vec2& point) { return (point - a).dot(point - b) <= 0; }

/// Whether two segments have a point in common. Exact but for the order along a line on which three points lie.
bool meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const double abc = orientation(a, b, c), abd = orientation(a, b, d);
  const double cda = orientation(c, d, a), cdb = orientation(c, d, b);
  if (((abc > 0 && abd < 0) || (abc < 0 && abd > 0)) && ((cda > 0 && cdb < 0) || (cda < 0 && cdb > 0))) return true;
  return (abc == 0 && between(a, b, c)) || (abd == 0 && between(a, b, d)) || (cda == 0 && between(c, d, a)) ||
         (cdb == 0 && between(c, d, b));
}

}  // namespace

bool is_simple(const Polygon& polygon) {
  const std::size_t n = polygon.size();
  if (n < 3) return false;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 &a = polygon[i], &b = polygon[(i + 1) % n], &c = polygon[(i + 2) % n];
    if (a == b) return false;
    if (orientation(a, b, c) == 0 && (a - b).dot(c - b) > 0) return false;  // turns back on itself
    for (std::size_t j = i + 2; j < n; ++j)
      if ((j + 1) % n != i && meet(a, b, polygon[j], polygon[(j + 1) % n])) return false;
  }
  return true;
}

void clip(LabelledPolygon& polygon, const Vec2& point, const Vec2& normal, int label) {
  const std::size_t n = polygon.vertices.size();
  // Most polygons are small, and most cuts miss: no memory is asked for then.
  constexpr std::size_t few = 32;
  std::array<double, few> of_few;
  std::vector<double> of_many(n > few ? n : 0);
  double* const beyond = n > few ? of_many.data() : of_few.data();
  bool cuts = false;
  for (std::size_t i = 0; i < n; ++i) {
    beyond[i] = normal.dot(polygon.vertices[i] - point);
    cuts = cuts || beyond[i] > 0;
  }
  if (!cuts) return;
  LabelledPolygon kept;
  kept.vertices.reserve(n + 1);
  kept.labels.reserve(n + 1);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t next = (i + 1) % n;
    if (beyond[i] <= 0) {
      kept.vertices.push_back(polygon.vertices[i]);
      // On the line and leaving: the cut starts here.
      kept.labels.push_back(beyond[i] == 0 && beyond[next] > 0 ? label : polygon.labels[i]);
    }
    if ((beyond[i] < 0 && beyond[next] > 0) || (beyond[i] > 0 && beyond[next] < 0)) {
      const std::size_t inner = beyond[i] < 0 ? i : next, outer = beyond[i] < 0 ? next : i;
      const double share = beyond[inner] / (beyond[inner] - beyond[outer]);
      kept.vertices.push_back(polygon.vertices[inner] + share * (polygon.vertices[outer] - polygon.vertices[inner]));
      kept.labels.push_back(beyond[i] < 0 ? label : polygon.labels[i]);
    }
  }
  if (kept.vertices.size() < 3) kept = {};
  polygon = std::move(kept);
}

}  // namespace topple::fracture
