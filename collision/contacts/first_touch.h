#pragma once
// When and where two moving convex parts first touch: conservative advancement (Mirtich 1996, "Impulse-based dynamic
// simulation of rigid body systems", 2.3) with distances by GJK, on ballistic paths with a constant angular velocity.
#include <optional>

#include "shapes/solid.h"

namespace topple::collision {

/// The path of a solid's Bullet frame from now: x + v t + g t2/2, turned by w t.
struct Motion {
  btTransform start = btTransform::getIdentity();
  btVector3 velocity{0, 0, 0}, acceleration{0, 0, 0}, angular_velocity{0, 0, 0};

  [[nodiscard]] btTransform at(double time) const;
  [[nodiscard]] btVector3 origin(double time) const;
  [[nodiscard]] btVector3 velocity_at(double time) const { return velocity + acceleration * time; }
  /// Of the material point that is at `point` (global) at that time.
  [[nodiscard]] btVector3 point_velocity(const btVector3& point, double time) const;
};

struct Touch {
  double time = 0;
  btVector3 normal{0, 0, 0};  ///< from the first part into the second
  btVector3 point{0, 0, 0};   ///< centre of the area of contact
  double approach_speed = 0;  ///< of the corner that closes fastest
  int corner_count = 0;
  btVector3 corners[4];
};

/// First time within `duration` at which the parts are as near as the tolerance of contact while closing; parts that
/// overlap from the start touch at time 0 when they close.
[[nodiscard]] std::optional<Touch> first_touch(const SolidPart& first, const Motion& first_motion,
                                               const SolidPart& second, const Motion& second_motion, double duration);
/// Whether there is one.
[[nodiscard]] bool touches(const SolidPart& first, const Motion& first_motion, const SolidPart& second,
                           const Motion& second_motion, double duration);
/// The same against the half space below z = height.
[[nodiscard]] std::optional<Touch> first_touch_of_ground(const SolidPart& part, const Motion& motion, double height,
                                                         double duration);
/// Distance between two parts, negative when they overlap.
[[nodiscard]] double distance(const SolidPart& first, const btTransform& first_pose, const SolidPart& second,
                              const btTransform& second_pose);

/// Lowest point and all vertices of a part within `band` of it (a sphere has the one).
struct LowestPoints {
  double height = 0;
  btAlignedObjectArray<btVector3> points;
};
[[nodiscard]] LowestPoints lowest_points(const SolidPart& part, const btTransform& pose, double band);

}  // namespace topple::collision
