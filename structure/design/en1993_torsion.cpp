// EN 1993-1-1 6.2.7: torsion with warping.
#include <algorithm>

#include "design/en1993_parts.h"

namespace topple::structure::en1993 {

namespace {

constexpr const char* elastic = "EN 1993-1-1 6.2.7(5) (6.1)";
constexpr const char* plastic = "EN 1993-1-1 6.2.7(6) (6.2)";
/// Shear and normal stress of warping below this share of the yield strength leave the elastic check out: the plastic
/// one, in which they are added, goes over into 6.2.1 without them.
constexpr double significant = 0.05;

struct Stresses {
  double normal = 0, warping = 0, uniform = 0, flange_shear = 0;
};

Stresses stresses(const SteelSection& s, const SectionForces& at, const WarpingForces& w) {
  Stresses found;
  found.warping = warping_normal_stress(s, w.bimoment);
  found.normal = elastic_normal_stress(s, at) + found.warping;
  found.uniform = uniform_torsion_stress(s, w.uniform_torque);
  found.flange_shear =
      found.uniform + warping_shear_stress(s, w.warping_torque) + 1.5 * std::abs(at[1]) / (2 * s.width * s.flange);
  return found;
}

/// Von Mises at the flanges' tips, and shear in the middle of a flange.
double elastic_utilisation(const SteelSection& s, const Stresses& at) {
  const double tip = std::sqrt(at.normal * at.normal + 3 * at.uniform * at.uniform);
  return std::max(tip, std::sqrt(3.0) * at.flange_shear) * gamma_m0 / s.fy;
}

void trace(const SteelSection& s, const SectionForces& at, const WarpingForces& w, const Trail& trail) {
  const Stresses found = stresses(s, at, w);
  trail.add(elastic, "T_Ed", "at the governing section", at[3], of_moment);
  trail.add(elastic, "B_Ed", "bimoment: G I_t chi - E I_w chi'' = T, B = -E I_w chi'", w.bimoment, of_bimoment);
  trail.add(elastic, "T_t,Ed", "G I_t chi, uniform torsion", w.uniform_torque, of_moment);
  trail.add(elastic, "T_w,Ed", "T - T_t, warping torsion", w.warping_torque, of_moment);
  trail.add(elastic, "sigma_w", "B (h - t_f) b/4/I_w", found.warping, of_stress);
  trail.add(elastic, "sigma_x", "N/A + M_y/W_el,y + M_z/W_el,z + sigma_w", found.normal, of_stress);
  trail.add(elastic, "tau_t", "T_t t/I_t", found.uniform, of_stress);
  trail.add(elastic, "use", "sqrt(sigma_x^2 + 3 tau_t^2)/f_y, or sqrt(3) (tau_t + tau_w + tau_V)/f_y in the flange",
            elastic_utilisation(s, found), plain_number);
}

void check_warping(ClauseList& clauses, const SteelSection& s, const Resistance& r,
                   std::span<const SectionForces> stations, const std::vector<WarpingForces>& warping,
                   const Trail& trail) {
  double most = -1;
  std::size_t worst = 0;
  for (std::size_t k = 0; k < stations.size(); ++k) {
    const SectionForces& at = stations[k];
    const Stresses found = stresses(s, at, warping[k]);
    const double use = elastic_utilisation(s, found);
    if (found.warping + std::sqrt(3.0) * found.uniform > significant * s.fy) clauses.add(elastic, use);
    clauses.add(plastic, std::abs(at[0]) / r.axial + std::abs(at[4]) / r.moment_y + std::abs(at[5]) / r.moment_z +
                             found.warping * gamma_m0 / s.fy);
    if (use <= most) continue;
    most = use;
    worst = k;
  }
  if (trail.on()) trace(s, stations[worst], warping[worst], trail);
}

}  // namespace

double check_torsion(ClauseList& clauses, const SteelSection& steel, const Resistance& r, const DesignMember& member,
                     std::span<const SectionForces> stations, const Trail& trail) {
  const bool open = steel.kind == SteelSection::Kind::I || steel.kind == SteelSection::Kind::other;
  if (!open) return 0;
  double torque = 0;
  for (const SectionForces& at : stations) torque = std::max(torque, std::abs(at[3]));
  constexpr double rounding = 1e-9;
  if (torque <= rounding * r.moment_z) return 0;
  const bool known = steel.kind == SteelSection::Kind::I && steel.warping > 0 && steel.J > 0 &&
                     member.at.size() == stations.size() && stations.size() > 1;
  if (known) {
    const std::vector<WarpingForces> warping = worst_warping_forces(steel, member, stations);
    check_warping(clauses, steel, r, stations, warping, trail);
    double bimoment = 0;
    for (const WarpingForces& at : warping) bimoment = std::max(bimoment, at.bimoment);
    return bimoment;
  }
  const double share = torque / (r.torsion > 0 ? r.torsion : r.moment_z);
  if (share > negligible_torsion)
    clauses.refuse("its torsion is above " + std::to_string(static_cast<int>(100 * negligible_torsion)) +
                   " % of its resistance, and warping stresses of this section are not known (6.2.7)");
  return 0;
}

}  // namespace topple::structure::en1993
