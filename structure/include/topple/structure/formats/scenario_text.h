#pragma once
// Scenarios and tools as texts, for hosts that have the building already: scripts, other languages, a console.
#include <string>
#include <string_view>
#include <utility>

#include "topple/structure/scenario.h"

namespace topple::structure {

/// A scenario of a building that was read already (for any purpose); its key `model` may be left out and names nothing.
/// Members are divided where the scenario cuts them, so the building comes back with it. `name` stands for the file in
/// messages. Throws InputError with the place.
[[nodiscard]] std::pair<Building, Scenario> parse_scenario(std::string_view text, const std::string& name,
                                                           Building building);

/// A tool as an event of a scenario has it, without `at`: {"projectile": {"from": [-20, 0, 2], "velocity": [60, 0,
/// 0]}}. Joints, members, nodes and groups are named as the building of the simulation has them. A member is cut inside
/// only where a cut of the scenario divided it. Throws InputError with the place.
[[nodiscard]] Tool parse_tool(std::string_view text, const std::string& name, const Building& building);

}  // namespace topple::structure
