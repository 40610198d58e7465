#pragma once
// A panel by itself, its way of breaking, and what hits it: the input of `topple fracture` (docs/fracture.md). SI.
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "topple/fracture/panel.h"

namespace topple::structure {

/// Something that hits the panel.
struct PanelHit {
  fracture::Vec2 at = fracture::Vec2::Zero();  ///< where, m, panel axes
  std::optional<double> radius;                ///< none: the method's own reach
};

/// What a panel file says.
struct PanelFile {
  std::string file;                  ///< its path or name, for messages
  fracture::PanelShape shape;        ///< counter-clockwise, whichever way the file goes
  double density = 0;                ///< kg/m3
  fracture::PanelSettings settings;  ///< how it breaks
  std::vector<PanelHit> hits;        ///< in order
};

/// A shipped panel's name ("wall_local"), or a path. Throws InputError.
[[nodiscard]] std::filesystem::path find_panel(const std::string& name_or_path);
/// Both throw InputError with file, place, what is wrong and what is accepted.
[[nodiscard]] PanelFile read_panel(const std::filesystem::path& file);
/// True when the file is a panel file (a JSON object with the key "panel"), false when it is something else that can be
/// read. Throws InputError for what cannot.
[[nodiscard]] bool is_panel(const std::filesystem::path& file);
[[nodiscard]] PanelFile parse_panel(std::string_view text, const std::string& name);

}  // namespace topple::structure
