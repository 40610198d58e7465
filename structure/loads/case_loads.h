#pragma once
// Load cases as sets of their own, of which combinations are sums.
#include <Eigen/Core>
#include <vector>

#include "topple/structure/frame.h"

namespace topple::structure {

struct CaseLoads {
  std::vector<solver::LoadSet> sets;  ///< of the cases that any of the combinations has, with a factor of 1
  Eigen::MatrixXd factors;            ///< of each of these (rows) in each combination (columns)
};

/// Everything standing, on the frame.
[[nodiscard]] CaseLoads case_loads(const Building& building, const Frame& frame, const EdgeMembers& edges,
                                   const std::vector<CombinationId>& combinations);
/// What a combination that need not be the building's own brings.
[[nodiscard]] PartLoads part_loads(const Building& building, const Combination& combination);

}  // namespace topple::structure
