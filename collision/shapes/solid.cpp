#include "shapes/solid.h"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btConvexPolyhedron.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <algorithm>
#include <stdexcept>

namespace topple::collision {

namespace {

[[noreturn]] void refuse(const std::string& owner, const ConvexPart& part, const std::string& why) {
  throw std::invalid_argument(owner + ", part with tag " + std::to_string(part.tag) + ": " + why);
}

/// By which the store knows a box or hull.
std::vector<double> numbers_of(const ConvexPart& part) {
  if (part.kind == ConvexPart::Kind::box) return {part.half_extents.begin(), part.half_extents.end()};
  std::vector<double> numbers;
  for (const Vec3& point : part.points) numbers.insert(numbers.end(), point.begin(), point.end());
  return numbers;
}

bool is_rotation(const Eigen::Quaterniond& q) { return q.coeffs().allFinite() && q.norm() > 0.5 && q.norm() < 2; }

/// Largest height of the points over the plane through three of them: below `thin` they enclose no volume.
bool is_flat(const std::vector<Vec3>& points, double thin) {
  const auto farthest = [&](auto&& distance) {
    return *std::max_element(points.begin(), points.end(),
                             [&](const Vec3& a, const Vec3& b) { return distance(a) < distance(b); });
  };
  const Vec3 a = points.front();
  const Vec3 b = farthest([&](const Vec3& p) { return (p - a).norm(); });
  const Vec3 along = (b - a).normalized();
  const auto from_line = [&](const Vec3& p) { return (p - a).cross(along).norm(); };
  const Vec3 c = farthest(from_line);
  if (!((b - a).norm() > thin) || !(from_line(c) > thin)) return true;
  const Vec3 normal = along.cross(c - a).normalized();
  const auto from_plane = [&](const Vec3& p) { return std::abs((p - a).dot(normal)); };
  return !(from_plane(farthest(from_plane)) > thin);
}

std::unique_ptr<btConvexShape> make_box(const ConvexPart& part, const std::string& owner, PolyhedronStore& polyhedra) {
  if (!part.half_extents.allFinite() || !(part.half_extents.minCoeff() > 0)) {
    refuse(owner, part, "a box needs half extents above zero");
  }
  auto box = std::make_unique<btBoxShape>(to_bullet(part.half_extents));
  box->setMargin(std::min(kSkinOfBox, 0.1 * part.half_extents.minCoeff()));
  polyhedra.give_features(*box, numbers_of(part));
  return box;
}

std::unique_ptr<btConvexShape> make_sphere(const ConvexPart& part, const std::string& owner) {
  if (!std::isfinite(part.half_extents.x()) || !(part.half_extents.x() > 0)) {
    refuse(owner, part, "a sphere needs a radius (half_extents.x) above zero");
  }
  return std::make_unique<btSphereShape>(part.half_extents.x());
}

std::unique_ptr<btConvexShape> make_hull(const ConvexPart& part, const std::string& owner, PolyhedronStore& polyhedra) {
  for (const Vec3& point : part.points) {
    if (!point.allFinite()) refuse(owner, part, "a hull needs finite points");
  }
  constexpr double thin = 1e-6;  // m: below it the rounding of coordinates decides what the hull looks like
  if (part.points.size() < 4 || is_flat(part.points, thin)) {
    refuse(owner, part, "a hull needs four points that do not lie in one plane");
  }
  auto hull = std::make_unique<btConvexHullShape>();
  for (const Vec3& point : part.points) hull->addPoint(to_bullet(point), false);
  hull->setMargin(kSkin);
  hull->recalcLocalAabb();
  if (!PolyhedronStore::give_prism(*hull, part.points)) polyhedra.give_features(*hull, numbers_of(part));
  return hull;
}

std::unique_ptr<btConvexShape> make_shape(const ConvexPart& part, const std::string& owner,
                                          PolyhedronStore& polyhedra) {
  if (!part.pose.position.allFinite() || !is_rotation(part.pose.orientation))
    refuse(owner, part, "its pose is not finite");
  switch (part.kind) {
    case ConvexPart::Kind::box:
      return make_box(part, owner, polyhedra);
    case ConvexPart::Kind::sphere:
      return make_sphere(part, owner);
    case ConvexPart::Kind::hull:
      return make_hull(part, owner, polyhedra);
  }
  refuse(owner, part, "its kind is none of box, sphere, hull");
}

double thickness_of(const btConvexShape& shape) {
  if (!shape.isPolyhedral()) return 2 * shape.getMargin();  // a sphere is all margin
  const btConvexPolyhedron* faces = static_cast<const btPolyhedralConvexShape&>(shape).getConvexPolyhedron();
  if (faces == nullptr) return 0;
  double thickness = BT_LARGE_FLOAT;
  for (int f = 0; f < faces->m_faces.size(); ++f) {
    const btScalar* plane = faces->m_faces[f].m_plane;  // unit outward normal and offset: n x + d = 0
    double across = 0;
    for (int v = 0; v < faces->m_vertices.size(); ++v) {
      const btVector3& vertex = faces->m_vertices[v];
      across = std::max<double>(across, -(btVector3(plane[0], plane[1], plane[2]).dot(vertex) + plane[3]));
    }
    thickness = std::min(thickness, across);
  }
  return thickness;
}

double reach_of(const SolidPart& part) {
  double reach = 0;
  for (const btVector3& corner : corners_of_bounds(part)) reach = std::max(reach, corner.length());
  return reach;
}

bool fills_frame(const SolidPart& part) { return part.local == btTransform::getIdentity(); }

void make_compound(Solid& solid) {
  if (solid.parts.size() == 1 && fills_frame(solid.parts.front())) return;
  solid.compound = std::make_unique<btCompoundShape>(true, static_cast<int>(solid.parts.size()));
  for (const SolidPart& part : solid.parts) solid.compound->addChildShape(part.local, part.shape.get());
}

}  // namespace

std::array<btVector3, 8> corners_of_bounds(const SolidPart& part) {
  btVector3 low, high;
  part.shape->getAabb(btTransform::getIdentity(), low, high);
  std::array<btVector3, 8> corners;
  for (std::size_t i = 0; i < corners.size(); ++i)
    corners[i] =
        part.local * btVector3(i & 1 ? low.x() : high.x(), i & 2 ? low.y() : high.y(), i & 4 ? low.z() : high.z());
  return corners;
}

std::optional<btTransform> frame_of_only_box(const std::vector<ConvexPart>& description) {
  constexpr double rounding = 1e-9;  // of the size: how far a box may lie off and count as lying about the origin
  if (description.size() != 1 || description[0].kind != ConvexPart::Kind::box) return {};
  const ConvexPart& only = description[0];
  if (!is_rotation(only.pose.orientation) || !(only.pose.position.norm() <= rounding * only.half_extents.minCoeff()))
    return {};
  return to_bullet(Pose{Vec3::Zero(), only.pose.orientation});
}

void make_parts(const std::vector<ConvexPart>& description, const std::string& owner, PolyhedronStore& polyhedra,
                Solid& solid) {
  const bool box_fills_frame = frame_of_only_box(description) == solid.frame;
  const btTransform frame = solid.frame.inverse();
  if (description.empty()) throw std::invalid_argument(owner + ": it has no part; at least one is needed");
  for (const ConvexPart& given : description) {
    SolidPart part;
    ConvexPart placed = given;
    if (given.kind == ConvexPart::Kind::hull) {
      // Its points take up the frame: a body of one hull is no compound then, which pairs cost several times as much.
      const btTransform place = frame * to_bullet(given.pose);
      for (Vec3& point : placed.points) point = from_bullet(place * to_bullet(point));
    } else if (!box_fills_frame) {
      part.local = frame * to_bullet(given.pose);
    }
    part.shape = make_shape(placed, owner, polyhedra);
    part.made_from = std::make_shared<const ConvexPart>(std::move(placed));
    part.tag = given.tag;
    part.reach = reach_of(part);
    part.thickness = thickness_of(*part.shape);
    solid.reach = std::max(solid.reach, part.reach);
    solid.parts.push_back(std::move(part));
  }
  make_compound(solid);
}

void make_shapes_again(PolyhedronStore& polyhedra, Solid& solid) {
  for (SolidPart& part : solid.parts) part.shape = make_shape(*part.made_from, "part", polyhedra);
  if (!solid.parts.empty()) make_compound(solid);
}

void take_features(const Solid& solid, const PolyhedronStore& from, PolyhedronStore& to) {
  for (const SolidPart& part : solid.parts)
    if (part.made_from->kind != ConvexPart::Kind::sphere) to.take(from, numbers_of(*part.made_from));
}

int nearest_part(const Solid& solid, const btTransform& pose, const btVector3& point) {
  int nearest = 0;
  double least = BT_LARGE_FLOAT;
  for (std::size_t i = 0; i < solid.parts.size(); ++i) {
    btVector3 low, high;
    solid.parts[i].shape->getAabb(pose * solid.parts[i].local, low, high);
    btVector3 inside = point;
    inside.setMax(low);
    inside.setMin(high);
    const double distance = (inside - point).length2();
    if (distance < least) {
      least = distance;
      nearest = static_cast<int>(i);
    }
  }
  return nearest;
}

}  // namespace topple::collision
