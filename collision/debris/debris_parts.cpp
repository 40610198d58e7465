#include "debris/debris_parts.h"

#include "bullet/bullet_types.h"

namespace topple::collision {

Placement DebrisObstacle::placement() const { return placement_of(to_bullet(pose) * frame); }

const DebrisObstacle* moving_obstacle(const NearPairs& pairs, const PairEnds& ends) {
  const Solid* const second = pairs.collider(ends.second).solid;
  if (second->kind != Touched::Kind::obstacle) return nullptr;
  const auto* const one = static_cast<const DebrisObstacle*>(second);
  return one->moves ? one : nullptr;
}

}  // namespace topple::collision
