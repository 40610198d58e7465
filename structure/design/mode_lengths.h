#pragma once
// Effective lengths from buckling modes: a member that takes part in the lowest mode buckles at factor x axial force.
#include <array>
#include <optional>

#include "topple/structure/analysis.h"

namespace topple::structure {

/// Share of the largest bend (root mean square of the slope against the chord, of a member that is driven, in that
/// mode) from which on a member takes part in a mode. What merely leans or goes along says nothing of its own critical
/// force.
inline constexpr double takes_part = 0.3;

/// Least share of a member's bending energy in a mode that the work of its own compression comes to, for the member to
/// buckle and not to be bent: at the factor both are equal over the whole structure. A hardly pressed beam that holds
/// posts has none of it, and factor N says nothing of its own critical force.
inline constexpr double least_driven = 0.5;

/// What the modes say of buckling about one axis.
struct ModeLength {
  ModePart part = ModePart::not_asked;
  double length = 0;  ///< pi sqrt(E I/(factor N)), m, where it takes part
};

/// pi sqrt(E I/(factor N)) by the lowest mode, whether the member takes part or not: the structure is stable up to that
/// factor, so no member's critical force is below factor N, nor its effective length above this. None without modes or
/// compression.
[[nodiscard]] std::array<std::optional<double>, 2> longest_by_modes(const Building& building, MemberId member,
                                                                    const CombinationResult& combination);

/// Per mode of a combination: the largest bend of any member that is driven by its compression.
[[nodiscard]] std::vector<double> largest_bends(const Building& building, const CombinationResult& combination);

/// For buckling about y and about z, by the first mode in which the member takes part so.
[[nodiscard]] std::array<ModeLength, 2> lengths_from_modes(const Building& building, MemberId member,
                                                           const CombinationResult& combination,
                                                           const std::vector<double>& largest_bends);

}  // namespace topple::structure
