#pragma once
// Where a person chooses what to see: shipped scenes with their pictures, files opened lately, any file, or a new
// building of their own.
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/start/building_plan.h"
#include "app/start/shipped_scenes.h"
#include "renderer/stored_picture.h"

namespace topple::viewer {

class StartPage {
 public:
  StartPage();
  /// Draws it with Dear ImGui over all of the window; what was chosen (a name or a file), once. Needs an OpenGL
  /// context.
  [[nodiscard]] std::optional<std::string> draw();
  /// Told under the title: why the last choice could not be opened.
  std::string message;

 private:
  void scenes();
  void scene(const ShippedScene& scene, float width);
  void files();
  void editor();
  void write_plan();
  std::vector<ShippedScene> scenes_;
  std::vector<std::string> recent_;
  std::map<std::string, std::optional<StoredPicture>> pictures_;
  BuildingPlan plan_;
  std::optional<std::string> chosen_;
  std::array<char, 512> path_{};
  std::array<char, 128> title_{"My building"};
  std::array<char, 256> file_{"my_building.json"};
};

}  // namespace topple::viewer
