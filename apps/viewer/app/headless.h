#pragma once
// Runs without a window: a picture at a time, a sequence of them, a script of actions.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "app/open_scene.h"

namespace topple::viewer {

struct HeadlessOptions {
  std::optional<std::string> screenshot, record, actions, video, sound, replay, usd, gltf, model, save, load;
  std::vector<std::string> show;  ///< words of show_words.h, before the first picture
  double at = 0;                  ///< s, of the screenshot, and end of a recording
  std::optional<std::array<int, 2>> size;
  double rate = 30;    ///< recorded pictures for each simulated second
  bool panel = false;  ///< the panels as well, which clicks and drags then reach
  double scale = 1;    ///< of the panels' text
};

/// Throws structure::InputError for a bad script, std::runtime_error when a picture cannot be drawn or written.
void run_headless(const Scene& scene, const HeadlessOptions& options);

}  // namespace topple::viewer
