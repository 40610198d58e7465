#include "contacts/part_contacts.h"

#include <algorithm>
#include <cmath>

#include "contacts/manifold_reduction.h"

namespace topple::collision {

namespace {

void set_single(const Vec3& on_first, const Vec3& on_second, const Vec3& normal, double separation,
                const Placement& first_at, const Placement& second_at, Manifold& manifold) {
  manifold.count = 1;
  ManifoldPoint& point = manifold.points[0];
  point.on_first = first_at.turn.transpose() * (on_first - first_at.position);
  point.on_second = second_at.turn.transpose() * (on_second - second_at.position);
  point.separation = separation;
  manifold.normal = normal;
  manifold.normal_on_first = false;
  manifold.local_normal = second_at.turn.transpose() * normal;
}

void collide_balls(const PartShape& first, const Placement& first_at, const PartShape& second,
                   const Placement& second_at, double margin, Manifold& manifold) {
  const Vec3 a = first_at * first.centre, b = second_at * second.centre, way = b - a;
  const double distance = way.norm(), separation = distance - first.radius - second.radius;
  if (separation > margin) return;
  const Vec3 normal = distance > 0 ? Vec3(way / distance) : Vec3(0, 0, 1);
  set_single(a + first.radius * normal, b - second.radius * normal, normal, separation, first_at, second_at, manifold);
}

Vec3 nearest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 way = b - a;
  return a + std::clamp((p - a).dot(way) / way.squaredNorm(), 0.0, 1.0) * way;
}

Vec3 nearest_on_face(const Polyhedron& of, const Polyhedron::Face& face, const Vec3& p) {
  const auto corner = [&](int k) -> const Vec3& {
    return of.vertices[static_cast<std::size_t>(of.loops[static_cast<std::size_t>(face.first + k % face.count)])];
  };
  bool inside = true;
  Vec3 nearest = corner(0);
  double least = 1e300;
  for (int i = 0; i < face.count; ++i) {
    const Vec3 &a = corner(i), &b = corner(i + 1);
    if ((b - a).cross(face.normal).dot(p - a) > 0) inside = false;
    const Vec3 on = nearest_on_segment(p, a, b);
    if (const double now = (p - on).squaredNorm(); now < least) least = now, nearest = on;
  }
  return inside ? Vec3(p - (face.normal.dot(p) - face.offset) * face.normal) : nearest;
}

/// The ball first.
void collide_ball(const PartShape& ball, const Placement& ball_at, const Polyhedron& other, const Placement& other_at,
                  double margin, Manifold& manifold) {
  const Vec3 centre = ball_at * ball.centre, p = other_at.turn.transpose() * (centre - other_at.position);
  const Polyhedron::Face* outermost = nullptr;
  double out = -1e300;
  for (const Polyhedron::Face& face : other.faces)
    if (const double over = face.normal.dot(p) - face.offset; over > out) out = over, outermost = &face;
  if (out - ball.radius > margin) return;
  Vec3 on = p - out * outermost->normal, normal = -outermost->normal;
  double separation = out - ball.radius;
  if (out > 0) {
    double least = 1e300;
    for (const Polyhedron::Face& face : other.faces) {
      if (face.normal.dot(p) <= face.offset) continue;
      const Vec3 candidate = nearest_on_face(other, face, p);
      if (const double now = (p - candidate).norm(); now < least) least = now, on = candidate;
    }
    separation = least - ball.radius;
    if (separation > margin) return;
    if (least > 0) normal = (on - p) / least;
  }
  const Vec3 global = other_at.turn * normal;
  set_single(centre + ball.radius * global, other_at * on, global, separation, ball_at, other_at, manifold);
}

/// Corners under which another stands, more below them than beside: a body would have to turn by 45 degrees before they
/// touch instead. The upper corner of a panel that lands aslant stands a little farther out than the lower one, and
/// of the four that are kept it would be one in its place: the panel would go into the ground by its thickness.
void leave_out_covered(std::vector<ManifoldPoint>& points, std::vector<Vec3>& places) {
  const auto covered = [&](const Vec3& place) {
    return std::any_of(places.begin(), places.end(),
                       [&](const Vec3& other) { return place.z() - other.z() > (place - other).head<2>().norm(); });
  };
  // What covers a corner that covers another covers that one too: the order does not matter.
  for (std::size_t i = 0; i < places.size();) {
    if (!covered(places[i])) {
      ++i;
      continue;
    }
    points.erase(points.begin() + static_cast<std::ptrdiff_t>(i));
    places.erase(places.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

}  // namespace

void collide(const PartShape& first, const Placement& first_at, const PartShape& second, const Placement& second_at,
             double margin, SeparatingAxis& axis, Manifold& manifold) {
  manifold.count = 0;
  if (first.polyhedron && second.polyhedron) {
    collide(*first.polyhedron, first_at, *second.polyhedron, second_at, margin, axis, manifold);
  } else if (second.polyhedron) {
    collide_ball(first, first_at, *second.polyhedron, second_at, margin, manifold);
  } else if (first.polyhedron) {
    collide_ball(second, second_at, *first.polyhedron, first_at, margin, manifold);
    manifold.normal = -manifold.normal;
    manifold.local_normal = -manifold.local_normal;
    manifold.normal_on_first = !manifold.normal_on_first;
    for (int i = 0; i < manifold.count; ++i)
      std::swap(manifold.points[static_cast<std::size_t>(i)].on_first,
                manifold.points[static_cast<std::size_t>(i)].on_second);
  } else {
    collide_balls(first, first_at, second, second_at, margin, manifold);
  }
}

void collide_with_ground(const PartShape& part, const Placement& at, double height, double margin, Manifold& manifold) {
  const Vec3 down(0, 0, -1);
  manifold.count = 0;
  if (!part.polyhedron) {
    const Vec3 lowest = at * part.centre + part.radius * down;
    const double separation = lowest.z() - height;
    if (separation <= margin) set_single(lowest, {lowest.x(), lowest.y(), height}, down, separation, at, {}, manifold);
    return;
  }
  static thread_local std::vector<ManifoldPoint> points;
  static thread_local std::vector<Vec3> places;
  points.clear();
  places.clear();
  for (const Vec3& vertex : part.polyhedron->vertices) {
    const Vec3 place = at * vertex;
    if (place.z() - height > margin) continue;
    ManifoldPoint point;
    point.on_first = vertex;
    point.on_second = {place.x(), place.y(), height};
    point.separation = place.z() - height;
    points.push_back(point);
    places.push_back(place);
  }
  manifold.normal = manifold.local_normal = down;
  manifold.normal_on_first = false;
  if (points.size() > Manifold::most) leave_out_covered(points, places);
  reduce_to_four(down, points, places, manifold);
}

}  // namespace topple::collision
