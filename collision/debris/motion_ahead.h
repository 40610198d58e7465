#pragma once
// Where solids go within a step if nothing touches them.
#include "contacts/first_touch.h"
#include "debris/debris_scene.h"

namespace topple::collision {

/// A body's path through `dt` as it moves now; of one that sleeps, where it is.
[[nodiscard]] Motion motion_ahead(const DebrisBody& body, const Vec3& gravity, double dt);
/// Over a part of a step an obstacle goes on as it does.
[[nodiscard]] Motion straight_on(const Solid& obstacle, const ObstaclePath& path);
/// Of any solid, as the world has it.
[[nodiscard]] Motion motion_ahead(const Solid& solid, const Vec3& gravity, double dt);
/// Its frame as a transform.
[[nodiscard]] btTransform transform_of(const Solid& solid);

}  // namespace topple::collision
