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
