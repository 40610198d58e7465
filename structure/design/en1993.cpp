// EN 1993-1-1:2005 with its recommended values gamma_M0 = gamma_M1 = 1.0.
#include <algorithm>
#include <numbers>

#include "en1993_class.h"
#include "steel_section.h"

namespace topple::structure {

namespace {

constexpr double gamma_m0 = 1.0, gamma_m1 = 1.0;

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

/// What the stations' checks share.
struct Resistance {
  double axial, moment_y, moment_z, shear_y, shear_z, torsion;
};

Resistance cross_section(const SteelSection& steel, const SectionClass& cls) {
  const bool plastic = cls.number <= 2 && steel.has_plastic;
  const double shear_strength = cls.fy / std::sqrt(3.0) / gamma_m0;
  return {steel.area * cls.fy / gamma_m0,
          (plastic ? steel.plastic_y : steel.elastic_y) * cls.fy / gamma_m0,
          (plastic ? steel.plastic_z : steel.elastic_z) * cls.fy / gamma_m0,
          steel.shear_y * shear_strength,
          steel.shear_z * shear_strength,
          steel.torsion * shear_strength};
}

/// 6.2.8(3): factor on the moment resistance where the shear is above half of its own.
double shear_factor(double use) { return use <= 0.5 ? 1 : std::max(0.0, 1 - std::pow(2 * std::min(use, 1.0) - 1, 2)); }

double ratio(double demand, double resistance) {
  if (demand == 0) return 0;
  return resistance > 0 ? std::abs(demand) / resistance : 0;  // a shear area of 0 is not known: not checked
}

void check_sections(ClauseList& clauses, const Resistance& r, std::span<const SectionForces> stations) {
  for (const SectionForces& at : stations) {
    const double torsion = ratio(at[3], r.torsion);
    const double shear_y = ratio(at[1], r.shear_y) + torsion, shear_z = ratio(at[2], r.shear_z) + torsion;
    if (r.shear_y > 0 && r.shear_z > 0) clauses.add("EN 1993-1-1 6.2.6 (6.17)", std::max(shear_y, shear_z));
    if (r.torsion > 0) clauses.add("EN 1993-1-1 6.2.7 (6.23)", torsion);
    const double moments = std::abs(at[4]) / (r.moment_y * std::max(shear_factor(shear_z), 1e-3)) +
                           std::abs(at[5]) / (r.moment_z * std::max(shear_factor(shear_y), 1e-3));
    clauses.add("EN 1993-1-1 6.2.1 (6.2)", std::abs(at[0]) / r.axial + moments);
  }
}

struct Reductions {
  double y = 1, z = 1, torsional = 1, lateral = 1;
  double slenderness_y = 0, slenderness_z = 0;
};

Reductions reductions(const SteelSection& steel, const DesignMember& member, double fy, double lateral_modulus) {
  const Curves curve = buckling_curves(steel);
  Reductions r;
  const double squash = steel.area * fy;
  if (member.lengths.y > 0) {
    r.slenderness_y = std::sqrt(squash / euler(steel.E, steel.Iy, member.lengths.y));
    r.y = reduction(r.slenderness_y, curve.y);
  }
  if (member.lengths.z > 0) {
    r.slenderness_z = std::sqrt(squash / euler(steel.E, steel.Iz, member.lengths.z));
    r.z = reduction(r.slenderness_z, curve.z);
  }
  // A section given as numbers may be open; without its warping stiffness it is taken as less than it is.
  const bool open = steel.kind == SteelSection::Kind::I || steel.kind == SteelSection::Kind::other;
  if (open && member.lengths.torsion > 0) {  // 6.3.1.4
    const double polar = (steel.Iy + steel.Iz) / steel.area;
    const double ncr = (steel.G * steel.J + euler(steel.E, steel.warping, member.lengths.torsion)) / polar;
    r.torsional = reduction(std::sqrt(squash / ncr), curve.z);
  }
  const bool twists = open || (steel.kind == SteelSection::Kind::solid && steel.depth > steel.width);
  if (twists && member.lengths.lateral > 0) {  // 6.3.2.2
    const double mcr = critical_moment(steel, member.lengths.lateral, member.factors.critical_moment);
    r.lateral = reduction(std::sqrt(lateral_modulus * fy / mcr), curve.lateral);
  }
  return r;
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

void check_buckling(ClauseList& clauses, const SteelSection& steel, const DesignMember& member, const SectionClass& cls,
                    const Resistance& section, const LargestForces& forces) {
  const Reductions r = reductions(steel, member, cls.fy, section.moment_y * gamma_m0 / cls.fy);
  const double moment_y = forces.moment_y / (r.lateral * section.moment_y * gamma_m0 / gamma_m1);
  const double moment_z = forces.moment_z / (section.moment_z * gamma_m0 / gamma_m1);
  clauses.add("EN 1993-1-1 6.3.2 (6.54)", moment_y);
  if (forces.compression == 0) return;
  const double chi_z = std::min(r.z, r.torsional);
  const double squash = section.axial * gamma_m0 / gamma_m1;
  const double ny = forces.compression / (r.y * squash), nz = forces.compression / (chi_z * squash);
  clauses.add("EN 1993-1-1 6.3.1 (6.46)", std::max(ny, nz));
  const Interaction6_3_3 k = interaction(steel, cls.number, member.factors, r, ny, nz);
  clauses.add("EN 1993-1-1 6.3.3 (6.61)", ny + k.yy * moment_y + k.yz * moment_z);
  clauses.add("EN 1993-1-1 6.3.3 (6.62)", nz + k.zy * moment_y + k.zz * moment_z);
}

}  // namespace

DesignResult check_en1993(const DesignMember& member, std::span<const SectionForces> stations) {
  const SteelSection steel = steel_section(*member.section, *member.material);
  const LargestForces forces = largest_forces(stations);
  const SectionClass cls = classify_en1993(steel, forces.compression);
  const Resistance section = cross_section(steel, cls);
  ClauseList clauses;
  check_sections(clauses, section, stations);
  check_buckling(clauses, steel, member, cls, section, forces);
  return clauses.result();
}

}  // namespace topple::structure
