#pragma once
// Design checks of a whole analysed building: every steel member by a code's formulas, and the drift of its storeys.
#include "topple/structure/analysis.h"
#include "topple/structure/design_check.h"

namespace topple::structure {

/// Stations along each member at which the formulas are evaluated, beside both sides of every place where a load begins,
/// ends or acts and the places of the extremes of every internal force: ask analyse() for at least this many, and for
/// the critical sections, before check_design().
inline constexpr int design_stations = 20;

/// Limit on the storey drift where none is given: height/300 (UK National Annex to EN 1993-1-1, NA.2.24; codes leave it
/// to the project).
inline constexpr double usual_drift_limit = 1.0 / 300;

/// Lengths and factors that a member is checked with: from its `design`, the rest on the safe side: 2 L for flexural
/// buckling of a post (it may sway) and for any member with an end that nothing else holds (a cantilever, whose lateral
/// length is 2 L too), L for others; torsional length L; no lateral restraint between the ends.
[[nodiscard]] DesignMember design_member(const Building& building, MemberId member, bool has_free_end);

/// Fills `designs` of every combination and `design_code`, `drift_limit` of the result. Throws InputError that names
/// the member and the key when something is missing, and for a building in "consistent" units (the codes' formulas have
/// units). Throws std::invalid_argument when the result has no stations or no critical sections.
void check_design(const Building& building, DesignCode code, double drift_limit, AnalysisResult& result);

}  // namespace topple::structure
