#pragma once
#include "renderer/camera.h"
#include "topple/structure/scenario.h"

namespace topple::viewer {

/// Box around all nodes; where several buildings stand apart (no member or panel joins them) and the scenario's first
/// ball flies at one, around that one's.
[[nodiscard]] Bounds bounds_of_target(const structure::Building& building, const structure::Scenario& scenario);

}  // namespace topple::viewer
