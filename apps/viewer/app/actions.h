#pragma once
// Scripts of what a person would do, for runs without a window (docs: actions of topple-viewer).
#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "app/open_scene.h"
#include "app/session.h"
#include "app/tools/hand.h"
#include "renderer/camera.h"
#include "topple/structure/joint_tuning.h"

namespace topple::viewer {

struct CameraAction {
  Camera camera;
  double over = 0;  ///< s that the way there takes
};
/// An earthquake, computed or from a file.
struct ShakeAction {
  Shake shake;
};
struct ClickAction {
  glm::dvec2 pixel;
};
struct FireAction {
  glm::dvec2 pixel;
  Shot shot;
};
struct KeyAction {
  std::string key;
};
struct DragAction {
  glm::dvec2 from, to;
};
struct ShowAction {
  std::string what;
};
struct ScreenshotAction {
  std::string file;
};
struct PanAction {
  glm::dvec2 from, to;
};
struct ZoomAction {
  double clicks;  ///< of the wheel, nearer above 0
};
struct FlyAction {
  glm::dvec3 way;  ///< ahead, to the right, up; m
};
struct SelectAction {
  std::string name;
};
/// A tool taken in hand, with settings.
struct ToolAction {
  ToolKind kind;
  std::vector<std::pair<std::string, double>> settings;
};
void pick_up(const ToolAction& tool, Hand& hand);
struct GravityAction {
  double downwards;
};
struct LookAction {
  std::optional<double> time;  ///< none: the present
};
struct GoOnAction {};
/// The run begins anew by other rules: the scene's with these changes.
struct RestartAction {
  std::optional<structure::BracingRule> bracing;
  std::optional<structure::MechanismRule> mechanism;
  std::optional<double> sudden, cell;
  std::optional<bool> second_order;
  bool panels_stay_whole = false;
  std::optional<fracture::Method> fracture;
  std::vector<structure::MaterialChange> materials;
};
[[nodiscard]] RunRules rules_of(const RestartAction& restart, const Scene& scene);
struct SaveAction {
  std::string file;
};
struct LoadAction {
  std::string file;
};
struct ExportAction {
  std::string file;
};
struct QuitAction {};

struct Action {
  double at = 0;  ///< seconds since the start, pauses counted
  std::variant<CameraAction, ClickAction, FireAction, KeyAction, DragAction, PanAction, ZoomAction, FlyAction,
               SelectAction, ToolAction, GravityAction, ShakeAction, LookAction, GoOnAction, RestartAction, SaveAction,
               LoadAction, ExportAction, structure::JointChange, ShowAction, ScreenshotAction, QuitAction>
      what;
};
struct Script {
  std::optional<std::array<int, 2>> size;
  std::vector<Action> actions;  ///< in order of time; equal times in the file's order
};

/// Throws structure::InputError with file, place, what is wrong and what is accepted.
[[nodiscard]] Script read_script(const std::string& file);

}  // namespace topple::viewer
