#pragma once
// What a person does, whether by hand in the window or by a script without one: camera, switches, tools, keys, looking
// back.
#include <functional>
#include <future>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/driver.h"
#include "app/mode_shapes.h"
#include "app/open_scene.h"
#include "app/picking.h"
#include "app/show_words.h"
#include "renderer/camera.h"
#include "renderer/view_options.h"

namespace topple::viewer {

struct Shot {
  double speed = 60, mass = 500, radius = 0.4;  ///< m/s, kg, m
};
/// A ball on a cable that swings into what is clicked on: let go with the cable taut, at this angle from straight down.
struct Swing {
  double cable = 12, angle = 1.2;  ///< m; rad, up to a quarter turn
  double mass = 5000, radius = 0.9;
};
/// A fire around what is clicked on: what is left of the joints' strength and of the members' stiffness at its end.
struct Burning {
  double reach = 4, over = 30;  ///< m; s
  double strength = 0.15, stiffness = 0.2;
};
inline constexpr int burning_stages = 10;

/// A rope from what is clicked on to a winch on the ground, on the side of the eye.
struct Hauling {
  double force = 500e3, over = 5;  ///< N; s
};
/// What shakes the ground: a file of its accelerations, or where there is none, a computed motion.
struct Shake {
  double peak = 5, over = 12;  ///< m/s2; s
  std::string file;            ///< as `topple analyse --time-history` reads it
};

/// What a click does.
enum class ToolKind { fire, swing, cut, remove, support, charge, explosion, burn, thermite, hook, path, select };
inline constexpr std::array<const char*, 12> tool_names{"fire",           "wrecking ball", "cut joint", "remove part",
                                                        "remove support", "charge",        "explosion", "burn",
                                                        "thermite",       "hook",          "load path", "select"};

class Controller {
 public:
  Controller(Driver& driver, const Scene& scene, double ground, glm::dvec2 size);

  Camera camera;
  ViewOptions options;
  ModeView mode;
  Shot shot;
  Swing swing;
  Burning burning;
  Hauling hauling;
  Shake shaking;
  ToolKind tool = ToolKind::fire;
  double charge_radius = 6;      ///< m; within it joints lose strength, all of it at the centre
  double explosive = 20;         ///< kg of TNT
  double thermite_over = 6;      ///< s, until a joint is through
  double picture_graphics = 0;   ///< ms that the graphics card took for a picture lately
  double picture_processor = 0;  ///< ms of processor time that the last picture took on the window's thread
  double volume = 0.8;           ///< of the sound, 0 to 1
  bool has_sound = false;        ///< the window found a device
  bool panels_wanted = false;    ///< the keyboard goes to the panels with the next picture
  bool photo = false;            ///< without the panels
  bool help = false;
  bool asks_to_leave = false;          ///< a person is asked whether the program is to end
  bool leaves = false;                 ///< and has said so
  bool wants_another = false;          ///< scene, from the start page
  std::optional<std::string> message;  ///< for the person, one line
  /// Files that pictures are to be written to (outputs.h); empty: none is wanted.
  std::string picture_wanted, sequence_wanted;

  void resize(glm::dvec2 size) { size_ = size; }
  [[nodiscard]] glm::dvec2 size() const { return size_; }
  /// Uses the tool in hand on what is seen at the pixel.
  void click(glm::dvec2 pixel);
  /// A projectile from the eye that meets what is seen at the pixel (gravity allowed for); along the view when nothing
  /// is.
  void fire(glm::dvec2 pixel);
  /// Writes the moment of the run, or takes the run up again where such a file was written. Throw
  /// structure::InputError, std::runtime_error.
  void save(const std::string& file);
  void load(const std::string& file);
  /// Writes the run so far for other programs, by the file's ending: .html, .usda or .glb. The simulation waits for it,
  /// drawing does not; `message` tells when it is there. Throws structure::InputError for another ending.
  void export_run(const std::string& file);
  /// Waits for what is being exported. Throws what went wrong.
  void finish_export();
  void drag(glm::dvec2 from, glm::dvec2 to);  ///< orbits
  void drag_to_pan(glm::dvec2 from, glm::dvec2 to);
  void scroll(double clicks);
  /// The keys of key_help(), as their letters and "space". False when the key has no meaning.
  bool key(const std::string& name);
  [[nodiscard]] static const char* key_help();
  [[nodiscard]] std::map<std::string, std::function<void()>> key_meanings();
  /// Words of show_words.h. Throws structure::InputError.
  void show(const std::string& words);
  void set_gravity(double downwards);  ///< m/s2
  /// The ground shakes, by `shaking`. Throws structure::InputError for a file that is none of accelerations.
  void shake();
  /// A point of the camera's path; the flight through them all, at an even pace.
  void add_view() { views_.push_back(camera); }
  void fly_path();
  /// Glides to another place in this time, s.
  void glide(const Camera& to, double over);
  [[nodiscard]] std::size_t views() const { return views_.size(); }
  [[nodiscard]] bool flying() const { return flight_.has_value(); }
  void forget_views() { views_.clear(), flight_.reset(); }
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

  // Looking back at what has been recorded.
  void look_at(double time);  ///< the simulation pauses
  /// From what is looked at, within what was recorded; beyond its end is the present.
  void look_along(double seconds);
  static constexpr double look_step = 0.25;  ///< s, of a key
  void look_at_present();
  void replay(bool on) { replaying_ = on; }
  [[nodiscard]] bool replaying() const { return replaying_; }
  [[nodiscard]] const std::optional<double>& looking_at() const { return looking_at_; }
  /// The run goes on from the moment that is looked at; what came after it is forgotten.
  void go_on_from_here();

  [[nodiscard]] Driver& driver() { return driver_; }
  [[nodiscard]] const Driver& driver() const { return driver_; }
  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const structure::Building& building() const { return building_; }
  [[nodiscard]] ModeShapes& modes() { return modes_; }
  [[nodiscard]] const structure::NameIndex& names() const { return names_; }

 private:
  [[nodiscard]] Snapshot now() const;
  /// What stood under the pointer and has come off is marked no more: the mark does not fly away with it.
  void leave_what_came_off(const Snapshot& moment);
  [[nodiscard]] std::optional<Pick> pick_at(glm::dvec2 pixel) const;
  void use(const Pick& pick);
  void remove_support_at(const Pick& pick);
  void swing_at(const Pick& pick);
  void burn_at(const Pick& pick);
  void explode_at(const Pick& pick);
  void pull_at(const Pick& pick);
  void fly_on(double seconds);
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
  std::optional<double> looking_at_;
  bool replaying_ = false;
  std::future<std::string> exporting_;  ///< the file, when it is whole
  double swing_ = 0;                    ///< s, of a mode
  /// A flight of the eye: through which places, how long each leg takes, how long it has gone on (s).
  struct Flight {
    std::vector<Camera> views;
    double leg = 0, gone = 0;
  };
  std::vector<Camera> views_;
  std::optional<Flight> flight_;
};

}  // namespace topple::viewer
