#include "renderer/frame_composer.h"

#include <stdexcept>

namespace topple::viewer {

void copy_scene(const Renderer& scene, unsigned framebuffer, glm::ivec2 size) {
  const glm::ivec2 part = scene.size();
  glBindFramebuffer(GL_READ_FRAMEBUFFER, scene.framebuffer());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  glBlitFramebuffer(0, 0, part.x, part.y, 0, size.y - part.y, part.x, size.y, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, size.x, size.y);
}

FrameComposer::FrameComposer(glm::ivec2 size)
    : size_(size),
      colour_(make_gl<GlTexture>([](GLsizei n, GLuint* names) { glGenTextures(n, names); })),
      framebuffer_(make_framebuffer()) {
  glBindTexture(GL_TEXTURE_2D, colour_.get());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, size.x, size.y, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glBindTexture(GL_TEXTURE_2D, 0);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour_.get(), 0);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("the graphics driver refuses a picture of this size");
}

void FrameComposer::begin(const Renderer& scene) const { copy_scene(scene, framebuffer_.get(), size_); }

Image FrameComposer::read() const { return read_framebuffer(framebuffer_.get(), size_); }

}  // namespace topple::viewer
