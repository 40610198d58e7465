#pragma once
// The parts of a check by AISC 360-16, load and resistance factor design. Local y is the strong axis (x in the
// specification), local z the weak one (y in the specification).
#include <numbers>

#include "design/moment_shape.h"
#include "design/steel_section.h"

namespace topple::structure::aisc360 {

inline constexpr double phi_axial = 0.90, phi_flexure = 0.90, phi_shear = 0.90, phi_rolled_web = 1.00,
                        phi_torsion = 0.90;
inline constexpr double pi2 = std::numbers::pi * std::numbers::pi;

inline bool is_box(const SteelSection& s) { return s.kind == SteelSection::Kind::box; }
inline bool is_open(const SteelSection& s) { return s.kind == SteelSection::Kind::I; }

/// Slendernesses of table B4.1: half flange and clear web of I shapes; walls of boxes between their corners; diameter
/// over wall of pipes.
struct Slenderness {
  double flange = 0, web = 0;
};
[[nodiscard]] Slenderness slenderness(const SteelSection& s);
/// Table B4.1, note a: k_c of the flanges of an I, 4/sqrt(h/t_w) between 0.35 and 0.76.
[[nodiscard]] double flange_coefficient(const SteelSection& s);

/// Chapter E: nominal compressive strength (E3, E4, E7).
[[nodiscard]] double compressive_strength(const SteelSection& s, const BucklingLengths& lengths, const Trail& trail);

/// P_ns of C2.3(b): F_y times what of the area counts when all of it yields (E7 with F_n = F_y).
[[nodiscard]] double section_strength(const SteelSection& s);

/// Chapter F: nominal strength about the strong axis over a length with its C_b, and about the weak one.
[[nodiscard]] double strong_strength(const SteelSection& s, double length, double cb, const Trail& trail);
[[nodiscard]] double weak_strength(const SteelSection& s, const Trail& trail);

/// Chapter G: design strengths along local y and z; 0: not known.
struct ShearStrength {
  double y = 0, z = 0;
};
[[nodiscard]] ShearStrength shear_strength(const SteelSection& s, double stiffener_spacing, const Trail& trail);

/// What puts a section outside of the specification's rules (B4, F8, F13.2); empty: nothing.
[[nodiscard]] std::string outside_of_rules(const SteelSection& s, double stiffener_spacing);

/// H3.3: normal and shear stress of an open section under torsion, and what they are with buckling (H3-7 to H3-9).
void check_open_torsion(ClauseList& clauses, const SteelSection& s, const DesignMember& member,
                        std::span<const SectionForces> stations, double without_torsion, const Trail& trail);

}  // namespace topple::structure::aisc360
