#pragma once
// Right-hand sides of a frame: loads on nodes and beams, imposed displacements.
#include <span>
#include <vector>

#include "assembly/frame_system.h"

namespace topple::solver {

/// Throws std::invalid_argument for loads on what does not exist, or that cannot be computed with.
[[nodiscard]] LoadVector load_vector(const FrameSystem& system, const LoadSet& loads);
/// Several at once: what they share of the elements is worked out once.
[[nodiscard]] std::vector<LoadVector> load_vectors(const FrameSystem& system, std::span<const LoadSet> sets);

}  // namespace topple::solver
