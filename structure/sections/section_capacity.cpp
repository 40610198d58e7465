#include "sections/section_capacity.h"

#include <cmath>

namespace topple::structure {

namespace {

/// The section's share of a capacity, the key it stands under, and whether shear stress decides.
struct SectionShare {
  std::optional<double> value;
  const char* key;
  bool shear;
};

SectionShare share(const Section& s, Sense sense) {
  switch (sense) {
    case Sense::tension:
    case Sense::compression:
      return {s.area, "area", false};
    case Sense::shear_y:
      return {s.plastic_shear_area_y, "shear_area_y", true};
    case Sense::shear_z:
      return {s.plastic_shear_area_z, "shear_area_z", true};
    case Sense::torsion:
      return {s.torsion_modulus, "torsion_modulus", true};
    case Sense::moment_y:
      return {s.plastic_modulus_y, "plastic_modulus_y", false};
    case Sense::moment_z:
      return {s.plastic_modulus_z, "plastic_modulus_z", false};
  }
  return {};
}

}  // namespace

SectionCapacity section_capacity(const Section& section, const Material& material, Sense sense) {
  const SectionShare part = share(section, sense);
  if (!part.value) return {0, part.key, {}};
  if (!material.yield_strength) return {0, {}, "yield_strength"};
  return {*part.value * *material.yield_strength / (part.shear ? std::sqrt(3.0) : 1.0), {}, {}};
}

}  // namespace topple::structure
