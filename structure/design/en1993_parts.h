#pragma once
// The parts of a check by EN 1993 with its recommended values gamma_M0 = gamma_M1 = 1.0.
#include "design/en1993_class.h"
#include "design/steel_section.h"
#include "design/warping_torsion.h"

namespace topple::structure::en1993 {

inline constexpr double gamma_m0 = 1.0, gamma_m1 = 1.0;
/// EN 1993-1-5 5.1(2), on the safe side of its recommended 1.20, and as the shear areas have it (6.2.6(3)).
inline constexpr double eta = 1.0;
/// Torsion below this share of its resistance is left out where warping cannot be found.
inline constexpr double negligible_torsion = 0.02;

struct Resistance {
  double axial, moment_y, moment_z, shear_y, shear_z, torsion;
};
/// `compressed`: N is a compression somewhere, and N_Rd that of the effective area; else it is tension, of the whole
/// one.
[[nodiscard]] Resistance cross_section(const SteelSection& steel, const SectionClass& cls, bool compressed);

/// 6.2.3 to 6.2.10 at every station.
void check_sections(ClauseList& clauses, const SteelSection& steel, const SectionClass& cls, const Resistance& r,
                    std::span<const SectionForces> stations, const Trail& trail);

/// EN 1993-1-5 sections 5 (shear buckling), 7.1 (with bending) and 8 (flange induced buckling).
void check_plates(ClauseList& clauses, const SteelSection& steel, const SectionClass& cls, const DesignMember& member,
                  std::span<const SectionForces> stations, const Trail& trail);

/// 6.2.7 with bimoments. Returns the largest bimoment, 0 where there is none.
double check_torsion(ClauseList& clauses, const SteelSection& steel, const Resistance& r, const DesignMember& member,
                     std::span<const SectionForces> stations, const Trail& trail);

/// 6.3.1 to 6.3.3, and EN 1993-6 annex A where there is a bimoment.
void check_buckling(ClauseList& clauses, const SteelSection& steel, const DesignMember& member, const SectionClass& cls,
                    const Resistance& section, const LargestForces& forces, double bimoment,
                    std::span<const SectionForces> stations, const Trail& trail);

/// 0 where there is no demand, or the resistance is not known.
[[nodiscard]] inline double ratio(double demand, double resistance) {
  return demand == 0 || !(resistance > 0) ? 0 : std::abs(demand) / resistance;
}

}  // namespace topple::structure::en1993
