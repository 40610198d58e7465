#pragma once
// Second-order statics (P-Delta) by iteration over elastic answers: axial forces act on the displaced structure.
#include <functional>
#include <vector>

#include "topple/structure/building.h"

namespace topple::structure {

enum class DisplacedRest {
  found,
  mechanism,  ///< the elastic structure has no answer: as unstable as it was without these forces
  none        ///< it does not settle
};

/// Displacements (per node) of u' = K^-1 (F - Kg(N) u): with the geometric forces of these displacements and of the end
/// forces of the last answer; null for a mechanism.
using DisplacedAnswer = std::function<const std::vector<Vec6>*(const std::vector<Vec6>& displacements)>;

/// Iterates from `first`, the answer without these forces or with others. What the slowest share leaves is added at
/// once (Aitken; Irons and Tuck 1969, International Journal for Numerical Methods in Engineering 1). When found, the
/// last answer is the state.
[[nodiscard]] DisplacedRest find_displaced_rest(std::vector<Vec6> first, const DisplacedAnswer& answer);

}  // namespace topple::structure
