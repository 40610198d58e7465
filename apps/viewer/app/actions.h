#pragma once
// Scripts of what a person would do, for runs without a window (docs: actions of topple-viewer).
#include <array>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "app/controller.h"
#include "topple/structure/joint_tuning.h"

namespace topple::viewer {

struct CameraAction {
  Camera camera;
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
struct QuitAction {};

struct Action {
  double at = 0;  ///< seconds since the start, pauses counted
  std::variant<CameraAction, ClickAction, FireAction, KeyAction, DragAction, structure::JointChange, ShowAction,
               ScreenshotAction, QuitAction>
      what;
};
struct Script {
  std::optional<std::array<int, 2>> size;
  std::vector<Action> actions;  ///< in order of time; equal times in the file's order
};

/// Throws structure::InputError with file, place, what is wrong and what is accepted.
[[nodiscard]] Script read_script(const std::string& file);

}  // namespace topple::viewer
