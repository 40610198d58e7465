#pragma once
// What a person does, whether by hand in the window or by a script without one: camera, switches, shots, keys.
#include <optional>
#include <string>

#include "app/driver.h"
#include "app/open_scene.h"
#include "app/picking.h"
#include "app/show_words.h"
#include "renderer/camera.h"
#include "renderer/view_options.h"

namespace topple::viewer {

struct Shot {
  double speed = 60, mass = 500, radius = 0.4;  ///< m/s, kg, m
};

class Controller {
 public:
  Controller(Driver& driver, const Scene& scene, double ground, glm::dvec2 size);

  Camera camera;
  ViewOptions options;
  ModeView mode;
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
  /// Words of show_words.h. Throws structure::InputError.
  void show(const std::string& words);
  /// To be called before each picture: tells the driver what the view needs to know.
  void update();
  /// What to draw of a moment: with a mode in the view its shape, swinging with `seconds`; `wait`: until it is known.
  [[nodiscard]] Snapshot drawn(Snapshot moment, double seconds, bool wait);
  [[nodiscard]] ModeShapes& modes() { return modes_; }
  /// Marks what lies under the pointer.
  void hover(glm::dvec2 pixel);
  [[nodiscard]] const std::optional<Pick>& hovered() const { return hovered_; }
  void frame_building();

  [[nodiscard]] Driver& driver() { return driver_; }
  [[nodiscard]] const structure::Building& building() const { return building_; }

 private:
  Driver& driver_;
  const structure::Building& building_;
  ModeShapes modes_;
  Wanted wanted_;
  double ground_;
  glm::dvec2 size_;
  std::optional<Pick> hovered_;
};

}  // namespace topple::viewer
