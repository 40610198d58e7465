#pragma once
// What the printed report says of the checks of governing members, and what it draws of loads.

#include "topple/structure/formats/json_tree.h"
#include "topple/structure/member_checks.h"

namespace topple::app {

/// For every section the member that is used most over all combinations, and those refused or above 1 beside them (at
/// most 40 in all, the most used first): every intermediate value with clause and formula, in kN, kNm, mm and N/mm2
/// where the model is in N and m, else in the model's units. Empty without a design check.
[[nodiscard]] structure::JsonTree report_audits(const structure::Building& building,
                                                const structure::AnalysisResult& result,
                                                const structure::DesignInput& input);

/// Per load case: arrows [{at, to}] of loads at nodes and on members (at the middle of what they act along), indices of
/// loaded panels, and how many loads are left out because a drawing would not show them.
[[nodiscard]] structure::JsonTree load_drawings(const structure::Building& building);

}  // namespace topple::app
