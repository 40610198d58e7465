#pragma once
// Codes name a section's axes by their strength. A bar or box that stands on its short side in the model's axes (its
// strong axis is local z) is checked with both axes exchanged.
#include <vector>

#include "topple/structure/design_check.h"

namespace topple::structure {

/// The section is stronger about local z, and may be turned: every one but an I, whose web says which axis is which.
[[nodiscard]] bool stronger_about_z(const Section& section);

/// A member with local y and z exchanged: its section, lengths, factors, and the forces at its stations (their signs
/// have no part in any check). Restraints and stretches stay: they are those of the compressed edge, whatever its axis.
struct TurnedMember {
  TurnedMember(const DesignMember& given, std::span<const SectionForces> forces);
  TurnedMember(const TurnedMember&) = delete;
  TurnedMember& operator=(const TurnedMember&) = delete;

  Section section;
  DesignMember member;  ///< points to `section`
  std::vector<SectionForces> stations;
};

}  // namespace topple::structure
