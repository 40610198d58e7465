#pragma once
// Cuts through a structure from JSON that is at hand, for hosts that have no file of it.
#include <string>
#include <string_view>
#include <vector>

#include "topple/structure/analysis.h"

namespace topple::structure {

/// As read_section_cuts() has them from a file; `name` stands in messages where a file's would. Throws InputError.
[[nodiscard]] std::vector<SectionCut> parse_section_cuts(std::string_view text, const std::string& name,
                                                         const Building& building);

}  // namespace topple::structure
