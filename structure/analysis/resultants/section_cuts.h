#pragma once
// What passes a plane through the structure.
#include <vector>

#include "topple/structure/analysis.h"
#include "topple/structure/frame.h"

namespace topple::structure {

/// `loads`: on the frame, and `parts` what acts on panels, both of the combination whose `solution` (absolute
/// displacements) is given. `displaced`: forces act where the structure has moved to (second order). Throws InputError
/// for a cut through a rigid floor of a model in which joints of shells give: which of the two bears what is not known.
[[nodiscard]] std::vector<CutResult> cut_results(const Building& building, const Frame& frame,
                                                 const std::vector<SectionCut>& cuts, const PartLoads& parts,
                                                 const solver::LoadSet& loads, const solver::StaticSolution& solution,
                                                 bool displaced);

}  // namespace topple::structure
