#pragma once
// What is drawn into: a multisampled picture in linear light, its resolved copy, the occlusion map, the finished
// picture.
#include <array>
#include <glm/vec2.hpp>

#include "renderer/gl_object.h"

namespace topple::viewer {

/// A colour texture with, if asked for, a depth texture.
struct Target {
  GlFramebuffer framebuffer;
  GlTexture colour, depth;
};

class RenderTargets {
 public:
  /// Makes all targets anew when the size changed. Throws std::runtime_error when the driver cannot.
  void resize(glm::ivec2 size);
  [[nodiscard]] glm::ivec2 size() const { return size_; }
  [[nodiscard]] GLuint multisampled() const { return multisampled_.get(); }
  [[nodiscard]] const Target& resolved() const { return resolved_; }
  [[nodiscard]] const Target& occlusion() const { return occlusion_; }
  [[nodiscard]] const Target& finished() const { return finished_; }
  /// What is brighter than white, a quarter as wide and high, in two copies for blurring.
  [[nodiscard]] const Target& glow(int copy) const { return glow_[static_cast<std::size_t>(copy)]; }
  [[nodiscard]] glm::ivec2 glow_size() const { return (size_ + 3) / 4; }
  /// Copies the multisampled picture into the resolved one.
  void resolve() const;
  /// Its depths alone, so that what is blended may read them.
  void resolve_depth() const;

 private:
  glm::ivec2 size_{0};
  GlFramebuffer multisampled_;
  GlRenderbuffer multisampled_colour_, multisampled_depth_;
  Target resolved_, occlusion_, finished_;
  std::array<Target, 2> glow_;
};

/// Depths seen from the sun, compared in hardware: one layer for each cascade; and from straight above.
class ShadowMap {
 public:
  static constexpr int layers = 4, cascades = 3;  ///< the last looks straight down
  explicit ShadowMap(int size);
  [[nodiscard]] GLuint framebuffer(int layer) const { return framebuffers_[static_cast<std::size_t>(layer)].get(); }
  [[nodiscard]] GLuint texture() const { return texture_.get(); }
  [[nodiscard]] int size() const { return size_; }

 private:
  int size_;
  GlTexture texture_;
  std::array<GlFramebuffer, layers> framebuffers_;
};

}  // namespace topple::viewer
