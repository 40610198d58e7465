#pragma once
// What natural_modes() and shifted_modes() throw where a model's own numbers are too far apart.
#include <stdexcept>
#include <string>
#include <utility>

namespace topple::solver {

/// Natural modes that cannot be told from rounding: what the least stiff freedom has in stiffness over mass is lost
/// beside what the stiffest has, or beside the shift.
class UnresolvedModes : public std::runtime_error {
 public:
  using Place =
      std::pair<double, int>;  ///< stiffness over mass, 1/s^2; index in FrameModel::nodes, -1 where it is none
  /// `what`: for a person.
  UnresolvedModes(const std::string& what, const Place& softest, const Place& stiffest)
      : std::runtime_error(what), least(softest), largest(stiffest) {}
  Place least;    ///< the softest freedom that has mass
  Place largest;  ///< the stiffest one
};

}  // namespace topple::solver
