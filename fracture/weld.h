#pragma once
// One number for all vertices of a mesh at one position.
#include <vector>

#include "topple/fracture/mesh.h"

namespace topple::fracture {

/// Of each position, a number that equal positions share, from 0 without gaps, in the order of the positions.
[[nodiscard]] std::vector<int> weld(const std::vector<Vec3>& positions);

}  // namespace topple::fracture
