#pragma once
// What scripts and the command line call the views: "joints", "moment_y", "diagram moment_y", "vibration 2" ...
#include <optional>
#include <string>

#include "app/mode_shapes.h"
#include "renderer/view_options.h"

namespace topple::viewer {

/// Which mode is drawn, if any.
struct ModeView {
  std::optional<ModeKind> kind;
  int number = 0;   ///< from 0
  float scale = 1;  ///< 1: the largest translation is a twentieth of the building's radius
};

/// Applies words to the view. Throws structure::InputError that names the accepted ones.
void show(const std::string& words, ViewOptions& options, ModeView& mode);

}  // namespace topple::viewer
