#pragma once
// What a person does, whether by hand in the window or by a script without one: camera, switches, shots, keys.
#include <optional>
#include <string>

#include "app/driver.h"
#include "app/picking.h"
#include "renderer/camera.h"
#include "renderer/view_options.h"

namespace topple::viewer {

struct Shot {
  double speed = 60, mass = 500, radius = 0.4;  ///< m/s, kg, m
};

class Controller {
 public:
  Controller(Driver& driver, const structure::Building& building, double ground, glm::dvec2 size);

  Camera camera;
  ViewOptions options;
  Shot shot;
  bool help = false;
  std::optional<std::string> message;  ///< for the person, one line

  void resize(glm::dvec2 size) { size_ = size; }
  [[nodiscard]] glm::dvec2 size() const { return size_; }
  /// A projectile from the eye that meets what is seen at the pixel (gravity allowed for); along the view when nothing
  /// is.
  void fire(glm::dvec2 pixel);
  void drag(glm::dvec2 from, glm::dvec2 to);  ///< orbits
  void drag_to_pan(glm::dvec2 from, glm::dvec2 to);
  void scroll(double clicks);
  /// "space" pause, "n" single step, "r" restart, "u" undo, "f" frame, "c" colouring, "1" to "4" posts, beams, slabs,
  /// walls, "h" help. False when the key has no meaning.
  bool key(const std::string& name);
  /// "joints", "plain", "utilisation", a sense's or a component's name. False when there is no such view.
  bool show(const std::string& what);
  /// Marks what lies under the pointer.
  void hover(glm::dvec2 pixel);
  [[nodiscard]] const std::optional<Pick>& hovered() const { return hovered_; }
  void frame_building();

  [[nodiscard]] Driver& driver() { return driver_; }
  [[nodiscard]] const structure::Building& building() const { return building_; }

 private:
  Driver& driver_;
  const structure::Building& building_;
  double ground_;
  glm::dvec2 size_;
  std::optional<Pick> hovered_;
};

}  // namespace topple::viewer
