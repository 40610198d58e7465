// Where shipped models and scenarios lie.
#include <algorithm>
#include <cstdlib>
#include <set>
#include <vector>

#include "formats/json/json_document.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/formats/input_files.h"
#include "topple/structure/formats/panel_file.h"
#include "topple/structure/formats/shipped_files.h"
#include "topple/structure/modelling_checks.h"
#include "topple/structure/study/study.h"

namespace topple::structure {

namespace {

namespace fs = std::filesystem;

/// In order of preference. The source tree comes before the installed one, so that a build uses its own models.
std::vector<fs::path> shipped_folders() {
  std::vector<fs::path> folders;
  if (const char* chosen = std::getenv("TOPPLE_MODELS"); chosen != nullptr && *chosen != '\0')
    folders.emplace_back(chosen);
#ifdef TOPPLE_SOURCE_MODELS
  folders.emplace_back(TOPPLE_SOURCE_MODELS);
#endif
  folders.emplace_back(TOPPLE_INSTALLED_MODELS);
  return folders;
}

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

bool is_folder_of_tables(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path / "nodes.csv", ignored);
}

std::vector<std::string> shipped(const fs::path& below) {
  std::set<std::string> names;
  for (const fs::path& place : shipped_folders()) {
    std::error_code ignored;
    for (const fs::path name : names_in(place / below, ignored))
      if (name.extension() == ".json") names.insert(name.stem().string());
  }
  return {names.begin(), names.end()};
}

/// Shipped scenarios in which this model stands.
std::vector<std::string> scenarios_of(const std::string& model) {
  std::vector<std::string> found;
  for (const std::string& name : shipped("scenarios")) {
    const formats::JsonDocument scenario = formats::JsonDocument::from_file(find_scenario(name));
    const auto told = scenario.root().find("model");
    if (told && told->is_text() && told->text() == model) found.push_back(name);
  }
  return found;
}

/// Who names a model where a scenario is asked for is told what there is of it.
std::string if_a_model(const std::string& name) {
  const std::vector<std::string> models = shipped({});
  if (std::find(models.begin(), models.end(), name) == models.end()) return {};
  const std::vector<std::string> scenarios = scenarios_of(name);
  return " (it is a model: " +
         (scenarios.empty() ? std::string("no shipped scenario has it")
                            : "its scenarios are " + formats::quoted_list({scenarios.begin(), scenarios.end()})) +
         "; topple-viewer takes it as it is)";
}

fs::path find(const std::string& name_or_path, const fs::path& folder, const char* kind, const fs::path& below) {
  const fs::path path = folder / name_or_path;
  if (is_file(path) || (std::string_view(kind) == "model" && is_folder_of_tables(path))) return path;
  if (fs::path(name_or_path).filename() == name_or_path)  // a path is never one of ours
    for (const fs::path& place : shipped_folders())
      if (fs::path file = place / below / (name_or_path + ".json"); is_file(file)) return file;
  const std::vector<std::string> names = shipped(below);
  const std::string model = std::string_view(kind) == "scenario" ? if_a_model(name_or_path) : std::string();
  throw InputError(
      name_or_path + ": there is no such " + kind + (model.empty() ? did_you_mean(name_or_path, names) : model) +
      "; accepted: a path to a file, or a shipped one: " + formats::quoted_list({names.begin(), names.end()}));
}

}  // namespace

fs::path find_model(const std::string& name_or_path, const fs::path& folder) {
  return find(name_or_path, folder, "model", {});
}

std::vector<std::string> shipped_models() { return shipped({}); }
std::vector<std::string> shipped_scenarios() { return shipped("scenarios"); }

fs::path find_scenario(const std::string& name_or_path) { return find(name_or_path, {}, "scenario", "scenarios"); }

fs::path find_study(const std::string& name_or_path) { return find(name_or_path, {}, "study", "studies"); }

fs::path find_panel(const std::string& name_or_path) { return find(name_or_path, {}, "panel", "panels"); }

}  // namespace topple::structure
