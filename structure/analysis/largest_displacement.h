#pragma once
// Where a structure moves most: nodes, places along members, nodes of shells' meshes.
#include <functional>

#include "topple/structure/analysis.h"

namespace topple::structure {

/// Deflections of a member from its chord at a distance from its first end: along local y and z.
using DeflectionAt = std::function<Vec2(std::size_t member, double distance)>;

/// Searches members whose ends and deflections could be beyond what moves most so far, in that order; each at as many
/// places as leave an error of a thousandth of its deflection. `result` has displacements and members.
[[nodiscard]] LargestDisplacement largest_displacement(const Building& building, const CombinationResult& result,
                                                       const DeflectionAt& deflection);

/// The largest displacement of any point of any member and node under a shape of node motions alone, members bent cubic
/// between their ends, and their inner nodes where `cuts` has some (AnalysisResult::mode_cuts): what a drawing shows.
[[nodiscard]] double largest_in_shape(const Building& building, const std::vector<Vec6>& shape,
                                      const std::vector<std::vector<int>>& cuts);

}  // namespace topple::structure
