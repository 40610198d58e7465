#pragma once
// What a person does, whether by hand in the window or by a script without one: camera, switches, tools, keys.
#include <optional>
#include <string>
#include <vector>

#include "app/driver.h"
#include "app/mode_shapes.h"
#include "app/open_scene.h"
#include "app/output/run_files.h"
#include "app/picking.h"
#include "app/playback/camera_path.h"
#include "app/playback/playback.h"
#include "app/show_words.h"
#include "app/tools/hand.h"
#include "app/window_state.h"
#include "renderer/camera.h"
#include "renderer/view_options.h"

namespace topple::viewer {

class Controller {
 public:
  Controller(Driver& driver, const Scene& scene, double ground, glm::dvec2 size);

  Camera camera;
  ViewOptions options;
  ModeView mode;
  Hand hand;
  WindowState window;
  std::optional<std::string> message;  ///< for the person, one line

  void resize(glm::dvec2 size) { size_ = size; }
  [[nodiscard]] glm::dvec2 size() const { return size_; }
  /// Uses the tool in hand on what is seen at the pixel.
  void click(glm::dvec2 pixel);
  /// A projectile from the eye that meets what is seen at the pixel (gravity allowed for); along the view when nothing
  /// is.
  void fire(glm::dvec2 pixel);
  void drag(glm::dvec2 from, glm::dvec2 to);  ///< orbits
  void drag_to_pan(glm::dvec2 from, glm::dvec2 to);
  void scroll(double clicks);
  /// The keys of key_help(), as their letters and "space". False when the key has no meaning.
  bool key(const std::string& name);
  [[nodiscard]] static const char* key_help();
  /// All of them, in the order of their names.
  [[nodiscard]] static std::vector<std::string> key_names();
  /// Words of show_words.h. Throws structure::InputError.
  void show(const std::string& words);
  void set_gravity(double downwards);  ///< m/s2
  /// The ground shakes, by Hand::shaking. Throws structure::InputError for a file that is none of accelerations.
  void shake();
  /// Glides to another place in this time, s.
  void glide(const Camera& to, double over);
  /// Changes capacities; seen at once. Throws structure::InputError.
  void tune(const structure::JointChange& change);
  /// Starts the run again by other rules. Throws structure::InputError when the building cannot be run by them; then
  /// the run goes on.
  void restart(const RunRules& rules);
  /// Marks what lies under the pointer.
  void hover(glm::dvec2 pixel);
  [[nodiscard]] const std::optional<Pick>& hovered() const { return hovered_; }
  void select(structure::JointId joint);
  void select(const Pick& pick);
  /// A joint, or the first of a member's or panel's. Throws structure::InputError when there is none of this name.
  void select(const std::string& name);
  /// Joints, members and panels whose name holds the text or matches it as a pattern, at most `most`; joints only when
  /// the text holds a colon.
  [[nodiscard]] std::vector<structure::JointId> search(const std::string& text, std::size_t most) const;
  /// Of several buildings, the one that the scenario's first ball flies at.
  void frame_building();
  /// Frames it seen along a direction (radians: to the right of +x from the side of -y, upwards).
  void view_from(double azimuth, double elevation);

  /// To be called before each picture: tells the driver what the view needs to know, and moves a replay on.
  void update(double seconds);
  /// What to draw: the present or the moment that is looked back at; with a mode in the view its shape. `wait`: until
  /// the mode is known.
  [[nodiscard]] Snapshot shown(bool wait);

  [[nodiscard]] Playback& playback() { return playback_; }
  [[nodiscard]] const Playback& playback() const { return playback_; }
  [[nodiscard]] CameraPath& path() { return path_; }
  [[nodiscard]] RunFiles& files() { return files_; }
  [[nodiscard]] Driver& driver() { return driver_; }
  [[nodiscard]] const Driver& driver() const { return driver_; }
  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const structure::Building& building() const { return building_; }
  [[nodiscard]] ModeShapes& modes() { return modes_; }
  [[nodiscard]] const structure::NameIndex& names() const { return names_; }

 private:
  /// What stood under the pointer and has come off is marked no more: the mark does not fly away with it.
  void leave_what_came_off(const Snapshot& moment);
  [[nodiscard]] std::optional<Pick> pick_at(glm::dvec2 pixel) const;

  Driver& driver_;
  const Scene& scene_;
  const structure::Building& building_;
  structure::NameIndex names_;
  ModeShapes modes_;
  Wanted wanted_;
  double ground_;
  glm::dvec2 size_;
  std::optional<Pick> hovered_;
  bool hovered_stood_ = false;
  double swing_ = 0;  ///< s, of a mode
  Playback playback_;
  CameraPath path_;
  RunFiles files_;
};

}  // namespace topple::viewer
