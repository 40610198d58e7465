// AISC 360-16 chapter E: compression.
#include <algorithm>

#include "design/aisc360_parts.h"

namespace topple::structure::aisc360 {

Slenderness slenderness(const SteelSection& s) {
  switch (s.kind) {
    case SteelSection::Kind::I:
      return {s.width / (2 * s.flange), (s.depth - 2 * s.flange - 2 * s.fillet) / s.web};
    case SteelSection::Kind::box:
      return {(s.width - s.corners) / s.web, (s.depth - s.corners) / s.web};
    case SteelSection::Kind::pipe:
      return {s.depth / s.web, s.depth / s.web};
    default:
      return {};
  }
}

double flange_coefficient(const SteelSection& s) { return std::clamp(4 / std::sqrt(slenderness(s).web), 0.35, 0.76); }

namespace {

/// E7 (E7-2, E7-3): width of plate that counts in compression, over its whole width.
double effective_share(double lambda, double limit, double fy, double fcr, double c1, double c2) {
  if (lambda <= limit * std::sqrt(fy / fcr)) return 1;
  const double elastic = std::pow(c2 * limit / lambda, 2) * fy;
  return (1 - c1 * std::sqrt(elastic / fcr)) * std::sqrt(elastic / fcr);
}

/// E7: area that counts at the critical stress.
double effective_area(const SteelSection& s, double fcr) {
  const double root = std::sqrt(s.E / s.fy);
  const Slenderness plate = slenderness(s);
  if (is_open(s)) {
    const double web_length = plate.web * s.web;
    // Table B4.1a: case 1 rolled, case 2 built up.
    const double limit = s.rolled ? 0.56 * root : 0.64 * root * std::sqrt(flange_coefficient(s));
    const double flange = effective_share(plate.flange, limit, s.fy, fcr, 0.22, 1.49);
    const double web = effective_share(plate.web, 1.49 * root, s.fy, fcr, 0.18, 1.31);
    return s.area - (1 - flange) * 2 * s.width * s.flange - (1 - web) * web_length * s.web;
  }
  if (is_box(s)) {
    const double flange = effective_share(plate.flange, 1.40 * root, s.fy, fcr, 0.20, 1.38);
    const double web = effective_share(plate.web, 1.40 * root, s.fy, fcr, 0.20, 1.38);
    return s.area - 2 * s.web * s.web * ((1 - flange) * plate.flange + (1 - web) * plate.web);
  }
  if (s.kind == SteelSection::Kind::pipe) {  // E7-6, E7-7
    const double wall = plate.web * s.fy / s.E;
    return wall <= 0.11 ? s.area : s.area * (0.038 / wall + 2.0 / 3.0);
  }
  return s.area;
}

}  // namespace

double section_strength(const SteelSection& s) { return s.fy * effective_area(s, s.fy); }

double compressive_strength(const SteelSection& s, const BucklingLengths& lengths, const Trail& trail) {
  const char* const clause = "AISC 360 E1";
  double elastic = unlimited;
  const auto flexural = [&](double length, double radius, const char* symbol, const char* formula) {
    if (!(length > 0)) return;
    elastic = std::min(elastic, pi2 * s.E / std::pow(length / radius, 2));
    trail.add(clause, symbol, formula, length / radius, plain_number);
  };
  flexural(lengths.y, s.radius_y(), "L_cx/r_x", "K_x L/sqrt(I_x/A)");
  flexural(lengths.z, s.radius_z(), "L_cy/r_y", "K_y L/sqrt(I_y/A)");
  if (is_open(s) && lengths.torsion > 0) {  // E4-2
    const double torsional = (pi2 * s.E * s.warping / std::pow(lengths.torsion, 2) + s.G * s.J) / (s.Iy + s.Iz);
    elastic = std::min(elastic, torsional);
    trail.add(clause, "F_e, torsional", "(pi^2 E C_w/L_cz^2 + G J)/(I_x + I_y) (E4-2)", torsional, of_stress);
  }
  const double fcr = s.fy / elastic <= 2.25 ? std::pow(0.658, s.fy / elastic) * s.fy : 0.877 * elastic;
  const double area = effective_area(s, fcr);
  if (elastic < unlimited) trail.add(clause, "F_e", "least of pi^2 E/(L_c/r)^2 (E3-4) and (E4-2)", elastic, of_stress);
  trail.add(clause, "F_cr", "0.658^(F_y/F_e) F_y (E3-2), or 0.877 F_e (E3-3)", fcr, of_stress);
  trail.add(clause, "A_e", "A_g less what buckles locally (E7)", area, of_area);
  trail.add(clause, "phi_c P_n", "0.90 F_cr A_e (E3-1, E7-1)", phi_axial * fcr * area, of_force);
  return fcr * area;
}

}  // namespace topple::structure::aisc360
