#pragma once
// The shape of a moment diagram between lateral restraints, as one factor on the critical moment.
#include <span>

#include "topple/structure/design_check.h"

namespace topple::structure {

/// Moments about local y within a stretch: the largest, and those at its quarter points, absolute values.
struct StretchMoments {
  double largest = 0, quarter = 0, middle = 0, three_quarters = 0;
};
/// `at` in order; between stations moments are straight.
[[nodiscard]] StretchMoments moments_within(std::span<const double> at, std::span<const SectionForces> stations,
                                            double from, double to);

/// AISC 360 (F1-1): 12.5 Mmax/(2.5 Mmax + 3 MA + 4 MB + 3 MC); 1 where there is no moment.
[[nodiscard]] double moment_factor_aisc(const StretchMoments& m);
/// Serna, Lopez, Puente and Yong, Equivalent uniform moment factors for lateral-torsional buckling of steel members,
/// J. Constr. Steel Res. 62 (2006), ends free to warp: sqrt(35 Mmax^2/(Mmax^2 + 9 M2^2 + 16 M3^2 + 9 M4^2)).
[[nodiscard]] double moment_factor_serna(const StretchMoments& m);

/// What a stretch is checked with, worst of several found by the caller.
struct CheckedStretch {
  double length = 0, factor = 1, moment = 0;
};
/// The stretches of a member with their factors: by `shape` where the moments are known and none is given. Without
/// stretches (or a factor given) one over lengths.lateral with the member's largest moment.
[[nodiscard]] std::vector<CheckedStretch> checked_stretches(const DesignMember& member,
                                                            std::span<const SectionForces> stations,
                                                            double (*shape)(const StretchMoments&));

}  // namespace topple::structure
