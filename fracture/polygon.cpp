#include "topple/fracture/polygon.h"

#include <array>

#include "cross.h"
#include "predicates.h"

namespace topple::fracture {

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

namespace {

/// Room for values on the stack where they are few, since most polygons are small and no memory is asked for then.
template <class Value>
class Few {
 public:
  explicit Few(std::size_t size) : many_(size > few ? size : 0), data_(size > few ? many_.data() : few_.data()) {}
  Value& operator[](std::size_t i) { return data_[i]; }
  [[nodiscard]] const Value* data() const { return data_; }

 private:
  static constexpr std::size_t few = 32;
  std::array<Value, few> few_;
  std::vector<Value> many_;
  Value* data_;
};

}  // namespace

bool clip(LabelledPolygon& polygon, const Vec2& point, const Vec2& normal, int label) {
  const std::size_t n = polygon.vertices.size();
  Few<double> beyond(n);
  bool cuts = false;
  for (std::size_t i = 0; i < n; ++i) {
    beyond[i] = normal.dot(polygon.vertices[i] - point);
    cuts = cuts || beyond[i] > 0;
  }
  if (!cuts) return false;
  Few<Vec2> vertices(2 * n);  // the most that n vertices and n sides can give
  Few<int> labels(2 * n);
  std::size_t count = 0;
  const auto keep = [&](const Vec2& vertex, int side) {
    vertices[count] = vertex;
    labels[count++] = side;
  };
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t next = i + 1 < n ? i + 1 : 0;
    const Vec2 &here = polygon.vertices[i], &there = polygon.vertices[next];
    // On the line and leaving: the cut starts here.
    if (beyond[i] <= 0) keep(here, beyond[i] == 0 && beyond[next] > 0 ? label : polygon.labels[i]);
    if (beyond[i] < 0 && beyond[next] > 0)
      keep(here + beyond[i] / (beyond[i] - beyond[next]) * (there - here), label);
    else if (beyond[i] > 0 && beyond[next] < 0)
      keep(there + beyond[next] / (beyond[next] - beyond[i]) * (here - there), polygon.labels[i]);
  }
  if (count < 3) count = 0;
  polygon.vertices.assign(vertices.data(), vertices.data() + count);
  polygon.labels.assign(labels.data(), labels.data() + count);
  return true;
}

}  // namespace topple::fracture
