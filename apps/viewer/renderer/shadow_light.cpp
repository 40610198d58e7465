#include "renderer/shadow_light.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "renderer/render_targets.h"

namespace topple::viewer {
namespace {

/// A square of half this width around a place, seen from the sun; everything within `all` of the origin casts into it.
/// It moves by whole texels, so that shadows do not swim when the eye does.
glm::mat4 light_matrix(glm::vec3 centre, float half, float all) {
  const glm::vec3 sun = glm::normalize(to_sun);
  const glm::mat4 turned = glm::lookAt(sun, glm::vec3(0), glm::vec3(0, 0, 1));
  const float texel = 2 * half / shadow_size;
  const glm::vec3 at = glm::vec3(turned * glm::vec4(centre, 1));
  const glm::vec2 middle = glm::floor(glm::vec2(at) / texel) * texel;
  return glm::ortho(middle.x - half, middle.x + half, middle.y - half, middle.y + half, -2 * all, 2 * all) * turned;
}

}  // namespace

void set_light_matrices(PictureBlock& picture, const Camera& camera, const glm::dvec3& origin, float reach) {
  const glm::vec3 eye(camera.eye - origin), ahead(camera.forward());
  float half = reach;
  for (int k = ShadowMap::cascades - 1; k >= 0; --k, half /= 3) {
    const bool last = k == ShadowMap::cascades - 1;
    // What is near the eye in the picture, as far as the layer reaches.
    const float way = std::min(static_cast<float>(camera.distance()), 1.2F * half);
    const glm::vec3 centre = last ? glm::vec3(0) : eye + way * ahead;
    picture.light[k] = light_matrix(centre, half, 2 * reach);
    picture.reaches[k] = half;
    picture.texels[k] = 2 * half / shadow_size;
  }
  // What is straight above: how much of the sky a place sees.
  const glm::mat4 down = glm::lookAt(glm::vec3(0, 0, 1), glm::vec3(0), glm::vec3(0, 1, 0));
  picture.light[ShadowMap::cascades] = glm::ortho(-reach, reach, -reach, reach, -2 * reach, 2 * reach) * down;
}

}  // namespace topple::viewer
