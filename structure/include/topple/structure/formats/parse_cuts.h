#pragma once
// Cuts through a structure from JSON that is at hand, for hosts that have no file of it, and those of models.
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "topple/structure/analysis.h"

namespace topple::structure {

/// As read_section_cuts() has them from a file; `name` stands in messages where a file's would. Throws InputError.
[[nodiscard]] std::vector<SectionCut> parse_section_cuts(std::string_view text, const std::string& name,
                                                         const Building& building);

/// The cuts that a model asks for itself (its key `cuts`, in tables cuts.csv); none where it has none. `building` is
/// what was read from it. Throws InputError.
[[nodiscard]] std::vector<SectionCut> read_model_cuts(const std::filesystem::path& file, const Building& building);
[[nodiscard]] std::vector<SectionCut> parse_model_cuts(std::string_view text, const std::string& name,
                                                       const Building& building);

}  // namespace topple::structure
