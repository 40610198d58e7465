// AISC 360-16 chapter G: shear, and the limits of proportions.
#include <algorithm>

#include "design/aisc360_parts.h"

namespace topple::structure::aisc360 {

namespace {

constexpr const char* shear_clause = "AISC 360 G1";

/// G2-9 to G2-11: C_v2 of a plate of slenderness `lambda` with buckling coefficient `kv`.
double shear_coefficient(const SteelSection& s, double lambda, double kv) {
  const double root = std::sqrt(kv * s.E / s.fy);
  if (lambda <= 1.10 * root) return 1;
  if (lambda <= 1.37 * root) return 1.10 * root / lambda;
  return 1.51 * kv * s.E / (lambda * lambda * s.fy);
}

/// G2.1(b): k_v of the web of an I shape; stiffeners further apart than three times its height count for nothing.
double web_coefficient(const SteelSection& s, double spacing) {
  const double height = s.web_height();
  if (!(spacing > 0) || spacing > 3 * height) return 5.34;
  return 5 + 5 / std::pow(spacing / height, 2);
}

ShearStrength open_shear(const SteelSection& s, double spacing, const Trail& trail) {
  const Slenderness plate = slenderness(s);
  const double stress = 0.6 * s.fy, kv = web_coefficient(s, spacing);
  const double limit = 1.10 * std::sqrt(kv * s.E / s.fy);
  const bool stocky = s.rolled && plate.web <= 2.24 * std::sqrt(s.E / s.fy);  // G2.1(a)
  const double cv1 = stocky || plate.web <= limit ? 1 : limit / plate.web;    // G2-3, G2-4
  ShearStrength r;
  r.z = (stocky ? phi_rolled_web : phi_shear) * cv1 * stress * s.depth * s.web;
  r.y = phi_shear * stress * 2 * s.width * s.flange * shear_coefficient(s, plate.flange, 1.2);  // G6
  trail.add(shear_clause, "h/t_w", "rolled and up to 2.24 sqrt(E/F_y): phi_v = 1.00 (G2.1(a))", plate.web,
            plain_number);
  trail.add(shear_clause, "k_v", "5.34, or 5 + 5/(a/h)^2 (G2-5)", kv, plain_number);
  trail.add(shear_clause, "C_v1", "1, or 1.10 sqrt(k_v E/F_y)/(h/t_w) (G2-3, G2-4)", cv1, plain_number);
  trail.add(shear_clause, "phi_v V_n, strong", "phi_v 0.6 F_y A_w C_v1 (G2-1); no tension field action (G2.2)", r.z,
            of_force);
  trail.add(shear_clause, "phi_v V_n, weak", "0.90 0.6 F_y b_f t_f C_v2 of both flanges (G6-1)", r.y, of_force);
  return r;
}

}  // namespace

ShearStrength shear_strength(const SteelSection& s, double spacing, const Trail& trail) {
  const Slenderness plate = slenderness(s);
  const double stress = 0.6 * s.fy;
  ShearStrength r;
  switch (s.kind) {
    case SteelSection::Kind::I:
      return open_shear(s, spacing, trail);
    case SteelSection::Kind::box:  // G4
      r.z = phi_shear * stress * 2 * plate.web * s.web * s.web * shear_coefficient(s, plate.web, 5);
      r.y = phi_shear * stress * 2 * plate.flange * s.web * s.web * shear_coefficient(s, plate.flange, 5);
      break;
    case SteelSection::Kind::pipe: {  // G5, without the benefit of a short shear span
      const double buckling = 0.78 * s.E / std::pow(plate.web, 1.5);
      r.y = r.z = phi_shear * std::min(stress, buckling) * s.area / 2;
      break;
    }
    default:
      r.y = phi_shear * stress * s.shear_y;
      r.z = phi_shear * stress * s.shear_z;
  }
  trail.add(shear_clause, "phi_v V_n, strong", "0.90 0.6 F_y A_w C_v2 (G4, G5)", r.z, of_force);
  trail.add(shear_clause, "phi_v V_n, weak", "0.90 0.6 F_y A_w C_v2 (G4, G5)", r.y, of_force);
  return r;
}

std::string outside_of_rules(const SteelSection& s, double spacing) {
  const double root = std::sqrt(s.E / s.fy);
  const Slenderness plate = slenderness(s);
  if (s.kind == SteelSection::Kind::pipe && plate.web > 0.45 * s.E / s.fy)
    return "D/t is above 0.45 E/F_y, which chapters E and F do not cover";
  if (!is_open(s) || plate.web <= 5.70 * root) return {};
  const double height = s.web_height(), slender = height / s.web;
  const bool close = spacing > 0 && spacing <= 1.5 * height;
  const double limit = close ? 12.0 * root : 0.40 * s.E / s.fy;  // F13-3, F13-4
  if (slender > limit) return "h/t_w is above what F13.2 allows";
  if (!(spacing > 0) && slender > 260) return "h/t_w is above 260 without stiffeners (F13.2)";
  if (height * s.web > 10 * s.width * s.flange) return "the web is above 10 times the compression flange (F13.2)";
  return {};
}

}  // namespace topple::structure::aisc360
