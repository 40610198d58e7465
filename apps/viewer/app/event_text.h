#pragma once
#include <string>

#include "topple/structure/simulation.h"

namespace topple::viewer {

/// What a person reads of an event, in a few words.
[[nodiscard]] std::string event_text(const structure::SimulationEvent& event);

}  // namespace topple::viewer
