#pragma once
// What a part's own joints bear of a force across it.
#include <span>

#include "simulation/debris/part.h"
#include "topple/structure/building.h"

namespace topple::structure {

/// N: the least force across the part, wherever it acts, at which one of its joints may fail by shear, or of a member
/// by the moment of a force at midspan with both ends clamped (F l/8). `strength`: a factor for each joint.
[[nodiscard]] double local_capacity(const Building& building, Part part, std::span<const double> strength);

}  // namespace topple::structure
