#pragma once
// The scenes that come with the program, as the start page shows them.
#include <filesystem>
#include <string>
#include <vector>

namespace topple::viewer {

struct ShippedScene {
  std::string name, title;
  std::filesystem::path picture;  ///< may not be there
};
/// The opening scene first, then scenarios, then the models that no scenario shows, each by name. Pictures lie in the
/// folder `pictures` beside the models.
[[nodiscard]] std::vector<ShippedScene> shipped_scenes();

/// The scene that the program opens on without a name.
inline constexpr const char* opening_scene = "town_house";

}  // namespace topple::viewer
