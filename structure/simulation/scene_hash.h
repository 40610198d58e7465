#pragma once
// A hash of building and scenario, by which a snapshot of one scene is refused by another.
#include <cstdint>

#include "topple/structure/building.h"
#include "topple/structure/scenario.h"

namespace topple::structure {

/// Hash of all numbers and names of a building and a scenario that can change what happens: same value, same scene.
/// Titles, names of files, warnings, units of the output and what only analyses ask for are left out.
[[nodiscard]] std::uint64_t scene_hash(const Building& building, const Scenario& scenario);

}  // namespace topple::structure
