// AISC 360-16, load and resistance factor design. Local y is the strong axis (x in the specification), local z the weak
// one (y in the specification).
#include <algorithm>
#include <numbers>

#include "steel_section.h"

namespace topple::structure {

namespace {

constexpr double phi_axial = 0.90, phi_flexure = 0.90, phi_shear = 0.90, phi_rolled_web = 1.00, phi_torsion = 0.90;
constexpr double pi2 = std::numbers::pi * std::numbers::pi;

bool is_box(const SteelSection& s) { return s.kind == SteelSection::Kind::box; }
bool is_open(const SteelSection& s) { return s.kind == SteelSection::Kind::I; }

/// Slendernesses of table B4.1: half flange and clear web of I shapes; flat walls of boxes (outside less three wall
/// thicknesses); diameter over wall of pipes.
struct Slenderness {
  double flange = 0, web = 0;
};

Slenderness slenderness(const SteelSection& s) {
  switch (s.kind) {
    case SteelSection::Kind::I:
      return {s.width / (2 * s.flange), (s.depth - 2 * s.flange - 2 * s.fillet) / s.web};
    case SteelSection::Kind::box:
      return {s.width / s.web - 3, s.depth / s.web - 3};
    case SteelSection::Kind::pipe:
      return {s.depth / s.web, s.depth / s.web};
    default:
      return {};
  }
}

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
    const double flange = effective_share(plate.flange, 0.56 * root, s.fy, fcr, 0.22, 1.49);
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

/// Chapter E: nominal compressive strength (E3, E4, E7).
double compressive_strength(const SteelSection& s, const BucklingLengths& lengths) {
  double elastic = unlimited;
  if (lengths.y > 0) elastic = std::min(elastic, pi2 * s.E / std::pow(lengths.y / s.radius_y(), 2));
  if (lengths.z > 0) elastic = std::min(elastic, pi2 * s.E / std::pow(lengths.z / s.radius_z(), 2));
  if (is_open(s) && lengths.torsion > 0)  // E4-2
    elastic = std::min(elastic, (pi2 * s.E * s.warping / std::pow(lengths.torsion, 2) + s.G * s.J) / (s.Iy + s.Iz));
  const double fcr = s.fy / elastic <= 2.25 ? std::pow(0.658, s.fy / elastic) * s.fy : 0.877 * elastic;
  return fcr * effective_area(s, fcr);
}

/// F2-2 to F2-4: lateral-torsional buckling of an I shape whose strength without it is `plain`.
double lateral_strength(const SteelSection& s, double length, double cb, double plain) {
  const double ho = s.depth - s.flange;
  const double rts = std::sqrt(std::sqrt(s.Iz * s.warping) / s.elastic_y);
  const double jc = s.J / (s.elastic_y * ho);
  const double residual = 0.7 * s.fy;
  const double lp = 1.76 * s.radius_z() * std::sqrt(s.E / s.fy);
  const double lr =
      1.95 * rts * s.E / residual * std::sqrt(jc + std::sqrt(jc * jc + 6.76 * std::pow(residual / s.E, 2)));
  if (length <= lp) return plain;
  if (length <= lr) return std::min(plain, cb * (plain - (plain - residual * s.elastic_y) * (length - lp) / (lr - lp)));
  const double slender = length / rts;
  const double fcr = cb * pi2 * s.E / (slender * slender) * std::sqrt(1 + 0.078 * jc * slender * slender);
  return std::min(plain, fcr * s.elastic_y);
}

/// Straight line between the plastic moment at `compact` and the residual-stress moment at `noncompact`.
double between(double lambda, double compact, double noncompact, double plastic, double reduced) {
  if (lambda <= compact) return plastic;
  return plastic - (plastic - reduced) * std::min(1.0, (lambda - compact) / (noncompact - compact));
}

/// F2 to F5: I shape about its strong axis.
double open_strong(const SteelSection& s, double length, double cb) {
  const double root = std::sqrt(s.E / s.fy);
  const Slenderness plate = slenderness(s);
  const double yield = s.fy * s.elastic_y;
  double plain = s.fy * s.plastic_y;
  if (plate.web > 3.76 * root) plain = yield;  // F4 with R_pc = 1
  if (plate.web > 5.70 * root) {               // F5-6
    const double aw = std::min(10.0, plate.web * s.web * s.web / (s.width * s.flange));
    plain = yield * std::min(1.0, 1 - aw / (1200 + 300 * aw) * (plate.web - 5.70 * root));
  }
  double local = between(plate.flange, 0.38 * root, 1.0 * root, plain, std::min(plain, 0.7 * yield));  // F3-1
  if (plate.flange > 1.0 * root) {
    const double kc = std::clamp(4 / std::sqrt(plate.web), 0.35, 0.76);
    local = std::min(plain, 0.9 * s.E * kc * s.elastic_y / (plate.flange * plate.flange));  // F3-2
  }
  return length > 0 ? std::min(local, lateral_strength(s, length, cb, plain)) : local;
}

/// F6: I shape about its weak axis.
double open_weak(const SteelSection& s) {
  const double root = std::sqrt(s.E / s.fy), lambda = slenderness(s).flange;
  const double plastic = std::min(s.fy * s.plastic_z, 1.6 * s.fy * s.elastic_z);
  if (lambda > 1.0 * root) return std::min(plastic, 0.69 * s.E / (lambda * lambda) * s.elastic_z);
  return between(lambda, 0.38 * root, 1.0 * root, plastic, 0.7 * s.fy * s.elastic_z);
}

/// F7: box about an axis; `flange` and `web` are the slendernesses of its walls for that axis.
double box_strength(const SteelSection& s, double plastic_modulus, double elastic_modulus, double flange, double web) {
  const double root = std::sqrt(s.E / s.fy);
  const double plastic = s.fy * plastic_modulus, yield = s.fy * elastic_modulus;
  double strength = plastic;
  if (flange > 1.40 * root) {  // F7-3 with the effective width of F7-4 taken out of the compression flange
    const double share = std::min(1.0, 1.92 * root / flange * (1 - 0.38 / flange * root));
    strength = yield * std::max(0.0, 1 - (1 - share) * 0.5);
  } else if (flange > 1.12 * root) {
    strength = std::min(plastic, plastic - (plastic - yield) * (3.57 * flange / root - 4.0));
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

double strong_strength(const SteelSection& s, const DesignMember& member) {
  const double length = member.lengths.lateral, cb = member.factors.critical_moment;
  const Slenderness plate = slenderness(s);
  switch (s.kind) {
    case SteelSection::Kind::I:
      return open_strong(s, length, cb);
    case SteelSection::Kind::box: {
      const double local = box_strength(s, s.plastic_y, s.elastic_y, plate.flange, plate.web);
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

double weak_strength(const SteelSection& s) {
  const Slenderness plate = slenderness(s);
  switch (s.kind) {
    case SteelSection::Kind::I:
      return open_weak(s);
    case SteelSection::Kind::box:
      return box_strength(s, s.plastic_z, s.elastic_z, plate.web, plate.flange);
    case SteelSection::Kind::pipe:
      return pipe_strength(s);
    case SteelSection::Kind::solid:
      return std::min(s.fy * s.plastic_z, 1.6 * s.fy * s.elastic_z);
    default:
      return s.fy * s.elastic_z;
  }
}

/// G2-9 to G2-11: C_v2 of a plate of slenderness `lambda` with buckling coefficient `kv`.
double shear_coefficient(const SteelSection& s, double lambda, double kv) {
  const double root = std::sqrt(kv * s.E / s.fy);
  if (lambda <= 1.10 * root) return 1;
  if (lambda <= 1.37 * root) return 1.10 * root / lambda;
  return 1.51 * kv * s.E / (lambda * lambda * s.fy);
}

struct Strengths {
  double tension, compression, moment_y, moment_z, shear_y, shear_z, torsion;
};

/// Chapter G: design shear strengths along local y and z.
void set_shear(Strengths& r, const SteelSection& s) {
  const Slenderness plate = slenderness(s);
  const double stress = 0.6 * s.fy;
  switch (s.kind) {
    case SteelSection::Kind::I: {
      const double root = std::sqrt(s.E / s.fy);
      const bool stocky = s.rolled && plate.web <= 2.24 * root;  // G2.1(a)
      const double cv1 =
          plate.web <= 1.10 * std::sqrt(5.34 * s.E / s.fy) ? 1 : 1.10 * std::sqrt(5.34 * s.E / s.fy) / plate.web;
      r.shear_z = (stocky ? phi_rolled_web : phi_shear * cv1) * stress * s.depth * s.web;
      r.shear_y = phi_shear * stress * 2 * s.width * s.flange * shear_coefficient(s, plate.flange, 1.2);  // G6
      break;
    }
    case SteelSection::Kind::box:  // G4
      r.shear_z = phi_shear * stress * 2 * plate.web * s.web * s.web * shear_coefficient(s, plate.web, 5);
      r.shear_y = phi_shear * stress * 2 * plate.flange * s.web * s.web * shear_coefficient(s, plate.flange, 5);
      break;
    case SteelSection::Kind::pipe: {  // G5, without the benefit of a short shear span
      const double buckling = 0.78 * s.E / std::pow(plate.web, 1.5);
      r.shear_y = r.shear_z = phi_shear * std::min(stress, buckling) * s.area / 2;
      break;
    }
    default:
      r.shear_y = phi_shear * stress * s.shear_y;
      r.shear_z = phi_shear * stress * s.shear_z;
  }
}

Strengths strengths(const SteelSection& s, const DesignMember& member) {
  Strengths r{};
  r.tension = phi_axial * s.fy * s.area;  // D2-1
  r.compression = phi_axial * compressive_strength(s, member.lengths);
  r.moment_y = phi_flexure * strong_strength(s, member);
  r.moment_z = phi_flexure * weak_strength(s);
  r.torsion = phi_torsion * 0.6 * s.fy * s.torsion;  // H3-1, H3-8
  set_shear(r, s);
  return r;
}

/// H1-1a and H1-1b.
double interaction(double axial, double moments) {
  return axial >= 0.2 ? axial + 8.0 / 9.0 * moments : axial / 2 + moments;
}

}  // namespace

DesignResult check_aisc360(const DesignMember& member, std::span<const SectionForces> stations) {
  const SteelSection steel = steel_section(*member.section, *member.material);
  const LargestForces forces = largest_forces(stations);
  const Strengths r = strengths(steel, member);
  ClauseList clauses;
  const double moments = forces.moment_y / r.moment_y + forces.moment_z / r.moment_z;
  if (forces.compression > 0) {
    clauses.add("AISC 360 E1", forces.compression / r.compression);
    clauses.add("AISC 360 H1-1", interaction(forces.compression / r.compression, moments));
  }
  if (forces.tension > 0) {
    clauses.add("AISC 360 D2", forces.tension / r.tension);
    clauses.add("AISC 360 H1-1 (tension)", interaction(forces.tension / r.tension, moments));
  }
  clauses.add("AISC 360 F1", std::max(forces.moment_y / r.moment_y, forces.moment_z / r.moment_z));
  if (r.shear_y > 0 && r.shear_z > 0)
    clauses.add("AISC 360 G1", std::max(forces.shear_y / r.shear_y, forces.shear_z / r.shear_z));
  if (r.torsion > 0 && forces.torsion > 0) {
    const double torsion = forces.torsion / r.torsion;
    clauses.add("AISC 360 H3-1", torsion);
    if (torsion > 0.2) {  // H3-6
      const double axial = std::max(forces.compression / r.compression, forces.tension / r.tension);
      const double shear =
          std::max(r.shear_y > 0 ? forces.shear_y / r.shear_y : 0, r.shear_z > 0 ? forces.shear_z / r.shear_z : 0);
      clauses.add("AISC 360 H3-6", axial + moments + std::pow(shear + torsion, 2));
    }
  }
  return clauses.result();
}

}  // namespace topple::structure
