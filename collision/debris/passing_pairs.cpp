#include "debris/passing_pairs.h"

#include <algorithm>
#include <limits>

#include "contacts/apart.h"
#include "debris/motion_ahead.h"

namespace topple::collision {

namespace {

/// Where contacts would be at the end of the step, as the solver has it: by planes, and arms as they are now.
struct Foreseen {
  Motion first, second;
  double least = std::numeric_limits<double>::infinity();  ///< m apart
  double clear = 0;                                        ///< m apart, with which none pushes
};

Foreseen foresee(const DebrisScene& scene, const PairEnds& ends, const Manifold& manifold, double dt) {
  const Solid &one = *scene.pairs.collider(ends.first).solid, &other = *scene.pairs.collider(ends.second).solid;
  Foreseen made{motion_ahead(one, scene.gravity, dt), motion_ahead(other, scene.gravity, dt)};
  const Placement &first_at = DebrisScene::placement(one), &second_at = DebrisScene::placement(other);
  const btVector3 normal = to_bullet(manifold.normal);
  for (int i = 0; i < manifold.count; ++i) {
    const ManifoldPoint& point = manifold.points[static_cast<std::size_t>(i)];
    const btVector3 place = to_bullet(Vec3((first_at * point.on_first + second_at * point.on_second) / 2));
    const btVector3 way = (made.first.point_velocity(place, 0) - made.second.point_velocity(place, 0)) * dt +
                          (made.first.acceleration - made.second.acceleration) * (dt * dt / 2);
    made.least = std::min(made.least, point.separation - way.dot(normal));
  }
  // Spins change within the step, by less than their squares.
  const double turned =
      made.first.angular_velocity.length2() * one.reach + made.second.angular_velocity.length2() * other.reach;
  made.clear = std::min(scene.settings.touching, manifold.nearest()) + dt * dt / 2 * turned;
  return made;
}

MovingPart part_ahead(const DebrisScene& scene, std::uint32_t collider, const Motion& motion, double dt) {
  const Collider& one = scene.pairs.collider(collider);
  return {static_cast<const TouchingSolid&>(*one.solid), static_cast<std::size_t>(one.part), motion,
          placement_of(motion.at(dt))};
}

/// As the sweep has it.
bool they_touch(const MovingPart& first, const MovingPart& second, double dt) {
  return meeting_of(first, second, dt, 0) == Meeting::unknown &&
         touches(first.solid.parts[first.part], first.motion, second.solid.parts[second.part], second.motion, dt);
}

/// The least that they could come to is asked first: few pairs are worth more.
bool may_come_to_push(const DebrisScene& scene, const PairEnds& ends, const Manifold& manifold) {
  if (!ends.touches || ends.second == NearPairs::ground) return false;
  const double nearest = manifold.nearest(), touching = scene.settings.touching,
               way = scene.pairs.collider(ends.first).way + scene.pairs.collider(ends.second).way;
  return nearest > 0 && !(nearest <= touching && manifold.bears()) && nearest - way < touching;
}

}  // namespace

void clear_if_passing(DebrisScene& scene, std::uint32_t pair, double dt) {
  const PairEnds& ends = scene.pairs.ends(pair);
  Manifold& manifold = scene.pairs.pair(pair).manifold;
  if (!may_come_to_push(scene, ends, manifold)) return;
  const Foreseen then = foresee(scene, ends, manifold, dt);
  if (!(then.least < then.clear)) return;
  if (they_touch(part_ahead(scene, ends.first, then.first, dt), part_ahead(scene, ends.second, then.second, dt), dt))
    return;
  for (int i = 0; i < manifold.count; ++i)
    manifold.points[static_cast<std::size_t>(i)].separation += then.clear - then.least;
}

}  // namespace topple::collision
