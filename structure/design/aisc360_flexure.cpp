// AISC 360-16 chapter F: flexure.
#include <algorithm>

#include "design/aisc360_parts.h"

namespace topple::structure::aisc360 {

namespace {

constexpr const char* flexure_clause = "AISC 360 F1";

/// F4-11: radius of gyration of the compressed flange and a third of the compressed web; a_w of F4-12.
double flange_radius(const SteelSection& s, double aw) { return s.width / std::sqrt(12 * (1 + aw / 6)); }

/// F2-2 to F2-6, with a noncompact web F4-2 to F4-8: lateral-torsional buckling of an I shape whose strength without it
/// is `plain`.
double lateral_strength(const SteelSection& s, double length, double cb, double plain, bool noncompact, double aw,
                        const Trail& trail) {
  const double ho = s.depth - s.flange;
  const double rts = noncompact ? flange_radius(s, aw) : std::sqrt(std::sqrt(s.Iz * s.warping) / s.elastic_y);
  const double jc = s.J / (s.elastic_y * ho);
  const double residual = 0.7 * s.fy;
  const double lp = (noncompact ? 1.1 * rts : 1.76 * s.radius_z()) * std::sqrt(s.E / s.fy);
  const double lr =
      1.95 * rts * s.E / residual * std::sqrt(jc + std::sqrt(jc * jc + 6.76 * std::pow(residual / s.E, 2)));
  if (noncompact)
    trail.add(flexure_clause, "r_t", "b_fc/sqrt(12 (1 + a_w/6)) (F4-11)", rts, of_length);
  else
    trail.add(flexure_clause, "r_ts", "sqrt(sqrt(I_y C_w)/S_x) (F2-7)", rts, of_length);
  trail.add(flexure_clause, "L_p", noncompact ? "1.1 r_t sqrt(E/F_y) (F4-7)" : "1.76 r_y sqrt(E/F_y) (F2-5)", lp,
            of_length);
  trail.add(flexure_clause, "L_r", noncompact ? "(F4-8)" : "(F2-6)", lr, of_length);
  if (length <= lp) return plain;
  if (length <= lr) return std::min(plain, cb * (plain - (plain - residual * s.elastic_y) * (length - lp) / (lr - lp)));
  const double slender = length / rts;
  const double fcr = cb * pi2 * s.E / (slender * slender) * std::sqrt(1 + 0.078 * jc * slender * slender);
  trail.add(flexure_clause, "F_cr", noncompact ? "(F4-5)" : "(F2-4)", fcr, of_stress);
  return std::min(plain, fcr * s.elastic_y);
}

/// F5-3 to F5-5: of an I shape with a slender web, which brings no stiffness against twist.
double slender_web_lateral(const SteelSection& s, double length, double cb, double rpg, double aw, const Trail& trail) {
  const double rt = flange_radius(s, aw);
  const double lp = 1.1 * rt * std::sqrt(s.E / s.fy), lr = std::numbers::pi * rt * std::sqrt(s.E / (0.7 * s.fy));
  double fcr = s.fy;
  if (length > lr)
    fcr = cb * pi2 * s.E / std::pow(length / rt, 2);
  else if (length > lp)
    fcr = cb * (s.fy - 0.3 * s.fy * (length - lp) / (lr - lp));
  fcr = std::min(fcr, s.fy);
  trail.add(flexure_clause, "r_t", "b_fc/sqrt(12 (1 + a_w/6)) (F4-11)", rt, of_length);
  trail.add(flexure_clause, "L_p", "1.1 r_t sqrt(E/F_y) (F4-7)", lp, of_length);
  trail.add(flexure_clause, "L_r", "pi r_t sqrt(E/(0.7 F_y)) (F5-5)", lr, of_length);
  trail.add(flexure_clause, "F_cr", "(F5-3), (F5-4)", fcr, of_stress);
  return rpg * fcr * s.elastic_y;
}

/// Straight line between the plastic moment at `compact` and the residual-stress moment at `noncompact`.
double between(double lambda, double compact, double noncompact, double plastic, double reduced) {
  if (lambda <= compact) return plastic;
  return plastic - (plastic - reduced) * std::min(1.0, (lambda - compact) / (noncompact - compact));
}

/// F3, F5.3: the compression flange buckles; `plain` is the strength without it.
double flange_strength(const SteelSection& s, double plain, double rpg) {
  const double root = std::sqrt(s.E / s.fy), yield = s.fy * s.elastic_y;
  const Slenderness plate = slenderness(s);
  const double kc = flange_coefficient(s);
  // Table B4.1b: case 10 rolled, case 11 built up, F_L = 0.7 F_y.
  const double noncompact = s.rolled ? 1.0 * root : 0.95 * root * std::sqrt(kc / 0.7);
  if (plate.flange > noncompact)
    return std::min(plain, rpg * 0.9 * s.E * kc * s.elastic_y / (plate.flange * plate.flange));      // F3-2, F5-9
  return between(plate.flange, 0.38 * root, noncompact, plain, std::min(plain, rpg * 0.7 * yield));  // F3-1, F5-8
}

/// F2 to F5: I shape about its strong axis.
double open_strong(const SteelSection& s, double length, double cb, const Trail& trail) {
  const double root = std::sqrt(s.E / s.fy);
  const Slenderness plate = slenderness(s);
  const double yield = s.fy * s.elastic_y;
  const bool slender = plate.web > 5.70 * root;
  const double aw = std::min(10.0, plate.web * s.web * s.web / (s.width * s.flange));
  const double rpg = slender ? std::min(1.0, 1 - aw / (1200 + 300 * aw) * (plate.web - 5.70 * root)) : 1;  // F5-6
  const bool noncompact = plate.web > 3.76 * root;
  double plain = s.fy * s.plastic_y;
  if (noncompact) plain = yield;  // F4 with R_pc = 1
  plain *= rpg;
  trail.add(flexure_clause, "b_f/(2 t_f)", "compact to 0.38 sqrt(E/F_y) (table B4.1b)", plate.flange, plain_number);
  trail.add(flexure_clause, "h/t_w", "compact to 3.76, not slender to 5.70 sqrt(E/F_y) (table B4.1b)", plate.web,
            plain_number);
  trail.add(flexure_clause, "M_p", "F_y Z_x (F2-1); F_y S_x, R_pg F_y S_x for noncompact, slender webs (F4, F5)", plain,
            of_moment);
  const double local = flange_strength(s, plain, rpg);
  trail.add(flexure_clause, "M_n, flange", "flange local buckling (F3, F5.3)", local, of_moment);
  if (!(length > 0)) return local;
  const double lateral = slender ? slender_web_lateral(s, length, cb, rpg, aw, trail)
                                 : lateral_strength(s, length, cb, plain, noncompact, aw, trail);
  return std::min(local, lateral);
}

/// F6: I shape about its weak axis.
double open_weak(const SteelSection& s) {
  const double root = std::sqrt(s.E / s.fy), lambda = slenderness(s).flange;
  const double plastic = std::min(s.fy * s.plastic_z, 1.6 * s.fy * s.elastic_z);
  if (lambda > 1.0 * root) return std::min(plastic, 0.69 * s.E / (lambda * lambda) * s.elastic_z);
  return between(lambda, 0.38 * root, 1.0 * root, plastic, 0.7 * s.fy * s.elastic_z);
}

/// F7: box about an axis. `height` and `width` are its outside dimensions across and along that axis; `flange` and
/// `web` the slendernesses of its walls.
double box_strength(const SteelSection& s, double plastic_modulus, double inertia, double height, double flange,
                    double web) {
  const double root = std::sqrt(s.E / s.fy), t = s.web;
  const double plastic = s.fy * plastic_modulus, yield = s.fy * inertia / (height / 2);
  double strength = plastic;
  if (flange > 1.40 * root) {  // F7-3: what of the walls does not count by F7-4 is taken out on both sides
    const double counts = std::min(1.0, 1.92 * root / flange * (1 - 0.38 / flange * root));
    const double lost = (1 - counts) * flange * t;
    const double left = inertia - 2 * lost * t * (t * t / 12 + std::pow((height - t) / 2, 2));
    strength = yield * std::max(0.0, left / inertia);
  } else if (flange > 1.12 * root) {
    strength = std::min(plastic, plastic - (plastic - yield) * (3.57 * flange / root - 4.0));
  }
  if (web > 5.70 * root) {  // F7.3(c)
    const double aw = std::min(10.0, 2 * web / std::max(flange, 1e-9));
    return std::min(strength, yield * std::min(1.0, 1 - aw / (1200 + 300 * aw) * (web - 5.70 * root)));
  }
  if (web > 2.42 * root)
    strength = std::min(strength, plastic - (plastic - yield) * std::min(1.0, 0.305 * web / root - 0.738));
  return strength;
}

/// F7-10 to F7-12: lateral-torsional buckling of a box.
double box_lateral(const SteelSection& s, double length, double cb, double plastic) {
  const double torsion = std::sqrt(s.J * s.area);
  const double residual = 0.7 * s.fy * s.elastic_y;
  const double lp = 0.13 * s.E * s.radius_z() * torsion / plastic;
  const double lr = 2 * s.E * s.radius_z() * torsion / residual;
  if (length <= lp) return plastic;
  if (length <= lr) return std::min(plastic, cb * (plastic - (plastic - residual) * (length - lp) / (lr - lp)));
  return std::min(plastic, 2 * s.E * cb * torsion / (length / s.radius_z()));
}

/// F8: round tube.
double pipe_strength(const SteelSection& s) {
  const double wall = slenderness(s).web, relative = wall * s.fy / s.E;
  if (relative <= 0.07) return s.fy * s.plastic_y;
  if (relative <= 0.31) return std::min(s.fy * s.plastic_y, (0.021 * s.E / wall + s.fy) * s.elastic_y);
  return 0.33 * s.E / wall * s.elastic_y;
}

/// F11: solid bar about its strong axis.
double bar_strength(const SteelSection& s, double length, double cb) {
  const double plastic = std::min(s.fy * s.plastic_y, 1.6 * s.fy * s.elastic_y);
  if (!(length > 0) || s.depth <= s.width) return plastic;
  const double slender = length * s.depth / (s.width * s.width);
  if (slender <= 0.08 * s.E / s.fy) return plastic;
  if (slender <= 1.9 * s.E / s.fy)
    return std::min(plastic, cb * (1.52 - 0.274 * slender * s.fy / s.E) * s.fy * s.elastic_y);
  return std::min(plastic, 1.9 * s.E * cb / slender * s.elastic_y);
}

}  // namespace

double strong_strength(const SteelSection& s, double length, double cb, const Trail& trail) {
  const Slenderness plate = slenderness(s);
  trail.add(flexure_clause, "L_b", "between lateral restraints", length, of_length);
  trail.add(flexure_clause, "C_b", "given, or 12.5 M_max/(2.5 M_max + 3 M_A + 4 M_B + 3 M_C) (F1-1)", cb, plain_number);
  switch (s.kind) {
    case SteelSection::Kind::I:
      return open_strong(s, length, cb, trail);
    case SteelSection::Kind::box: {
      const double local = box_strength(s, s.plastic_y, s.Iy, s.depth, plate.flange, plate.web);
      const bool twists = s.depth > s.width && length > 0;
      return twists ? std::min(local, box_lateral(s, length, cb, s.fy * s.plastic_y)) : local;
    }
    case SteelSection::Kind::pipe:
      return pipe_strength(s);
    case SteelSection::Kind::solid:
      return bar_strength(s, length, cb);
    default:  // F12, with the critical stress of a shape whose warping is not known
      if (!(length > 0)) return s.fy * s.elastic_y;
      return std::min(s.fy * s.elastic_y,
                      cb * std::numbers::pi / length * std::sqrt(s.E * std::min(s.Iy, s.Iz) * s.G * s.J));
  }
}

static double weak_axis(const SteelSection& s) {
  const Slenderness plate = slenderness(s);
  switch (s.kind) {
    case SteelSection::Kind::I:
      return open_weak(s);
    case SteelSection::Kind::box:
      return box_strength(s, s.plastic_z, s.Iz, s.width, plate.web, plate.flange);
    case SteelSection::Kind::pipe:
      return pipe_strength(s);
    case SteelSection::Kind::solid:
      return std::min(s.fy * s.plastic_z, 1.6 * s.fy * s.elastic_z);
    default:
      return s.fy * s.elastic_z;
  }
}

double weak_strength(const SteelSection& s, const Trail& trail) {
  const double strength = weak_axis(s);
  trail.add(flexure_clause, "phi_b M_ny", "0.90 M_n about the weak axis (F6, F7, F8, F11, F12)", phi_flexure * strength,
            of_moment);
  return strength;
}

}  // namespace topple::structure::aisc360
