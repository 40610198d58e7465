#include "design/turned_section.h"

#include <utility>

namespace topple::structure {

bool stronger_about_z(const Section& section) {
  constexpr double rounding = 1e-9;  // a square box has both alike
  return section.shape != Section::Shape::I && section.Iz > (1 + rounding) * section.Iy;
}

TurnedMember::TurnedMember(const DesignMember& given, std::span<const SectionForces> forces)
    : section(*given.section), member(given), stations(forces.begin(), forces.end()) {
  std::swap(section.Iy, section.Iz);
  std::swap(section.depth, section.width);
  std::swap(section.shear_area_y, section.shear_area_z);
  std::swap(section.plastic_shear_area_y, section.plastic_shear_area_z);
  std::swap(section.plastic_modulus_y, section.plastic_modulus_z);
  member.section = &section;
  std::swap(member.lengths.y, member.lengths.z);
  std::swap(member.length_source[0], member.length_source[1]);
  std::swap(member.mode_part[0], member.mode_part[1]);
  std::swap(member.factors.equivalent_y, member.factors.equivalent_z);
  for (SectionForces& at : stations) {
    std::swap(at[1], at[2]);
    std::swap(at[4], at[5]);
  }
}

}  // namespace topple::structure
