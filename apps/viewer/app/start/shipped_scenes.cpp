#include "app/start/shipped_scenes.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "topple/structure/formats/files.h"
#include "topple/structure/formats/shipped_files.h"

namespace topple::viewer {
namespace {

using nlohmann::json;

/// What a file says at its top level, without what is nested.
json top_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  const auto shallow = [](int depth, json::parse_event_t, json&) { return depth <= 1; };
  json top = json::parse(stream, shallow, false);
  return top.is_object() ? top : json::object();
}

std::string text_of(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

}  // namespace

std::vector<ShippedScene> shipped_scenes() {
  std::vector<ShippedScene> scenes;
  const auto add = [&](const std::string& name, const json& top, const std::filesystem::path& models) {
    scenes.push_back({name, text_of(top, "title"), models / "pictures" / (name + ".png")});
  };
  std::set<std::string> seen;
  for (const std::string& name : structure::shipped_scenarios()) {
    const std::filesystem::path file = structure::find_scenario(name);
    const json top = top_of(file);
    seen.insert(text_of(top, "model"));
    add(name, top, file.parent_path().parent_path());
  }
  for (const std::string& name : structure::shipped_models()) {
    if (seen.contains(name) && name != opening_scene) continue;
    const std::filesystem::path file = structure::find_model(name);
    add(name, top_of(file), file.parent_path());
  }
  std::stable_partition(scenes.begin(), scenes.end(), [](const ShippedScene& s) { return s.name == opening_scene; });
  return scenes;
}

}  // namespace topple::viewer
