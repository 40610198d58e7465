#pragma once
// Reading models and scenarios. Each throws InputError with one line: file, place, what is wrong, what is accepted.
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "topple/structure/building.h"
#include "topple/structure/scenario.h"

namespace topple::structure {

/// What a model is read for: features that are not built yet are refused by their name, each for its own purposes.
/// `inspect` takes in all that the format defines.
enum class Purpose { analyse, demolish, inspect };
/// Throws InputError for the first feature of the building that `purpose` cannot carry out yet.
void refuse_unbuilt(const Building& building, Purpose purpose);

/// A shipped model's name ("seed_building"), or a path (relative to `folder`). Shipped ones are found in
/// $TOPPLE_MODELS, in the source tree while building, in the installed data; scenarios in the folder `scenarios` there.
/// Throws InputError.
[[nodiscard]] std::filesystem::path find_model(const std::string& name_or_path,
                                               const std::filesystem::path& folder = {});
[[nodiscard]] std::filesystem::path find_scenario(const std::string& name_or_path);

/// Reads a model of any known format: by its ending (.json, .3dd), or a folder of tables (CSV).
[[nodiscard]] Building read_model(const std::filesystem::path& file, Purpose purpose = Purpose::analyse);
/// The same from text, `name` standing for the file in messages.
[[nodiscard]] Building parse_model(std::string_view text, const std::string& name, Purpose purpose = Purpose::analyse);

/// A model from tables: file names ("nodes.csv") and texts, `folder` standing for their place in messages.
[[nodiscard]] Building parse_tables(const std::vector<std::pair<std::string, std::string>>& tables,
                                    const std::string& folder, Purpose purpose = Purpose::analyse);

/// Reads a scenario and the model that it names.
[[nodiscard]] std::pair<Building, Scenario> read_scenario(const std::filesystem::path& file);
/// The same from text; the model is looked up from `folder`.
[[nodiscard]] std::pair<Building, Scenario> parse_scenario(std::string_view text, const std::string& name,
                                                           const std::filesystem::path& folder);
/// True when the file is a scenario (a JSON object that names a model), false when it is something else that can be
/// read.
[[nodiscard]] bool is_scenario(const std::filesystem::path& file);
/// The scenario in which nothing happens to a model (for a viewer that is given a model): its combination "collapse",
/// or its first.
[[nodiscard]] Scenario idle_scenario(const Building& building);

}  // namespace topple::structure
