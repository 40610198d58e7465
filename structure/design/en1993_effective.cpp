#include "design/en1993_effective.h"

#include <algorithm>
#include <vector>

namespace topple::structure {

namespace {

/// A rectangle that does not count: its area, its distance from the axis of bending, its own second moment.
struct Gone {
  double area = 0, at = 0, own = 0;
};

Gone strip(double from, double to, double thickness) {
  const double height = to - from;
  return {height * thickness, (from + to) / 2, thickness * height * height * height / 12};
}

/// About an axis through the centroid of the whole section.
struct Remainder {
  double centroid = 0, inertia = 0;
};

Remainder without(double area, double inertia, const std::vector<Gone>& gone) {
  double moment = 0;
  for (const Gone& part : gone) {
    area -= part.area;
    moment -= part.area * part.at;
    inertia -= part.area * part.at * part.at + part.own;
  }
  const double centroid = moment / area;
  return {centroid, inertia - area * centroid * centroid};
}

/// The smaller of the moduli of both edges, each `edge` from the whole section's centroid.
double modulus(const Remainder& left, double edge) { return left.inertia / (edge + std::abs(left.centroid)); }

/// 4.4(2), lambda_p.
double slenderness(double width, double thickness, double k, double epsilon) {
  return width / thickness / (28.4 * epsilon * std::sqrt(k));
}

/// (4.2): a part held along both edges; psi: stress at the one over that at the other, compression positive.
double internal_part(double lambda, double psi) {
  return lambda <= 0.673 ? 1 : std::clamp((lambda - 0.055 * (3 + psi)) / (lambda * lambda), 0.0, 1.0);
}

/// (4.3): a part held along one edge.
double outstand(double lambda) { return lambda <= 0.748 ? 1 : std::min(1.0, (lambda - 0.188) / (lambda * lambda)); }

/// Table 4.1.
double buckling_coefficient(double psi) {
  if (psi >= 0) return 8.2 / (1.05 + psi);
  return psi > -1 ? 7.81 - 6.29 * psi + 9.78 * psi * psi : 5.98 * (1 - psi) * (1 - psi);
}

constexpr double uniform = 1, tip = 0;                                                    // psi
double outstand_coefficient(double psi) { return 0.57 - 0.21 * psi + 0.07 * psi * psi; }  // table 4.2, tip compressed

/// A section seen with the axis of bending level: webs from flange to flange, the compressed flange above.
struct Upright {
  double depth = 0, inertia = 0;             ///< of the whole section
  double web_length = 0, web_thickness = 0;  ///< of all webs side by side; the clear length of one
  double wall = 0;                           ///< thickness of one web
  Gone flange;                               ///< what of the compressed flange does not count
};

double bent(const SteelSection& s, const Upright& u, double epsilon, double* rho, double* ratio) {
  std::vector<Gone> gone{u.flange};
  const double top = u.web_length / 2;
  const double axis = without(s.area, u.inertia, gone).centroid;
  const double psi = (-top - axis) / (top - axis);
  const double counts = internal_part(slenderness(u.web_length, u.wall, buckling_coefficient(psi), epsilon), psi);
  if (counts < 1) {  // 0.4 of what is left at the compressed edge, 0.6 at the axis
    const double left = counts * (top - axis);
    gone.push_back(strip(axis + 0.6 * left, top - 0.4 * left, u.web_thickness));
  }
  if (rho != nullptr) *rho = counts;
  if (ratio != nullptr) *ratio = psi;
  return modulus(without(s.area, u.inertia, gone), u.depth / 2);
}

EffectiveSection of_box(const SteelSection& s, double epsilon) {
  EffectiveSection e;
  const double t = s.web, web = s.depth - s.corners, flange = s.width - s.corners;
  const double k = buckling_coefficient(uniform);
  e.web = internal_part(slenderness(web, t, k, epsilon), uniform);
  e.flange = internal_part(slenderness(flange, t, k, epsilon), uniform);
  e.area = s.area - 2 * t * ((1 - e.web) * web + (1 - e.flange) * flange);
  const auto wall = [t](double length, double counts, double depth) {
    const double area = (1 - counts) * length * t;
    return Gone{area, (depth - t) / 2, area * t * t / 12};
  };
  e.modulus_y = bent(s, {s.depth, s.Iy, web, 2 * t, t, wall(flange, e.flange, s.depth)}, epsilon, &e.web_in_bending,
                     &e.web_stress_ratio);
  e.modulus_z = bent(s, {s.width, s.Iz, flange, 2 * t, t, wall(web, e.web, s.width)}, epsilon, nullptr, nullptr);
  return e;
}

EffectiveSection of_i(const SteelSection& s, double epsilon) {
  EffectiveSection e;
  const double web = s.depth - 2 * s.flange - 2 * s.fillet, free = (s.width - s.web) / 2 - s.fillet;
  e.web = internal_part(slenderness(web, s.web, buckling_coefficient(uniform), epsilon), uniform);
  e.flange = outstand(slenderness(free, s.flange, outstand_coefficient(uniform), epsilon));
  const double tips = 2 * (1 - e.flange) * free * s.flange;  // of one flange
  e.area = s.area - (1 - e.web) * web * s.web - 2 * tips;
  e.modulus_y =
      bent(s, {s.depth, s.Iy, web, s.web, s.web, {tips, (s.depth - s.flange) / 2, tips * s.flange * s.flange / 12}},
           epsilon, &e.web_in_bending, &e.web_stress_ratio);
  // About z one outstand of either flange is compressed, most at its tip.
  const double counts = outstand(slenderness(free, s.flange, outstand_coefficient(tip), epsilon));
  const Gone sides = strip(s.width / 2 - (1 - counts) * free, s.width / 2, 2 * s.flange);
  e.modulus_z = modulus(without(s.area, s.Iz, {sides}), s.width / 2);
  return e;
}

}  // namespace

EffectiveSection effective_section(const SteelSection& steel) {
  const double epsilon = std::sqrt(235e6 / steel.fy);
  if (steel.kind == SteelSection::Kind::box) return of_box(steel, epsilon);
  if (steel.kind == SteelSection::Kind::I) return of_i(steel, epsilon);
  return {steel.area, steel.elastic_y, steel.elastic_z};
}

void trace_effective(const EffectiveSection& e, const Trail& trail) {
  const char* const clause = "EN 1993-1-5 4.4";
  trail.add(clause, "rho_w", "(lambda_p - 0.22)/lambda_p^2, of the web under compression (4.2)", e.web, plain_number);
  trail.add(clause, "rho_f", "of the flange under compression, (4.2) in boxes, (4.3) in I sections", e.flange,
            plain_number);
  trail.add(clause, "A_eff", "under compression alone", e.area, of_area);
  trail.add(clause, "psi", "of the web under M_y, with the effective flange (4.4(3))", e.web_stress_ratio,
            plain_number);
  trail.add(clause, "rho_w,M", "(lambda_p - 0.055 (3 + psi))/lambda_p^2 (4.2)", e.web_in_bending, plain_number);
  trail.add(clause, "W_eff,y", "under M_y alone, the smaller one", e.modulus_y, of_modulus);
  trail.add(clause, "W_eff,z", "under M_z alone, the smaller one", e.modulus_z, of_modulus);
}

}  // namespace topple::structure
