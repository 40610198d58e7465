#pragma once
// Bullet's own contact solver behind collision::World: for comparison.
#include "topple/collision/world.h"

namespace topple::collision {

/// Sequential impulses, deterministic order. Throws like make_bullet_world().
[[nodiscard]] std::unique_ptr<World> make_sequential_impulse_world();

}  // namespace topple::collision
