#pragma once
// Members that a scenario cuts inside are divided there before anything else looks at the building.
#include <map>
#include <string>

#include "formats/json/json_document.h"
#include "topple/structure/building.h"

namespace topple::structure::formats {

/// By a cut member's name and place: the joint that the cut breaks.
using CutPlaces = std::map<std::pair<std::string, double>, std::string>;

/// `root`: of the scenario. Places 0 and 1 are the member's own joints.
[[nodiscard]] CutPlaces divide_cut_members(const JsonValue& root, Building& building);

}  // namespace topple::structure::formats
