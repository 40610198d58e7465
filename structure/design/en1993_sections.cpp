// EN 1993-1-1 6.2: resistance of cross-sections.
#include <algorithm>

#include "design/en1993_parts.h"

namespace topple::structure::en1993 {

namespace {

/// What the parts that carry shear along z and along y bring to the section: their area and moduli.
struct ShearParts {
  struct Part {
    double area = 0, modulus_y = 0, modulus_z = 0;
  };
  Part along_z, along_y;
  bool apart = false;  ///< false: the whole section carries either
};

ShearParts shear_parts(const SteelSection& s, bool plastic, bool plastic_z) {
  ShearParts parts;
  const double web = s.web_height(), t = s.web;
  if (s.kind == SteelSection::Kind::I) {
    const double flange = s.width * s.flange, arm = s.depth - s.flange;
    parts.apart = true;
    parts.along_z = {s.shear_z, plastic ? t * web * web / 4 : t * web * web * web / 6 / s.depth, 0};
    parts.along_y = {s.shear_y, plastic ? flange * arm : flange * arm * arm / s.depth,
                     plastic_z ? s.flange * s.width * s.width / 2 : s.flange * s.width * s.width / 3};
  } else if (s.kind == SteelSection::Kind::box) {
    const double wide = s.width - 2 * t, across = s.width - t, up = s.depth - t;
    parts.apart = true;
    parts.along_z = {s.shear_z, plastic ? t * web * web / 2 : t * web * web * web / 3 / s.depth,
                     plastic_z ? t * web * across : t * web * across * across / s.width};
    parts.along_y = {s.shear_y, plastic ? t * wide * up : t * wide * up * up / s.depth,
                     plastic_z ? t * wide * wide / 2 : t * wide * wide * wide / 3 / s.width};
  }
  return parts;
}

/// 6.2.8(3): loss of strength of what carries the shear, where that is above half of its resistance.
double shear_loss(double use) { return use <= 0.5 ? 0 : std::pow(2 * std::min(use, 1.0) - 1, 2); }

/// Resistances with high shear (6.2.8(3), 6.2.10(3)): the shear areas count with (1 - rho) fy.
struct Reduced {
  double axial, moment_y, moment_z;
};

Reduced reduced(const Resistance& r, const ShearParts& parts, double fy, double loss_z, double loss_y) {
  if (loss_z == 0 && loss_y == 0) return {r.axial, r.moment_y, r.moment_z};
  constexpr double least = 1e-3;  // of the full resistance: at V = V_pl,Rd a pipe has none left
  if (!parts.apart) {
    const double share = std::max(1 - std::max(loss_z, loss_y), least);
    return {r.axial * share, r.moment_y * std::max(1 - loss_z, least), r.moment_z * std::max(1 - loss_y, least)};
  }
  const auto left = [&](double whole, double of_z, double of_y) {
    return std::max(whole - (loss_z * of_z + loss_y * of_y) * fy / gamma_m0, least * whole);
  };
  return {left(r.axial, parts.along_z.area, parts.along_y.area),
          left(r.moment_y, parts.along_z.modulus_y, parts.along_y.modulus_y),
          left(r.moment_z, parts.along_z.modulus_z, parts.along_y.modulus_z)};
}

struct Uses {
  double shear_y = 0, shear_z = 0, torsion = 0, section = 0;
  double loss_y = 0, loss_z = 0;
  Reduced left{};
};

Uses uses_at(const SectionForces& at, const Resistance& r, const ShearParts& parts, double fy) {
  Uses u;
  u.torsion = ratio(at[3], r.torsion);
  u.shear_y = ratio(at[1], r.shear_y) + u.torsion;
  u.shear_z = ratio(at[2], r.shear_z) + u.torsion;
  u.loss_y = shear_loss(u.shear_y);
  u.loss_z = shear_loss(u.shear_z);
  u.left = reduced(r, parts, fy, u.loss_z, u.loss_y);
  u.section = std::abs(at[0]) / u.left.axial + std::abs(at[4]) / u.left.moment_y + std::abs(at[5]) / u.left.moment_z;
  return u;
}

void trace(const Trail& trail, const SectionForces& at, const Resistance& r, const Uses& u) {
  const char* const clause = "EN 1993-1-1 6.2.1 (6.2)";
  trail.add("EN 1993-1-1 6.2.6 (6.17)", "V_pl,y,Rd", "A_v,y f_y/sqrt(3)/gamma_M0", r.shear_y, of_force);
  trail.add("EN 1993-1-1 6.2.6 (6.17)", "V_pl,z,Rd", "A_v,z f_y/sqrt(3)/gamma_M0", r.shear_z, of_force);
  if (r.torsion > 0) trail.add("EN 1993-1-1 6.2.7 (6.23)", "T_Rd", "W_t f_y/sqrt(3)/gamma_M0", r.torsion, of_moment);
  trail.add(clause, "N_Ed", "at the governing section", at[0], of_force);
  trail.add(clause, "M_y,Ed", "at the governing section", at[4], of_moment);
  trail.add(clause, "M_z,Ed", "at the governing section", at[5], of_moment);
  trail.add(clause, "V_z,Ed", "at the governing section", at[2], of_force);
  trail.add(clause, "rho_z", "(2 V_z,Ed/V_pl,z,Rd - 1)^2 above half of it (6.2.8(3))", u.loss_z, plain_number);
  trail.add(clause, "rho_y", "(2 V_y,Ed/V_pl,y,Rd - 1)^2 above half of it (6.2.8(3))", u.loss_y, plain_number);
  trail.add(clause, "N_V,Rd", "(A - rho A_v) f_y/gamma_M0 (6.2.4, 6.2.10)", u.left.axial, of_force);
  trail.add(clause, "M_y,V,Rd", "(W_y - rho W of the shear area) f_y/gamma_M0 (6.2.5, 6.2.8)", u.left.moment_y,
            of_moment);
  trail.add(clause, "M_z,V,Rd", "(W_z - rho W of the shear area) f_y/gamma_M0 (6.2.5, 6.2.8)", u.left.moment_z,
            of_moment);
  trail.add(clause, "use", "N_Ed/N_V,Rd + M_y,Ed/M_y,V,Rd + M_z,Ed/M_z,V,Rd", u.section, plain_number);
}

}  // namespace

/// EN 10210-2 and EN 10219-2 W_t of hollow sections, in which the largest shear stress counts; else that of the
/// section.
double torsion_modulus(const SteelSection& s) {
  if (s.kind == SteelSection::Kind::pipe) return 2 * s.J / s.depth;
  if (s.kind != SteelSection::Kind::box) return s.torsion;
  const double wide = s.width - s.web, high = s.depth - s.web;
  return s.J / (s.web + wide * high / (wide + high));  // t + 2 A_h/h, h the mean perimeter
}

Resistance cross_section(const SteelSection& steel, const SectionClass& cls, bool compressed) {
  const bool plastic = cls.number <= 2 && steel.has_plastic, plastic_z = cls.about_z <= 2 && steel.has_plastic;
  const double shear_strength = steel.fy / std::sqrt(3.0) / gamma_m0;  // class 4 is one of direct stress
  return {(compressed ? cls.counts.area : steel.area) * cls.fy / gamma_m0,
          (plastic ? steel.plastic_y : cls.counts.modulus_y) * cls.fy / gamma_m0,
          (plastic_z ? steel.plastic_z : cls.counts.modulus_z) * cls.fy / gamma_m0,
          steel.shear_y * shear_strength,
          steel.shear_z * shear_strength,
          torsion_modulus(steel) * shear_strength};
}

void check_sections(ClauseList& clauses, const SteelSection& steel, const SectionClass& cls, const Resistance& r,
                    std::span<const SectionForces> stations, const Trail& trail) {
  const ShearParts parts =
      shear_parts(steel, cls.number <= 2 && steel.has_plastic, cls.about_z <= 2 && steel.has_plastic);
  double most = -1;
  const SectionForces* worst = nullptr;
  for (const SectionForces& at : stations) {
    const Uses u = uses_at(at, r, parts, cls.fy);
    if (r.shear_y > 0 && r.shear_z > 0) clauses.add("EN 1993-1-1 6.2.6 (6.17)", std::max(u.shear_y, u.shear_z));
    if (r.torsion > 0) clauses.add("EN 1993-1-1 6.2.7 (6.23)", u.torsion);
    clauses.add("EN 1993-1-1 6.2.1 (6.2)", u.section);
    if (u.section <= most) continue;
    most = u.section;
    worst = &at;
  }
  if (trail.on() && worst != nullptr) trace(trail, *worst, r, uses_at(*worst, r, parts, cls.fy));
}

}  // namespace topple::structure::en1993
