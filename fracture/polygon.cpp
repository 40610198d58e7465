#include "topple/fracture/polygon.h"

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

void clip(LabelledPolygon& polygon, const Vec2& point, const Vec2& normal, int label) {
  const std::size_t n = polygon.vertices.size();
  std::vector<double> beyond(n);
  bool cuts = false;
  for (std::size_t i = 0; i < n; ++i) {
    beyond[i] = normal.dot(polygon.vertices[i] - point);
    cuts = cuts || beyond[i] > 0;
  }
  if (!cuts) return;
  LabelledPolygon kept;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t next = (i + 1) % n;
    if (beyond[i] <= 0) {
      kept.vertices.push_back(polygon.vertices[i]);
      // On the line and leaving: the cut starts here.
      kept.labels.push_back(beyond[i] == 0 && beyond[next] > 0 ? label : polygon.labels[i]);
    }
    if ((beyond[i] < 0 && beyond[next] > 0) || (beyond[i] > 0 && beyond[next] < 0)) {
      const double share = beyond[i] / (beyond[i] - beyond[next]);
      kept.vertices.push_back(polygon.vertices[i] + share * (polygon.vertices[next] - polygon.vertices[i]));
      kept.labels.push_back(beyond[i] < 0 ? label : polygon.labels[i]);
    }
  }
  if (kept.vertices.size() < 3) kept = {};
  polygon = std::move(kept);
}

}  // namespace topple::fracture
