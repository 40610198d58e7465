// EN 1993-1-1 6.3: buckling resistance of members.
#include <algorithm>
#include <numbers>

#include "design/en1993_parts.h"
#include "design/moment_shape.h"

namespace topple::structure::en1993 {

namespace {

/// Imperfection factors of the buckling curves, table 6.1.
struct Curve {
  static constexpr double a0 = 0.13, a = 0.21, b = 0.34, c = 0.49, d = 0.76;
};

struct Curves {
  double y = Curve::c, z = Curve::c, lateral = Curve::d;
};

/// Tables 6.2 and 6.4 for steels up to S420.
Curves buckling_curves(const SteelSection& steel) {
  const double slender = steel.depth / steel.width;
  if (steel.kind == SteelSection::Kind::I && steel.rolled) {
    const double lateral = slender <= 2 ? Curve::a : Curve::b;
    if (slender > 1.2)
      return steel.flange <= 0.040 ? Curves{Curve::a, Curve::b, lateral} : Curves{Curve::b, Curve::c, lateral};
    return steel.flange <= 0.100 ? Curves{Curve::b, Curve::c, lateral} : Curves{Curve::d, Curve::d, lateral};
  }
  if (steel.kind == SteelSection::Kind::I) {
    const double lateral = slender <= 2 ? Curve::c : Curve::d;
    return steel.flange <= 0.040 ? Curves{Curve::b, Curve::c, lateral} : Curves{Curve::c, Curve::d, lateral};
  }
  return {};  // hollow sections as if cold formed, solid and other shapes: c
}

/// Reduction factor of 6.3.1.2 (6.49), with the plateau up to a slenderness of 0.2.
double reduction(double slenderness, double imperfection) {
  if (slenderness <= 0.2) return 1;
  const double phi = 0.5 * (1 + imperfection * (slenderness - 0.2) + slenderness * slenderness);
  return std::min(1.0, 1 / (phi + std::sqrt(phi * phi - slenderness * slenderness)));
}

double euler(double E, double inertia, double length) {
  return std::numbers::pi * std::numbers::pi * E * inertia / (length * length);
}

/// Elastic critical moment of a doubly symmetric section, k = kw = 1, load at the shear centre.
double critical_moment(const SteelSection& steel, double length, double c1) {
  const double ncr = euler(steel.E, steel.Iz, length);
  return c1 * ncr * std::sqrt(steel.warping / steel.Iz + steel.G * steel.J / ncr);
}

struct Reductions {
  double y = 1, z = 1, torsional = 1;
  double slenderness_y = 0, slenderness_z = 0;
};

constexpr const char* flexural = "EN 1993-1-1 6.3.1 (6.46)";
constexpr const char* beam_column = "EN 1993-1-1 6.3.3 (6.61)";
constexpr const char* lateral = "EN 1993-1-1 6.3.2 (6.54)";

/// 6.3.1.2 for one way of buckling with its critical force.
double reduction_of(double squash, double critical, double imperfection, double& slenderness) {
  slenderness = std::sqrt(squash / critical);
  return reduction(slenderness, imperfection);
}

/// `squash`: A f_y, in class 4 A_eff f_y. `clause`: that asks for them.
Reductions reductions(const SteelSection& steel, const DesignMember& member, double squash, const char* clause,
                      const Trail& trail) {
  const Curves curve = buckling_curves(steel);
  Reductions r;
  if (member.lengths.y > 0) {
    const double ncr = euler(steel.E, steel.Iy, member.lengths.y);
    r.y = reduction_of(squash, ncr, curve.y, r.slenderness_y);
    trail.add(clause, "L_cr,y", "K_y L", member.lengths.y, of_length);
    trail.add(clause, "N_cr,y", "pi^2 E I_y/L_cr,y^2", ncr, of_force);
    trail.add(clause, "lambda_y", "sqrt(A f_y/N_cr,y) (6.50)", r.slenderness_y, plain_number);
    trail.add(clause, "alpha_y", "table 6.1, 6.2", curve.y, plain_number);
    trail.add(clause, "chi_y", "1/(Phi + sqrt(Phi^2 - lambda^2)) (6.49)", r.y, plain_number);
  }
  if (member.lengths.z > 0) {
    const double ncr = euler(steel.E, steel.Iz, member.lengths.z);
    r.z = reduction_of(squash, ncr, curve.z, r.slenderness_z);
    trail.add(clause, "L_cr,z", "K_z L", member.lengths.z, of_length);
    trail.add(clause, "N_cr,z", "pi^2 E I_z/L_cr,z^2", ncr, of_force);
    trail.add(clause, "lambda_z", "sqrt(A f_y/N_cr,z) (6.50)", r.slenderness_z, plain_number);
    trail.add(clause, "alpha_z", "table 6.1, 6.2", curve.z, plain_number);
    trail.add(clause, "chi_z", "1/(Phi + sqrt(Phi^2 - lambda^2)) (6.49)", r.z, plain_number);
  }
  // A section given as numbers may be open; without its warping stiffness it is taken as less than it is.
  const bool open = steel.kind == SteelSection::Kind::I || steel.kind == SteelSection::Kind::other;
  if (open && member.lengths.torsion > 0) {  // 6.3.1.4
    const double polar = (steel.Iy + steel.Iz) / steel.area;
    const double ncr = (steel.G * steel.J + euler(steel.E, steel.warping, member.lengths.torsion)) / polar;
    double slenderness = 0;
    r.torsional = reduction_of(squash, ncr, curve.z, slenderness);
    trail.add(clause, "L_T", "between places that do not twist", member.lengths.torsion, of_length);
    trail.add(clause, "N_cr,T", "(G I_t + pi^2 E I_w/L_T^2)/i_0^2", ncr, of_force);
    trail.add(clause, "lambda_T", "sqrt(A f_y/N_cr,T) (6.52)", slenderness, plain_number);
    trail.add(clause, "chi_T", "1/(Phi + sqrt(Phi^2 - lambda^2)) (6.49)", r.torsional, plain_number);
  }
  return r;
}

struct LateralUtilisation {
  double use = 0, chi = 1;  ///< M_y,Ed/M_b,Rd of the stretch in which it is largest, and its reduction
};

void trace_lateral(const CheckedStretch& stretch, double mcr, double slenderness, double chi, const Trail& trail) {
  trail.add(lateral, "L_cr,LT", "between lateral restraints", stretch.length, of_length);
  trail.add(lateral, "C_1", "given, or sqrt(35 M_max^2/(M_max^2 + 9 M_2^2 + 16 M_3^2 + 9 M_4^2)) (Serna 2006)",
            stretch.factor, plain_number);
  trail.add(lateral, "M_cr", "C_1 pi^2 E I_z/L^2 sqrt(I_w/I_z + L^2 G I_t/(pi^2 E I_z))", mcr, of_moment);
  trail.add(lateral, "lambda_LT", "sqrt(W_y f_y/M_cr)", slenderness, plain_number);
  trail.add(lateral, "chi_LT", "curve of table 6.4, 6.3.2.2 (6.56)", chi, plain_number);
}

/// 6.3.2.2: every stretch between restraints by itself.
LateralUtilisation lateral_utilisation(const SteelSection& steel, const DesignMember& member, const SectionClass& cls,
                                       double resistance, std::span<const SectionForces> stations, const Trail& trail) {
  const bool open = steel.kind == SteelSection::Kind::I || steel.kind == SteelSection::Kind::other;
  const bool twists = open || (steel.kind == SteelSection::Kind::solid && steel.depth > steel.width);
  const double imperfection = buckling_curves(steel).lateral, modulus = resistance * gamma_m0 / cls.fy;
  LateralUtilisation worst;
  CheckedStretch told;
  double told_mcr = 0, told_slenderness = 0;
  for (const CheckedStretch& stretch : checked_stretches(member, stations, moment_factor_serna)) {
    double chi = 1, mcr = 0, slenderness = 0;
    if (twists && stretch.length > 0) {
      mcr = critical_moment(steel, stretch.length, stretch.factor);
      slenderness = std::sqrt(modulus * cls.fy / mcr);
      chi = reduction(slenderness, imperfection);
    }
    const double use = stretch.moment / (chi * resistance * gamma_m0 / gamma_m1);
    if (use < worst.use || (use == worst.use && chi >= worst.chi)) continue;
    worst = {use, chi};
    told = stretch;
    told_mcr = mcr;
    told_slenderness = slenderness;
  }
  if (told_mcr > 0) trace_lateral(told, told_mcr, told_slenderness, worst.chi, trail);
  trail.add(lateral, "M_b,Rd", "chi_LT W_y f_y/gamma_M1 (6.55)", worst.chi * resistance * gamma_m0 / gamma_m1,
            of_moment);
  return worst;
}

/// Interaction factors of annex B (method 2), tables B.1 and B.2.
struct Interaction6_3_3 {
  double yy, yz, zy, zz;
};

Interaction6_3_3 interaction(const SteelSection& steel, int cls, const MomentFactors& c, const Reductions& r, double ny,
                             double nz) {
  const bool open = steel.kind == SteelSection::Kind::I;
  const double cmlt = c.equivalent_y;
  Interaction6_3_3 k{};
  if (cls <= 2) {
    k.yy = c.equivalent_y * std::min(1 + (r.slenderness_y - 0.2) * ny, 1 + 0.8 * ny);
    k.zz = open ? c.equivalent_z * std::min(1 + (2 * r.slenderness_z - 0.6) * nz, 1 + 1.4 * nz)
                : c.equivalent_z * std::min(1 + (r.slenderness_z - 0.2) * nz, 1 + 0.8 * nz);
    k.yz = 0.6 * k.zz;
    k.zy = 0.6 * k.yy;
    if (open) {  // susceptible to torsional deformations
      const double floor = 1 - 0.1 / (cmlt - 0.25) * nz, sloped = 1 - 0.1 * r.slenderness_z / (cmlt - 0.25) * nz;
      k.zy = r.slenderness_z < 0.4 ? std::min(0.6 + r.slenderness_z, sloped) : std::max(sloped, floor);
    }
  } else {
    k.yy = c.equivalent_y * std::min(1 + 0.6 * r.slenderness_y * ny, 1 + 0.6 * ny);
    k.zz = c.equivalent_z * std::min(1 + 0.6 * r.slenderness_z * nz, 1 + 0.6 * nz);
    k.yz = k.zz;
    k.zy = 0.8 * k.yy;
    if (open) k.zy = std::max(1 - 0.05 * r.slenderness_z / (cmlt - 0.25) * nz, 1 - 0.05 / (cmlt - 0.25) * nz);
  }
  // The moment may not count for less than nothing of what it is at small axial force.
  k.yy = std::max(k.yy, 0.0);
  k.zz = std::max(k.zz, 0.0);
  return k;
}

void trace_interaction(const Interaction6_3_3& k, double ny, double nz, double my, double mz, const Trail& trail) {
  const char* const clause = beam_column;
  trail.add(clause, "n_y", "N_Ed/(chi_y N_Rk/gamma_M1)", ny, plain_number);
  trail.add(clause, "n_z", "N_Ed/(min(chi_z, chi_T) N_Rk/gamma_M1)", nz, plain_number);
  trail.add(clause, "m_y", "M_y,Ed/(chi_LT M_y,Rk/gamma_M1)", my, plain_number);
  trail.add(clause, "m_z", "M_z,Ed/(M_z,Rk/gamma_M1)", mz, plain_number);
  trail.add(clause, "k_yy", "annex B", k.yy, plain_number);
  trail.add(clause, "k_yz", "annex B", k.yz, plain_number);
  trail.add(clause, "k_zy", "annex B", k.zy, plain_number);
  trail.add(clause, "k_zz", "annex B", k.zz, plain_number);
}

/// EN 1993-6 annex A (A.1): a bimoment beside lateral-torsional buckling.
void check_with_bimoment(ClauseList& clauses, const SteelSection& s, const MomentFactors& factors, double bimoment,
                         double my, double mz, double critical_share, const Trail& trail) {
  const double of_bimoment = warping_normal_stress(s, bimoment) * gamma_m1 / s.fy;
  const double kw = 0.7 - 0.2 * of_bimoment, kzw = std::max(0.0, 1 - mz);
  const double ka = critical_share < 1 ? 1 / (1 - critical_share) : unlimited;
  const double use = my + factors.equivalent_z * mz + std::max(0.0, kw * kzw) * ka * of_bimoment;
  clauses.add("EN 1993-6 A (A.1)", use);
  trail.add("EN 1993-6 A (A.1)", "b", "B_Ed/(B_Rk/gamma_M1)", of_bimoment, plain_number);
  trail.add("EN 1993-6 A (A.1)", "k_w", "0.7 - 0.2 B_Ed/(B_Rk/gamma_M1)", kw, plain_number);
  trail.add("EN 1993-6 A (A.1)", "k_zw", "1 - M_z,Ed/(M_z,Rk/gamma_M1)", kzw, plain_number);
  trail.add("EN 1993-6 A (A.1)", "k_alpha", "1/(1 - M_y,Ed/M_y,cr)", ka, plain_number);
}

/// 6.3.1: compression by itself, under which a web may be of class 4 that is not under bending as well.
void check_flexural(ClauseList& clauses, const SteelSection& steel, const DesignMember& member, const SectionClass& cls,
                    const LargestForces& forces, const Trail& trail) {
  const double squash = cls.pressed_area * cls.fy;
  const Reductions r = reductions(steel, member, squash, flexural, trail);
  const double resistance = std::min({r.y, r.z, r.torsional}) * squash / gamma_m1;
  clauses.add(flexural, forces.compression / resistance);
  trail.add(flexural, "N_b,Rd", "min(chi_y, chi_z, chi_T) A f_y/gamma_M1, A_eff in class 4 (6.47, 6.48)", resistance,
            of_force);
}

}  // namespace

void check_buckling(ClauseList& clauses, const SteelSection& steel, const DesignMember& member, const SectionClass& cls,
                    const Resistance& section, const LargestForces& forces, double bimoment,
                    std::span<const SectionForces> stations, const Trail& trail) {
  const LateralUtilisation lateral_buckling =
      lateral_utilisation(steel, member, cls, section.moment_y, stations, trail);
  const double moment_y = lateral_buckling.use;
  const double moment_z = forces.moment_z / (section.moment_z * gamma_m0 / gamma_m1);
  clauses.add(lateral, moment_y);
  if (bimoment > 0) {
    double critical_share = 0;
    for (const CheckedStretch& stretch : checked_stretches(member, stations, moment_factor_serna))
      if (stretch.length > 0)
        critical_share =
            std::max(critical_share, stretch.moment / critical_moment(steel, stretch.length, stretch.factor));
    check_with_bimoment(clauses, steel, member.factors, bimoment, moment_y, moment_z, critical_share, trail);
  }
  if (forces.compression == 0) return;
  check_flexural(clauses, steel, member, cls, forces, trail);
  const double squash = section.axial * gamma_m0 / gamma_m1;
  const bool told = squash == cls.pressed_area * cls.fy / gamma_m1;  // by 6.3.1 already
  const Reductions r = reductions(steel, member, section.axial * gamma_m0, beam_column, told ? Trail() : trail);
  const double ny = forces.compression / (r.y * squash);
  const double nz = forces.compression / (std::min(r.z, r.torsional) * squash);
  constexpr double rounding = 1e-9;
  const int worse_class = moment_z > rounding ? std::max(cls.number, cls.about_z) : cls.number;
  const Interaction6_3_3 k = interaction(steel, worse_class, member.factors, r, ny, nz);
  trace_interaction(k, ny, nz, moment_y, moment_z, trail);
  clauses.add("EN 1993-1-1 6.3.3 (6.61)", ny + k.yy * moment_y + k.yz * moment_z);
  clauses.add("EN 1993-1-1 6.3.3 (6.62)", nz + k.zy * moment_y + k.zz * moment_z);
}

}  // namespace topple::structure::en1993
