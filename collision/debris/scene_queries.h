#pragma once
// Queries of a debris scene: rays, and the obstacles within a box.
#include <optional>
#include <vector>

#include "debris/debris_scene.h"

namespace topple::collision {

/// As World's of the same names.
[[nodiscard]] std::optional<RayHit> ray_cast(const DebrisScene& scene, const Vec3& from, const Vec3& to);
[[nodiscard]] std::vector<ObstacleId> obstacles_in(const DebrisScene& scene, const Vec3& low, const Vec3& high);

}  // namespace topple::collision
