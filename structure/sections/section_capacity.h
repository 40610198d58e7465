#pragma once
// What a member end can bear when its joint is as strong as its section.
#include <array>
#include <optional>
#include <string>

#include "topple/structure/building.h"

namespace topple::structure {

/// Capacity in one sense, or the key that is missing for it ("yield_strength", "plastic_modulus_y", ...).
struct SectionCapacity {
  double value = 0;
  std::string missing_of_section, missing_of_material;  ///< key; empty: nothing is missing
};

/// N: A fy. Shear: Av fy/sqrt(3), Av of EN 1993-1-1 6.2.6(3) and kin (Section::plastic_shear_area). Torsion: fy/sqrt(3)
/// times the torsion modulus. Moments: plastic modulus times fy.
[[nodiscard]] SectionCapacity section_capacity(const Section& section, const Material& material, Sense sense);

}  // namespace topple::structure
