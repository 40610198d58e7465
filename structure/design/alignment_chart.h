#pragma once
// Effective length factors of columns from the stiffness of what holds their ends: the equations behind the alignment
// charts (Julian and Lawrence; AISC 360-16 commentary C-A-7-1 and C-A-7-2).

namespace topple::structure {

/// Relative stiffness of an end, sum(E I/L) of columns over that of beams: the commentary's recommended value for a
/// rigid foot, and a number that is as good as infinite for a hinge. (Its 10 for a pinned foot counts on a hold that a
/// model with a hinge there does not have.)
inline constexpr double fixed_end = 1, released_end = 1000;

/// Sidesway inhibited: between 0.5 and 1.
[[nodiscard]] double chart_braced(double ga, double gb);
/// Sidesway uninhibited: 1 and above.
[[nodiscard]] double chart_sway(double ga, double gb);

}  // namespace topple::structure
