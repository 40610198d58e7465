#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "topple/structure/building.h"
#include "topple/structure/material_tuning.h"
#include "topple/structure/scenario.h"
#include "topple/structure/visual_mesh.h"

namespace topple::viewer {

struct Scene {
  std::shared_ptr<const structure::Building> building;
  structure::Scenario scenario;
  std::filesystem::path model;                                     ///< file or folder that the building was read from
  std::shared_ptr<const std::vector<structure::DrawnMesh>> drawn;  ///< around the building; may be empty
  std::optional<double> lasts = {};  ///< s: the scenario's `duration`; none for a model, which has no end
};

/// A shipped scenario's or model's name, or a file of either kind. Throws structure::InputError.
[[nodiscard]] Scene open_scene(const std::string& name);

/// The scene's building with other strengths of materials. Throws structure::InputError.
[[nodiscard]] std::shared_ptr<const structure::Building> building_with_strengths(
    const Scene& scene, const std::vector<structure::MaterialChange>& changes);

}  // namespace topple::viewer
