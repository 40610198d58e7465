#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "topple/structure/building.h"
#include "topple/structure/scenario.h"

namespace topple::viewer {

struct Scene {
  std::shared_ptr<const structure::Building> building;
  structure::Scenario scenario;
  std::filesystem::path model;  ///< file or folder that the building was read from
};

/// A shipped scenario's or model's name, or a file of either kind. Throws structure::InputError.
[[nodiscard]] Scene open_scene(const std::string& name);

}  // namespace topple::viewer
