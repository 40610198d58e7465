#pragma once
#include <optional>
#include <string>
#include <vector>

#include "app/open_scene.h"

namespace topple::viewer {

struct WindowOptions {
  int width = 1600, height = 900;
  std::string screenshot = "topple.png";  ///< where key P writes
  std::vector<std::string> show;          ///< words of show_words.h
  bool sound = true;                      ///< where the machine has a device
  double scale = 1;                       ///< of the panels' text, beside that of the display
};

/// Opens a window on the scene, or on the start page where there is none, and returns when it is closed. Throws
/// std::runtime_error with one line when no window can be opened.
void run_window(std::optional<Scene> scene, const WindowOptions& options);

}  // namespace topple::viewer
