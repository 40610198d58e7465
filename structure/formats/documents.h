#pragma once
// Models and scenarios from documents that are there already: a file's, or one in which something was changed.
#include <filesystem>
#include <utility>

#include "formats/json/json_document.h"
#include "topple/structure/formats/files.h"

namespace topple::structure::formats {

/// `file`: where the meshes that the model names lie. Throws InputError, as read_model() does.
[[nodiscard]] Building read_model_document(const JsonDocument& document, const std::filesystem::path& file,
                                           Purpose purpose);
/// The file of the model that a scenario names. Throws InputError.
[[nodiscard]] std::filesystem::path model_of_scenario(const JsonDocument& document,
                                                      const std::filesystem::path& folder);
/// The scenario of this building. Throws InputError.
[[nodiscard]] std::pair<Building, Scenario> read_scenario_document(const JsonDocument& document, Building building);

}  // namespace topple::structure::formats
