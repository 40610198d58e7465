#pragma once
// The spacing of double precision at 1, which bounds of rounding are multiples of.
#include <limits>

namespace topple::solver {

inline constexpr double machine_epsilon = std::numeric_limits<double>::epsilon();

}  // namespace topple::solver
