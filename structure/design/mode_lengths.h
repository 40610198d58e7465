#pragma once
// Effective lengths from buckling modes: a member that takes part in the lowest mode buckles at factor x axial force.
#include <array>
#include <optional>

#include "topple/structure/analysis.h"

namespace topple::structure {

/// Share of the largest bend (root mean square of the slope against the chord, of a compressed member, in that mode)
/// from which on a member takes part in a mode. What merely leans or goes along says nothing of its own critical force.
inline constexpr double takes_part = 0.3;

/// The same by the lowest mode, whether the member takes part or not: the structure is stable up to that factor, so no
/// member's critical force is below factor N, nor its effective length above this. None without modes or compression.
[[nodiscard]] std::array<std::optional<double>, 2> longest_by_modes(const Building& building, MemberId member,
                                                                    const CombinationResult& combination);

/// Per mode of a combination: the largest bend of any compressed member.
[[nodiscard]] std::vector<double> largest_bends(const Building& building, const CombinationResult& combination);

/// pi sqrt(E I/(factor N)) for buckling about y and about z, by the first mode in which the member takes part so; none
/// where there is no such mode, or the member is not compressed.
[[nodiscard]] std::array<std::optional<double>, 2> lengths_from_modes(const Building& building, MemberId member,
                                                                      const CombinationResult& combination,
                                                                      const std::vector<double>& largest_bends);

}  // namespace topple::structure
