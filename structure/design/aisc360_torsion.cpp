// AISC 360-16 H3.3: torsion of open sections, with warping.
#include <algorithm>

#include "design/aisc360_parts.h"
#include "design/warping_torsion.h"

namespace topple::structure::aisc360 {

namespace {

constexpr const char* normal = "AISC 360 H3-7";
constexpr const char* shear = "AISC 360 H3-8";
constexpr const char* buckling = "AISC 360 H3-9";
/// Stresses of torsion below this share of F_y leave the elastic limit out: H3-9 goes over into H1 without them.
constexpr double significant = 0.05;
/// Torsion below this share of its strength is left out where warping cannot be found.
constexpr double negligible = 0.02;

struct Stresses {
  double warping = 0, normal = 0, uniform = 0, shear = 0;
};

Stresses stresses(const SteelSection& s, const SectionForces& at, const WarpingForces& w) {
  Stresses found;
  found.warping = warping_normal_stress(s, w.bimoment);
  found.normal = elastic_normal_stress(s, at) + found.warping;
  found.uniform = uniform_torsion_stress(s, w.uniform_torque);
  const double in_web = std::abs(w.uniform_torque) * s.web / s.J + std::abs(at[2]) / (s.depth * s.web);
  const double in_flange = std::abs(w.uniform_torque) * s.flange / s.J + warping_shear_stress(s, w.warping_torque) +
                           1.5 * std::abs(at[1]) / (2 * s.width * s.flange);
  found.shear = std::max(in_web, in_flange);
  return found;
}

void trace(const SteelSection& s, const SectionForces& at, const WarpingForces& w, const Trail& trail) {
  const Stresses found = stresses(s, at, w);
  trail.add(normal, "T_u", "at the governing section", at[3], of_moment);
  trail.add(normal, "B", "bimoment: G J chi - E C_w chi'' = T, B = -E C_w chi'", w.bimoment, of_bimoment);
  trail.add(normal, "sigma_w", "B W_no/C_w, W_no = h_o b_f/4", found.warping, of_stress);
  trail.add(normal, "F_u", "P/A + M_x/S_x + M_y/S_y + sigma_w", found.normal, of_stress);
  trail.add(normal, "phi_T F_n", "0.90 F_y (H3-7)", phi_torsion * s.fy, of_stress);
  trail.add(shear, "tau_u", "largest of web and flange: V, G J chi, warping", found.shear, of_stress);
  trail.add(shear, "phi_T F_n", "0.90 0.6 F_y (H3-8)", phi_torsion * 0.6 * s.fy, of_stress);
}

}  // namespace

void check_open_torsion(ClauseList& clauses, const SteelSection& s, const DesignMember& member,
                        std::span<const SectionForces> stations, double without_torsion, const Trail& trail) {
  if (s.kind != SteelSection::Kind::I && s.kind != SteelSection::Kind::other) return;
  double torque = 0;
  for (const SectionForces& at : stations) torque = std::max(torque, std::abs(at[3]));
  constexpr double rounding = 1e-9;
  if (torque <= rounding * s.fy * s.elastic_z) return;
  const bool known =
      is_open(s) && s.warping > 0 && s.J > 0 && member.at.size() == stations.size() && stations.size() > 1;
  if (!known) {
    const double strength = phi_torsion * 0.6 * s.fy * (s.torsion > 0 ? s.torsion : s.elastic_z);
    if (torque > negligible * strength)
      clauses.refuse("its torsion is above " + std::to_string(static_cast<int>(100 * negligible)) +
                     " % of its strength, and warping stresses of this section are not known (H3.3)");
    return;
  }
  const std::vector<WarpingForces> warping = worst_warping_forces(s, member, stations);
  double most = -1, largest_warping = 0;
  std::size_t worst = 0;
  for (std::size_t k = 0; k < stations.size(); ++k) {
    const Stresses found = stresses(s, stations[k], warping[k]);
    largest_warping = std::max(largest_warping, found.warping);
    const double use = found.normal / (phi_torsion * s.fy);
    if (found.warping + found.uniform > significant * s.fy) clauses.add(normal, use);
    clauses.add(shear, found.shear / (phi_torsion * 0.6 * s.fy));
    if (use <= most) continue;
    most = use;
    worst = k;
  }
  clauses.add(buckling, without_torsion + largest_warping / (phi_torsion * s.fy));
  if (trail.on()) trace(s, stations[worst], warping[worst], trail);
}

}  // namespace topple::structure::aisc360
