#pragma once
// The sun, and the matrices of its shadow map.
#include <glm/vec3.hpp>

#include "renderer/camera.h"
#include "renderer/shaders.h"

namespace topple::viewer {

inline constexpr glm::vec3 to_sun{-0.34F, -0.56F, 0.75F};
inline constexpr int shadow_size = 2048;

/// Layers of the shadow map: the last holds all that is drawn (within `reach` of the origin), those before a third and
/// a ninth of that around where the eye looks. One more looks straight down.
void set_light_matrices(PictureBlock& picture, const Camera& camera, const glm::dvec3& origin, float reach);

}  // namespace topple::viewer
