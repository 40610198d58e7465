#include "contacts/contact_area.h"

#include <BulletCollision/CollisionShapes/btConvexPolyhedron.h>
#include <BulletCollision/CollisionShapes/btPolyhedralConvexShape.h>
#include <BulletCollision/NarrowPhaseCollision/btPolyhedralContactClipping.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace topple::collision {

namespace {

struct ClippedPoints : btDiscreteCollisionDetectorInterface::Result {
  btAlignedObjectArray<btVector3> points;
  void setShapeIdentifiersA(int, int) override {}
  void setShapeIdentifiersB(int, int) override {}
  void addContactPoint(const btVector3&, const btVector3& point, btScalar) override { points.push_back(point); }
};

/// Points in order of angle about their mean: the polygon that they span.
std::vector<btVector3> around(const btAlignedObjectArray<btVector3>& points, const btVector3& normal) {
  btVector3 mean(0, 0, 0);
  for (int i = 0; i < points.size(); ++i) mean += points[i] / points.size();
  btVector3 u, v;
  btPlaneSpace1(normal, u, v);
  std::vector<std::pair<double, btVector3>> by_angle;
  for (int i = 0; i < points.size(); ++i) {
    const btVector3 arm = points[i] - mean;
    by_angle.emplace_back(std::atan2(arm.dot(v), arm.dot(u)), points[i]);
  }
  std::stable_sort(by_angle.begin(), by_angle.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<btVector3> ordered;
  for (const auto& entry : by_angle) ordered.push_back(entry.second);
  return ordered;
}

btVector3 centre_of_area(const std::vector<btVector3>& polygon, const btVector3& normal) {
  btVector3 mean(0, 0, 0), weighted(0, 0, 0);
  for (const btVector3& corner : polygon) mean += corner / static_cast<double>(polygon.size());
  double area = 0, extent = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const btVector3 a = polygon[i] - mean, b = polygon[(i + 1) % polygon.size()] - mean;
    const double triangle = a.cross(b).dot(normal) / 2;
    weighted += (a + b) / 3 * triangle;
    area += triangle;
    extent = std::max<double>(extent, a.length2());
  }
  constexpr double thin = 1e-6;  // an area below this share of its extent squared is a line
  return std::abs(area) > thin * extent ? mean + weighted / area : mean;
}

/// The diagonal that is longest, and what lies farthest from it on both sides.
std::vector<btVector3> four_corners(const std::vector<btVector3>& polygon, const btVector3& normal) {
  if (polygon.size() <= 4) return polygon;
  std::size_t first = 0, third = 0;
  double longest = -1;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    for (std::size_t j = i + 1; j < polygon.size(); ++j) {
      const double length = (polygon[i] - polygon[j]).length2();
      if (length > longest) longest = length, first = i, third = j;
    }
  }
  const btVector3 across = normal.cross(polygon[third] - polygon[first]);
  const auto offset = [&](const btVector3& p) { return (p - polygon[first]).dot(across); };
  const auto sides = std::minmax_element(polygon.begin(), polygon.end(),
                                         [&](const btVector3& a, const btVector3& b) { return offset(a) < offset(b); });
  return {polygon[first], *sides.first, polygon[third], *sides.second};
}

const btConvexPolyhedron* polyhedron(const btConvexShape& shape) {
  return shape.isPolyhedral() ? static_cast<const btPolyhedralConvexShape&>(shape).getConvexPolyhedron() : nullptr;
}

}  // namespace

void set_contact_area(const btAlignedObjectArray<btVector3>& points, Touch& touch) {
  const std::vector<btVector3> polygon = around(points, touch.normal);
  touch.point = centre_of_area(polygon, touch.normal);
  touch.corner_count = 0;
  for (const btVector3& corner : four_corners(polygon, touch.normal)) touch.corners[touch.corner_count++] = corner;
}

void find_contact_area(const SolidPart& first, const btTransform& first_pose, const SolidPart& second,
                       const btTransform& second_pose, Touch& touch) {
  touch.corner_count = 1;
  touch.corners[0] = touch.point;
  const btConvexPolyhedron* hull_a = polyhedron(*first.shape);
  const btConvexPolyhedron* hull_b = polyhedron(*second.shape);
  if (!hull_a || !hull_b) return;
  ClippedPoints clipped;
  btVertexArray work_a, work_b;
  const double skins = first.shape->getMargin() + second.shape->getMargin();
  const double deepest = -(first.reach + second.reach);
  btPolyhedralContactClipping::clipHullAgainstHull(-touch.normal, *hull_a, *hull_b, first_pose * first.local,
                                                   second_pose * second.local, deepest, skins + kContactBand, work_a,
                                                   work_b, clipped);
  if (clipped.points.size() > 0) set_contact_area(clipped.points, touch);
}

}  // namespace topple::collision
