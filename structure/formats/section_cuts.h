#pragma once
// Cuts of a file of their own, or of a model.
#include <vector>

#include "formats/json/json_document.h"
#include "topple/structure/analysis.h"

namespace topple::structure::formats {

/// The cuts of an object {NAME: {"at", "normal", "along", "parts"}}, which is not empty. Throws InputError.
[[nodiscard]] std::vector<SectionCut> section_cuts(const JsonValue& list, const Building& building);

}  // namespace topple::structure::formats
