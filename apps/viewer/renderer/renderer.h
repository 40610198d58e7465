#pragma once
// Draws a building and its debris into a framebuffer object, with whatever OpenGL 3.3 context is current: a window's or
// a headless one.
#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <string>
#include <vector>

#include "renderer/camera.h"
#include "renderer/instances/scene_instances.h"
#include "renderer/shapes/overlay.h"
#include "renderer/view_options.h"

namespace topple::viewer {

/// 8-bit RGBA, upper row first.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;
  [[nodiscard]] const std::uint8_t* at(int x, int y) const {
    return pixels.data() +
           4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  }
};
/// Throws std::runtime_error when the file cannot be written.
void write_png(const Image& image, const std::string& file);

/// Of a framebuffer with a colour of 8-bit RGBA.
[[nodiscard]] Image read_framebuffer(unsigned framebuffer, glm::ivec2 size);

class Renderer {
 public:
  /// `ground`: its height. Throws std::runtime_error when the context is too old or the driver refuses something.
  Renderer(const SceneInstances& scene, double ground);
  ~Renderer();

  /// Draws into the framebuffer of its own.
  void draw(const SceneInstances& scene, const Camera& camera, const ViewOptions& options, glm::ivec2 size,
            const Overlay& overlay = {});
  /// Framebuffer with the finished picture, and its size.
  [[nodiscard]] unsigned framebuffer() const;
  [[nodiscard]] glm::ivec2 size() const;
  /// What the graphics card took for a picture, some pictures ago; 0 before one is finished.
  [[nodiscard]] double graphics_milliseconds() const;
  [[nodiscard]] Image read() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace topple::viewer
