#pragma once
// A picture of the whole window without one: the scene in the upper left, panels around it.
#include <glm/vec2.hpp>

#include "renderer/gl_object.h"
#include "renderer/renderer.h"

namespace topple::viewer {

class FrameComposer {
 public:
  explicit FrameComposer(glm::ivec2 size);
  /// Puts the scene's picture into the upper left and leaves the framebuffer bound, for the panels.
  void begin(const Renderer& scene) const;
  [[nodiscard]] Image read() const;

 private:
  glm::ivec2 size_;
  GlTexture colour_;
  GlFramebuffer framebuffer_;
};

/// Copies the scene's picture to the upper left of a framebuffer of this size (0: the window's), and leaves that bound.
void copy_scene(const Renderer& scene, unsigned framebuffer, glm::ivec2 size);

}  // namespace topple::viewer
