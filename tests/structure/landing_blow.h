#pragma once
// What lands: a blow, and then its weight.
#include <algorithm>

namespace topple::test {

inline constexpr double weight = 1e4, blow = 1e6;                          // N
inline constexpr double lands_at = 0.021, taken_within = 4e-3, end = 0.5;  // s

/// N s by then: a blow, then its weight.
inline double impulse_until(double time) {
  const double since = std::max(0.0, time - lands_at);
  return blow * std::min(since, taken_within) + weight * std::max(0.0, since - taken_within);
}

}  // namespace topple::test
