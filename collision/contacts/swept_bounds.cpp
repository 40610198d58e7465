#include "contacts/swept_bounds.h"

#include <algorithm>
#include <cmath>

namespace topple::collision {

Bounds swept_bounds(const SolidPart& part, const Motion& motion, double dt) {
  Bounds bounds, end;
  part.shape->getAabb(motion.start * part.local, bounds.low, bounds.high);
  part.shape->getAabb(motion.at(dt) * part.local, end.low, end.high);
  const double turn = std::min(SIMD_PI, motion.angular_velocity.length() * dt);
  const double out = part.reach * (1 - std::cos(turn / 2)) + motion.acceleration.length() * dt * dt / 8 + kSkin;
  bounds.low.setMin(end.low);
  bounds.high.setMax(end.high);
  bounds.low -= btVector3(out, out, out);
  bounds.high += btVector3(out, out, out);
  return bounds;
}

}  // namespace topple::collision
