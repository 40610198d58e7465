#include "app/open_scene.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "topple/structure/error.h"
#include "topple/structure/formats/convert.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/formats/shipped_files.h"
#include "topple/structure/join_shells.h"
#include "topple/structure/modelling_checks.h"

namespace topple::viewer {
namespace {

using structure::InputError;

/// A scenario names its model at the top; what cannot be read counts as a model, whose reader says why. The nesting is
/// cut off, so that no file can exhaust the memory.
bool names_a_model(const std::filesystem::path& file) {
  std::ifstream stream(file);
  bool found = false;
  const auto filter = [&found](int depth, nlohmann::json::parse_event_t event, nlohmann::json& value) {
    if (event == nlohmann::json::parse_event_t::key && depth == 1 && value == "model") found = true;
    return depth <= 1;
  };
  const nlohmann::json unused = nlohmann::json::parse(stream, filter, false);
  return found;
}

std::optional<std::filesystem::path> scenario_file(const std::string& name) {
  if (std::filesystem::is_regular_file(name))
    return names_a_model(name) ? std::optional<std::filesystem::path>(name) : std::nullopt;
  try {
    return structure::find_scenario(name);
  } catch (const InputError&) {
    return std::nullopt;  // then it is a model's name, or find_model says what is accepted
  }
}

std::string listed(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

std::filesystem::path model_file(const std::string& name) {
  const std::vector<std::string> models = structure::shipped_models(), scenarios = structure::shipped_scenarios();
  std::error_code ignored;
  if (std::filesystem::exists(name, ignored) || std::find(models.begin(), models.end(), name) != models.end())
    return structure::find_model(name);
  std::vector<std::string> known = scenarios;
  known.insert(known.end(), models.begin(), models.end());
  throw InputError(name + ": there is no such scenario or model" + structure::did_you_mean(name, known) +
                   "; accepted: a path to a file, or a shipped scenario: " + listed(scenarios) +
                   "; or a shipped model: " + listed(models));
}

Scene scene_of(structure::Building building, structure::Scenario scenario, const std::filesystem::path& model) {
  auto drawn = std::make_shared<const std::vector<structure::DrawnMesh>>(structure::read_drawn_meshes(building, model));
  return {std::make_shared<const structure::Building>(std::move(building)), std::move(scenario), model,
          std::move(drawn)};
}

}  // namespace

Scene open_scene(const std::string& name) {
  if (const auto file = scenario_file(name)) {
    auto [building, scenario] = structure::read_scenario(*file);
    const std::filesystem::path model = structure::find_model(scenario.model, file->parent_path());
    const double lasts = scenario.duration;
    Scene scene = scene_of(std::move(building), std::move(scenario), model);
    scene.lasts = lasts;
    return scene;
  }
  const std::filesystem::path model = model_file(name);
  structure::Building building = structure::read_model(model);
  structure::join_shells(building);
  structure::Scenario scenario = structure::idle_scenario(building);
  return scene_of(std::move(building), std::move(scenario), model);
}

std::shared_ptr<const structure::Building> building_with_strengths(
    const Scene& scene, const std::vector<structure::MaterialChange>& changes) {
  if (changes.empty()) return scene.building;
  const std::string text = structure::convert_model(scene.model, structure::ModelForm::json).files.at(0).second;
  structure::Building building =
      structure::parse_model(structure::model_with_strengths(text, changes), scene.model.string());
  structure::join_shells(building);
  return std::make_shared<const structure::Building>(std::move(building));
}

}  // namespace topple::viewer
