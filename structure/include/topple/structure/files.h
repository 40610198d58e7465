#pragma once
// Reading models and scenarios. Each throws InputError with one line: file, place, what is wrong, what is accepted.
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include "topple/structure/building.h"
#include "topple/structure/scenario.h"

namespace topple::structure {

/// A shipped model's name ("seed_building"), or a path (relative to `folder`). The shipped folder is found beside the
/// executable's installed data, in the source tree while building, or in $TOPPLE_MODELS.
[[nodiscard]] std::filesystem::path find_model(const std::string& name_or_path, const std::filesystem::path& folder = {});
[[nodiscard]] std::filesystem::path find_scenario(const std::string& name_or_path);

/// Reads a model of any known format by its ending.
[[nodiscard]] Building read_model(const std::filesystem::path& file);
/// The same from text, `name` standing for the file in messages.
[[nodiscard]] Building parse_model(std::string_view text, const std::string& name);

/// Reads a scenario and the model that it names.
[[nodiscard]] std::pair<Building, Scenario> read_scenario(const std::filesystem::path& file);
/// The same from text; the model is looked up from `folder`.
[[nodiscard]] std::pair<Building, Scenario> parse_scenario(std::string_view text, const std::string& name,
                                                           const std::filesystem::path& folder);
/// The scenario in which nothing happens to a model (for a viewer that is given a model).
[[nodiscard]] Scenario idle_scenario(const Building& building);

}  // namespace topple::structure
