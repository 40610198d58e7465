#pragma once
// The panels' drawing with Dear ImGui: one context, on any OpenGL context, with or without a window.
#include <glm/vec2.hpp>

struct ImDrawData;

namespace topple::viewer {

class Interface {
 public:
  /// `scale`: pixels of the display for each unit of text size, 2 on a HiDPI display. Needs an OpenGL context.
  explicit Interface(float scale);
  ~Interface();
  Interface(const Interface&) = delete;
  Interface& operator=(const Interface&) = delete;

  /// The display has another scale now (the window was moved to another screen): fonts, sizes and spaces follow.
  /// Between two frames.
  void set_scale(float scale);
  [[nodiscard]] float scale() const { return scale_; }

  // Without a window: what a pointer does comes from here.
  void begin_frame(glm::dvec2 size, double seconds);
  void point(glm::dvec2 pixel);
  void press(bool down);
  /// True when the pointer is over a panel.
  [[nodiscard]] static bool captures_pointer();

  /// Draws what was laid out since the frame began into the framebuffer that is bound.
  static void end_frame();

 private:
  float scale_ = 1;
};

}  // namespace topple::viewer
