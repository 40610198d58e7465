#pragma once
// Small worlds for the tests: boxes and balls of a given density.
#include <memory>

#include "topple/collision/world.h"

namespace collision_test {

using namespace topple::collision;

inline constexpr double kGravity = 9.81;
inline constexpr double kStep = 1.0 / 60;

inline ConvexPart box_part(const Vec3& half_extents, std::int64_t tag = 0, const Vec3& at = Vec3::Zero()) {
  ConvexPart part;
  part.kind = ConvexPart::Kind::box;
  part.half_extents = half_extents;
  part.tag = tag;
  part.pose.position = at;
  return part;
}

inline Mat3 box_inertia(double mass, const Vec3& half) {
  const Vec3 squared = half.cwiseProduct(half);
  return Vec3(squared.y() + squared.z(), squared.x() + squared.z(), squared.x() + squared.y()).asDiagonal() *
         Mat3::Identity() * (mass / 3);
}

inline BodyDescription box_body(const Vec3& half_extents, double mass, const Vec3& at) {
  BodyDescription body;
  body.parts = {box_part(half_extents)};
  body.mass = mass;
  body.inertia = box_inertia(mass, half_extents);
  body.pose.position = at;
  return body;
}

/// A convex prism: corners (x, z), anticlockwise seen from -y, and its width along y about y = 0. Where it is said to
/// be.
inline BodyDescription extruded(const std::vector<Eigen::Vector2d>& corners, double wide, double mass,
                                double friction) {
  double area = 0, xx = 0, zz = 0, xz = 0;
  Eigen::Vector2d centre(0, 0);
  const auto sum = [&](auto&& term) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Eigen::Vector2d &p = corners[i], &q = corners[(i + 1) % corners.size()];
      term(p, q, p.x() * q.y() - q.x() * p.y());
    }
  };
  sum([&](const auto& p, const auto& q, double cross) {
    area += cross / 2;
    centre += (p + q) * cross / 6;
  });
  centre /= area;
  sum([&](const auto& from, const auto& to, double) {
    const Eigen::Vector2d p = from - centre, q = to - centre, s = p + q;
    const double share = (p.x() * q.y() - q.x() * p.y()) / 24 * mass / area;
    xx += share * (p.x() * p.x() + q.x() * q.x() + s.x() * s.x());
    zz += share * (p.y() * p.y() + q.y() * q.y() + s.y() * s.y());
    xz += share * (p.x() * p.y() + q.x() * q.y() + s.x() * s.y());
  });
  const double yy = mass * wide * wide / 12;
  BodyDescription body;
  ConvexPart part;
  part.kind = ConvexPart::Kind::hull;
  part.tag = 0;
  for (const Eigen::Vector2d& corner : corners)
    for (const double side : {-wide / 2, wide / 2})
      part.points.emplace_back(corner.x() - centre.x(), side, corner.y() - centre.y());
  body.parts = {part};
  body.mass = mass;
  body.inertia << yy + zz, 0, -xz, 0, xx + zz, 0, -xz, 0, xx + yy;
  body.pose.position = Vec3(centre.x(), 0, centre.y());
  body.friction = friction;
  return body;
}

inline BodyDescription ball_body(double radius, double mass, const Vec3& at) {
  BodyDescription body;
  ConvexPart part;
  part.kind = ConvexPart::Kind::sphere;
  part.half_extents.x() = radius;
  part.tag = 0;
  body.parts = {part};
  body.mass = mass;
  body.inertia = 0.4 * mass * radius * radius * Mat3::Identity();
  body.pose.position = at;
  return body;
}

inline ObstacleDescription box_obstacle(const Vec3& half_extents, const Vec3& at, std::int64_t tag = 0) {
  ObstacleDescription obstacle;
  obstacle.parts = {box_part(half_extents, tag)};
  obstacle.pose.position = at;
  return obstacle;
}

inline std::unique_ptr<World> world_with_gravity() {
  auto world = make_bullet_world();
  world->set_gravity({0, 0, -kGravity});
  return world;
}

inline std::unique_ptr<World> world_with_ground(double friction = 0.6, double restitution = 0) {
  auto world = world_with_gravity();
  world->set_ground(0, friction, restitution);
  return world;
}

inline void run(World& world, int steps) {
  for (int i = 0; i < steps; ++i) world.step(kStep);
}

/// The stored velocity of a body that flies with `velocity` now: read at mid-step, free flight is exact.
inline Vec3 entering(const Vec3& velocity) { return velocity + Vec3(0, 0, kGravity * kStep / 2); }

}  // namespace collision_test
