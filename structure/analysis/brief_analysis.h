#pragma once
// An analysis of which only the uses of joints, the ends of members and the storeys are wanted, as samples of a study do:
// about half of the time that a whole one takes beside its equations goes into what lies between the ends.
#include "topple/structure/analysis.h"

namespace topple::structure {

/// As analyse(), with the same numbers, but without extremes and stations along members, the largest displacement, and
/// the meshes' errors (and what would be warned of for these).
[[nodiscard]] AnalysisResult analyse_briefly(const Building& building, const AnalysisRequest& request);

}  // namespace topple::structure
