#include "renderer/render_targets.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace topple::viewer {
namespace {

constexpr int wanted_samples = 4;

void check(const std::string& what) {
  const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("the graphics driver refuses the " + what + " (status " + std::to_string(status) + ")");
}

GlTexture texture_2d(GLint internal, GLenum format, GLenum type, glm::ivec2 size, GLint filter) {
  GlTexture result = make_texture();
  glBindTexture(GL_TEXTURE_2D, result.get());
  glTexImage2D(GL_TEXTURE_2D, 0, internal, size.x, size.y, 0, format, type, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return result;
}

Target target(const std::string& what, GLint internal, GLenum format, GLenum type, glm::ivec2 size, bool with_depth) {
  Target result;
  result.framebuffer = make_framebuffer();
  glBindFramebuffer(GL_FRAMEBUFFER, result.framebuffer.get());
  result.colour = texture_2d(internal, format, type, size, GL_LINEAR);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, result.colour.get(), 0);
  if (with_depth) {
    result.depth = texture_2d(GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, size, GL_NEAREST);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, result.depth.get(), 0);
  }
  check(what);
  return result;
}

GlRenderbuffer multisampled_buffer(GLenum format, GLenum attachment, glm::ivec2 size, int samples) {
  GlRenderbuffer result = make_renderbuffer();
  glBindRenderbuffer(GL_RENDERBUFFER, result.get());
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, size.x, size.y);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, result.get());
  return result;
}

}  // namespace

void RenderTargets::resize(glm::ivec2 size) {
  size = glm::ivec2(std::max(size.x, 1), std::max(size.y, 1));
  if (size == size_) return;
  GLint most = 0;
  glGetIntegerv(GL_MAX_SAMPLES, &most);
  multisampled_ = make_framebuffer();
  glBindFramebuffer(GL_FRAMEBUFFER, multisampled_.get());
  const int samples = std::min<int>(wanted_samples, most);
  multisampled_colour_ = multisampled_buffer(GL_RGBA16F, GL_COLOR_ATTACHMENT0, size, samples);
  multisampled_depth_ = multisampled_buffer(GL_DEPTH_COMPONENT24, GL_DEPTH_ATTACHMENT, size, samples);
  check("multisampled picture");
  resolved_ = target("resolved picture", GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT, size, true);
  const glm::ivec2 half = glm::ivec2((size.x + 1) / 2, (size.y + 1) / 2);
  occlusion_ = target("occlusion map", GL_R8, GL_RED, GL_UNSIGNED_BYTE, half, false);
  finished_ = target("finished picture", GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, size, false);
  size_ = size;
  for (Target& one : glow_)
    one = target("glow of what is bright", GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT, glow_size(), false);
}

void RenderTargets::resolve() const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, multisampled_.get());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_.framebuffer.get());
  glBlitFramebuffer(0, 0, size_.x, size_.y, 0, 0, size_.x, size_.y, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT,
                    GL_NEAREST);
}

void RenderTargets::resolve_depth() const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, multisampled_.get());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_.framebuffer.get());
  glBlitFramebuffer(0, 0, size_.x, size_.y, 0, 0, size_.x, size_.y, GL_DEPTH_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, multisampled_.get());
}

ShadowMap::ShadowMap(int size) : size_(size), texture_(make_texture()) {
  glBindTexture(GL_TEXTURE_2D_ARRAY, texture_.get());
  glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_DEPTH_COMPONENT24, size, size, layers, 0, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT,
               nullptr);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTexParameteri(GL_TEXTURE_2D_ARRAY, filter, GL_LINEAR);
  for (const GLenum way : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    glTexParameteri(GL_TEXTURE_2D_ARRAY, way, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  for (int layer = 0; layer < layers; ++layer) {
    GlFramebuffer& framebuffer = framebuffers_[static_cast<std::size_t>(layer)];
    framebuffer = make_framebuffer();
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.get());
    glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, texture_.get(), 0, layer);
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
    check("shadow map");
  }
}

}  // namespace topple::viewer
