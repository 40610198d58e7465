// EN 1993-1-1:2005, EN 1993-1-5:2006 with the recommended values gamma_M0 = gamma_M1 = 1.0: the order of the checks.
#include <algorithm>

#include "design/en1993_parts.h"

namespace topple::structure {

DesignResult check_en1993(const DesignMember& member, std::span<const SectionForces> stations, const Trail& trail) {
  const SteelSection steel = steel_section(*member.section, *member.material);
  const LargestForces forces = largest_forces(stations);
  const SectionClass cls = classify_en1993(steel, forces.compression);
  const en1993::Resistance section = en1993::cross_section(steel, cls, forces.compression > 0);
  trace_section(steel, trail);
  trace_forces(forces, trail);
  trail.add("EN 1993-1-1 5.5 (table 5.2)", "class", "of the web and the flanges, under the compression and M_y",
            cls.number, plain_number);
  if (cls.about_z != cls.number)
    trail.add("EN 1993-1-1 5.5 (table 5.2)", "class, M_z", "under the compression and M_z: webs are compressed flanges",
              cls.about_z, plain_number);
  const bool buckles = std::max(cls.number, cls.about_z) == 4 || cls.pressed_area < steel.area;
  if (buckles && steel.kind != SteelSection::Kind::pipe) trace_effective(effective_section(steel), trail);
  ClauseList clauses;
  en1993::check_sections(clauses, steel, cls, section, stations, trail);
  en1993::check_plates(clauses, steel, cls, member, stations, trail);
  const double bimoment = en1993::check_torsion(clauses, steel, section, member, stations, trail);
  en1993::check_buckling(clauses, steel, member, cls, section, forces, bimoment, stations, trail);
  return clauses.result();
}

}  // namespace topple::structure
