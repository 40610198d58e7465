#include "design/moment_shape.h"

#include <algorithm>
#include <cmath>

namespace topple::structure {

namespace {

/// Absolute moment about y at a place, straight between stations.
double moment_at(std::span<const double> at, std::span<const SectionForces> stations, double place) {
  const auto above = static_cast<std::size_t>(std::lower_bound(at.begin(), at.end(), place) - at.begin());
  if (above == 0) return std::abs(stations.front()[4]);
  if (above == at.size()) return std::abs(stations.back()[4]);
  const double width = at[above] - at[above - 1];
  const double share = width > 0 ? (place - at[above - 1]) / width : 1;
  return std::abs(stations[above - 1][4] + share * (stations[above][4] - stations[above - 1][4]));
}

}  // namespace

StretchMoments moments_within(std::span<const double> at, std::span<const SectionForces> stations, double from,
                              double to) {
  StretchMoments m;
  const double length = to - from;
  m.quarter = moment_at(at, stations, from + 0.25 * length);
  m.middle = moment_at(at, stations, from + 0.5 * length);
  m.three_quarters = moment_at(at, stations, from + 0.75 * length);
  m.largest =
      std::max({m.quarter, m.middle, m.three_quarters, moment_at(at, stations, from), moment_at(at, stations, to)});
  for (std::size_t i = 0; i < at.size(); ++i)
    if (at[i] >= from && at[i] <= to) m.largest = std::max(m.largest, std::abs(stations[i][4]));
  return m;
}

double moment_factor_aisc(const StretchMoments& m) {
  if (m.largest == 0) return 1;
  return 12.5 * m.largest / (2.5 * m.largest + 3 * m.quarter + 4 * m.middle + 3 * m.three_quarters);
}

double moment_factor_serna(const StretchMoments& m) {
  if (m.largest == 0) return 1;
  const double square = m.largest * m.largest, a = m.quarter * m.quarter, b = m.middle * m.middle,
               c = m.three_quarters * m.three_quarters;
  return std::sqrt(35 * square / (square + 9 * a + 16 * b + 9 * c));
}

std::vector<CheckedStretch> checked_stretches(const DesignMember& member, std::span<const SectionForces> stations,
                                              double (*shape)(const StretchMoments&)) {
  double largest = 0;
  for (const SectionForces& forces : stations) largest = std::max(largest, std::abs(forces[4]));
  const double given = member.factors.critical_moment;
  if (given > 0 || member.stretches.empty() || member.at.size() != stations.size())
    return {{member.lengths.lateral, given > 0 ? given : 1, largest}};
  std::vector<CheckedStretch> all;
  for (const LateralStretch& stretch : member.stretches) {
    const StretchMoments m = moments_within(member.at, stations, stretch.from, stretch.to);
    all.push_back({stretch.length, stretch.moments_are_known ? shape(m) : 1, m.largest});
  }
  return all;
}

}  // namespace topple::structure
