#pragma once
// Mass of a building's own material: no loads, no masses that the model adds.
#include "topple/structure/building.h"

namespace topple::structure {

/// kg; of a panel without its openings.
[[nodiscard]] double own_mass(const Building& building, MemberId member);
[[nodiscard]] double own_mass(const Building& building, PanelId panel);
/// kg, of all members and panels.
[[nodiscard]] double own_mass(const Building& building);

}  // namespace topple::structure
