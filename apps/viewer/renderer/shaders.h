#pragma once
// Compiled programs. Sources are in shaders.cpp; all share one block of per-picture values.
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <string>

#include "renderer/gl_object.h"

namespace topple::viewer {

/// std140 block `Picture` of every program.
struct PictureBlock {
  glm::mat4 view_projection, inverse_view_projection;
  glm::mat4
      light[4];   ///< scene to the clip space of the shadow map's layers: the sun's, the nearest first, and from above
  glm::vec4 eye;  ///< xyz; w: height of the ground
  glm::vec4 sun;  ///< xyz: towards the sun; w: 1 with shadows
  glm::vec4 sizes;    ///< scene radius, grid spacing (0: none), free, colour fade length
  glm::vec4 picture;  ///< width, height (pixels), near, far
  glm::vec4 mode;     ///< x: 1 when members blend from end to end; y: ambient occlusion; z: its radius in the scene; w:
                      ///< share of even light
  glm::vec4 opacity;  ///< x: panels of this draw; y: 1 in the view of materials; z: layer of the shadow map being
                      ///< drawn; w: 1 while glass is drawn, and nothing else
  glm::vec4 reaches, texels;  ///< of the layers: half their width, width of a texel, in the scene
  glm::vec4 plot;             ///< half of what the building covers, x and y; time, s; free
};

struct Programs {
  GlProgram member, member_shadow, panel, panel_shadow, rigid, rigid_shadow;
  GlProgram sky, ground, line, dust, occlusion, bright, blur, finish;
  Programs();  ///< throws std::runtime_error with the compiler's log
};

inline constexpr GLuint picture_binding = 0;
/// Texture units.
inline constexpr GLint shadow_unit = 0, colour_unit = 1, depth_unit = 2, occlusion_unit = 3, glow_unit = 4;

}  // namespace topple::viewer
