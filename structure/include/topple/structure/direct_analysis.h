#pragma once
// The direct analysis method of AISC 360-16 chapter C: required strengths by a second-order analysis of a structure
// that leans (notional loads, C2.2b) and has yielded in part (reduced stiffness, C2.3), and no effective lengths beyond
// the members' unbraced ones (C3: EffectiveLengths::unbraced).
#include <vector>

#include "topple/structure/building.h"

namespace topple::structure {

/// C2.2b: initial out-of-plumbness of 1/500, and C2.3(c): 1/1000 more in the place of tau_b, so that tau_b is 1 for
/// all.
inline constexpr double notional_share = 0.002 + 0.001;
/// C2.3(a).
inline constexpr double stiffness_share = 0.8;

/// The building with these combinations alone, each four times: NAME +x, NAME -x, NAME +y, NAME -y. In each the
/// downward loads of every case (self weight, nodes, members, panels by their area at the corners) act sideways as
/// well, times `notional_share`, where they act. Throws InputError where a combination would have a name that is taken.
[[nodiscard]] Building with_notional_loads(const Building& building, const std::vector<CombinationId>& combinations);

/// The same building with `stiffness_share` of Young's and shear moduli; joints and supports keep their springs.
[[nodiscard]] Building with_reduced_stiffness(Building building);

}  // namespace topple::structure
