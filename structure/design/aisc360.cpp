// AISC 360-16, load and resistance factor design: the order of the checks, and chapters D and H.
#include <algorithm>

#include "design/aisc360_parts.h"

namespace topple::structure {

namespace {

using namespace aisc360;

struct Strengths {
  double tension, compression, moment_y, moment_z, torsion;
  ShearStrength shear;
  double moment_y_utilisation = 0;  ///< of the stretch between restraints in which it is largest
};

/// H1.2: tension along the whole member holds the compressed flange; what C_b is multiplied by.
double tension_factor(const SteelSection& s, double length, double tension) {
  if (!(tension > 0) || !(length > 0)) return 1;
  const double euler = pi2 * s.E * s.Iz / (length * length);  // P_ey
  return std::sqrt(1 + tension / euler);
}

/// Chapter F for every stretch between lateral restraints; the strength is that of the stretch that is used most.
void set_flexure(Strengths& r, const SteelSection& s, const DesignMember& member,
                 std::span<const SectionForces> stations, const Trail& trail) {
  const std::vector<CheckedStretch> stretches = checked_stretches(member, stations, moment_factor_aisc);
  double tension = unlimited;  // the least one; 0 where any part is compressed
  for (const SectionForces& at : stations) tension = std::min(tension, std::max(0.0, at[0]));
  const CheckedStretch* worst = nullptr;
  for (const CheckedStretch& stretch : stretches) {
    const double cb = stretch.factor * tension_factor(s, stretch.length, tension);
    const double strength = phi_flexure * strong_strength(s, stretch.length, cb, {});
    const double use = stretch.moment / strength;
    if (worst != nullptr && use <= r.moment_y_utilisation) continue;
    worst = &stretch;
    r.moment_y_utilisation = use;
    r.moment_y = strength;
  }
  if (!trail.on() || worst == nullptr) return;
  const double held = tension_factor(s, worst->length, tension);
  if (held > 1)
    trail.add("AISC 360 F1", "sqrt(1 + P_r/P_ey)", "tension along the whole member, C_b times this (H1.2)", held,
              plain_number);
  (void)strong_strength(s, worst->length, worst->factor * held, trail);
  trail.add("AISC 360 F1", "phi_b M_nx", "0.90 M_n, the least of yielding, lateral-torsional and local buckling",
            r.moment_y, of_moment);
}

Strengths strengths(const SteelSection& s, const DesignMember& member, std::span<const SectionForces> stations,
                    const Trail& trail) {
  Strengths r{};
  r.tension = phi_axial * s.fy * s.area;  // D2-1
  trail.add("AISC 360 D2", "phi_t P_n", "0.90 F_y A_g (D2-1)", r.tension, of_force);
  r.compression = phi_axial * compressive_strength(s, member.lengths, trail);
  set_flexure(r, s, member, stations, trail);
  r.moment_z = phi_flexure * weak_strength(s, trail);
  r.torsion = phi_torsion * 0.6 * s.fy * s.torsion;  // H3-1, H3-8
  r.shear = shear_strength(s, member.stiffener_spacing, trail);
  if (r.torsion > 0) trail.add("AISC 360 H3-1", "phi_T T_n", "0.90 0.6 F_y C (H3-1)", r.torsion, of_moment);
  return r;
}

/// H1-1a and H1-1b.
double interaction(double axial, double moments) {
  return axial >= 0.2 ? axial + 8.0 / 9.0 * moments : axial / 2 + moments;
}

void check_closed_torsion(ClauseList& clauses, const Strengths& r, const LargestForces& forces, double moments) {
  if (!(r.torsion > 0) || !(forces.torsion > 0)) return;
  const double torsion = forces.torsion / r.torsion;
  clauses.add("AISC 360 H3-1", torsion);
  if (torsion <= 0.2) return;  // H3-6
  const double axial = std::max(forces.compression / r.compression, forces.tension / r.tension);
  const double shear =
      std::max(r.shear.y > 0 ? forces.shear_y / r.shear.y : 0, r.shear.z > 0 ? forces.shear_z / r.shear.z : 0);
  clauses.add("AISC 360 H3-6", axial + moments + std::pow(shear + torsion, 2));
}

/// C2.3(b): the stiffness of the analysis that the forces come from.
void trace_stiffness(const SteelSection& s, const DesignMember& member, const Trail& trail) {
  if (!member.yielded || !trail.on()) return;
  const char* const clause = "AISC 360 C2.3";
  trail.add(clause, "P_ns", "F_y A_g, or F_y A_e of slender elements (E7)", section_strength(s), of_force);
  trail.add(clause, "alpha P_r/P_ns", "alpha = 1; largest compression of all combinations", member.yielded->ratio,
            plain_number);
  trail.add(clause, "tau_b", "1 up to 0.5 (C2-2a), else 4 (P_r/P_ns)(1 - P_r/P_ns) (C2-2b)", member.yielded->tau_b,
            plain_number);
}

void trace_interaction(const Strengths& r, const LargestForces& forces, const Trail& trail) {
  const char* const clause = "AISC 360 H1-1";
  trail.add(clause, "P_u/P_c", "compression over phi_c P_n", forces.compression / r.compression, plain_number);
  trail.add(clause, "P_u/P_c (tension)", "tension over phi_t P_n", forces.tension / r.tension, plain_number);
  trail.add(clause, "M_ux/M_cx", "over phi_b M_nx", r.moment_y_utilisation, plain_number);
  trail.add(clause, "M_uy/M_cy", "over phi_b M_ny", forces.moment_z / r.moment_z, plain_number);
}

}  // namespace

DesignResult check_aisc360(const DesignMember& member, std::span<const SectionForces> stations, const Trail& trail) {
  const SteelSection steel = steel_section(*member.section, *member.material);
  const LargestForces forces = largest_forces(stations);
  trace_section(steel, trail);
  trace_forces(forces, trail);
  trace_stiffness(steel, member, trail);
  const Strengths r = strengths(steel, member, stations, trail);
  trace_interaction(r, forces, trail);
  ClauseList clauses;
  const double moments = r.moment_y_utilisation + forces.moment_z / r.moment_z;
  if (forces.compression > 0) {
    clauses.add("AISC 360 E1", forces.compression / r.compression);
    clauses.add("AISC 360 H1-1", interaction(forces.compression / r.compression, moments));
  }
  if (forces.tension > 0) {
    clauses.add("AISC 360 D2", forces.tension / r.tension);
    clauses.add("AISC 360 H1-1 (tension)", interaction(forces.tension / r.tension, moments));
  }
  clauses.add("AISC 360 F1", std::max(r.moment_y_utilisation, forces.moment_z / r.moment_z));
  if (r.shear.y > 0 && r.shear.z > 0)
    clauses.add("AISC 360 G1", std::max(forces.shear_y / r.shear.y, forces.shear_z / r.shear.z));
  check_closed_torsion(clauses, r, forces, moments);
  const double axial = std::max(forces.compression / r.compression, forces.tension / r.tension);
  check_open_torsion(clauses, steel, member, stations, axial + moments, trail);
  const std::string outside = outside_of_rules(steel, member.stiffener_spacing);
  if (!outside.empty()) clauses.refuse(outside);
  return clauses.result();
}

}  // namespace topple::structure
