#pragma once
// Members whose own swing is too quick for one element.
#include <optional>
#include <string>

#include "topple/structure/analysis.h"
#include "topple/structure/frame.h"

namespace topple::structure {

/// Frequency (Hz) of the first bending mode of a member between pinned ends, pi/2 sqrt(E I/(rho A))/L^2 about its
/// weaker axis; none without density.
[[nodiscard]] std::optional<double> own_frequency(const Building& building, const Member& member);

/// Warns of members of one element whose own frequency is not above the highest of `modes`: a cubic with consistent
/// mass swings sqrt(120/pi^4) = 1.11 times as fast between pinned ends, and not at all between held ones. Empty: there
/// are none.
[[nodiscard]] std::string told_undivided(const Building& building, const Frame& frame,
                                         const std::vector<solver::VibrationMode>& modes);

}  // namespace topple::structure
