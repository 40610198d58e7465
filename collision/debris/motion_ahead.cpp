#include "debris/motion_ahead.h"

namespace topple::collision {

btTransform transform_of(const Solid& solid) {
  const Placement& placed = static_cast<const TouchingSolid&>(solid).at;
  const Mat3& m = placed.turn;
  return btTransform(btMatrix3x3(m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)),
                     to_bullet(placed.position));
}

Motion motion_ahead(const DebrisBody& body, const Vec3& gravity, double dt) {
  Motion motion;
  motion.start = transform_of(body);
  if (body.asleep) return motion;
  // What lies is borne in this step as in the last: it does not fall upon what is near. What was struck falls on.
  const bool struck = body.acceleration.squaredNorm() > gravity.squaredNorm();
  const Vec3 acceleration = struck ? gravity : body.acceleration;
  motion.acceleration = to_bullet(acceleration);
  // Stored velocities are those of mid-step; they came from the middle of the last sub-step.
  const double substep = body.substep_rate > 0 ? 1 / body.substep_rate : 0;
  motion.velocity = to_bullet(body.velocity + gravity * (dt / 2) + (acceleration - gravity) * (substep / 2));
  motion.angular_velocity = to_bullet(body.spin);
  return motion;
}

Motion straight_on(const Solid& obstacle, const ObstaclePath& path) {
  Motion motion;
  motion.start = to_bullet(path.pose) * obstacle.frame;
  const Vec3 arm = from_bullet(motion.start.getOrigin()) - path.pose.position;
  motion.velocity = to_bullet(Vec3(path.velocity + path.angular_velocity.cross(arm)));
  motion.angular_velocity = to_bullet(path.angular_velocity);
  return motion;
}

Motion motion_ahead(const Solid& solid, const Vec3& gravity, double dt) {
  if (solid.kind == Touched::Kind::body) return motion_ahead(static_cast<const DebrisBody&>(solid), gravity, dt);
  if (solid.kind == Touched::Kind::obstacle)
    if (const auto& one = static_cast<const DebrisObstacle&>(solid); one.moves)
      return straight_on(one, one.motion.path());
  Motion still;
  still.start = transform_of(solid);
  return still;
}

}  // namespace topple::collision
