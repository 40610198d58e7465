// EN 1993-1-5: webs that buckle in shear.
#include <algorithm>
#include <numbers>

#include "design/en1993_parts.h"

namespace topple::structure::en1993 {

namespace {

/// One direction of shear: walls of height `height` and thickness `thickness`, `count` of them side by side.
struct Web {
  double height = 0, thickness = 0;
  int count = 1;
};

double epsilon(double fy) { return std::sqrt(235e6 / fy); }

/// Annex A.3 (A.5): without stiffeners between the supports 5.34.
double shear_coefficient(double spacing, double height) {
  if (!(spacing > 0)) return 5.34;
  const double ratio = spacing / height;
  return ratio >= 1 ? 5.34 + 4.00 / (ratio * ratio) : 4.00 + 5.34 / (ratio * ratio);
}

/// 5.1(2): slenderness above which a web has to be checked.
double stocky_limit(double fy, double spacing, double k) {
  return spacing > 0 ? 31 / eta * epsilon(fy) * std::sqrt(k) : 72 / eta * epsilon(fy);
}

/// Table 5.1.
double web_reduction(double slenderness, bool rigid_end_post) {
  if (slenderness < 0.83 / eta) return eta;
  if (slenderness < 1.08 || !rigid_end_post) return 0.83 / slenderness;
  return 1.37 / (0.7 + slenderness);
}

/// 5.3: what one direction's walls bear; 0 where they are too stocky to be checked.
double web_resistance(const SteelSection& s, const Web& web, const DesignMember& member, const Trail& trail) {
  const char* const clause = "EN 1993-1-5 5.2 (5.10)";
  const double spacing = member.stiffener_spacing, k = shear_coefficient(spacing, web.height);
  const double ratio = web.height / web.thickness;
  if (ratio <= stocky_limit(s.fy, spacing, k)) return 0;
  const double slenderness = ratio / (37.4 * epsilon(s.fy) * std::sqrt(k));
  const double chi = web_reduction(slenderness, member.rigid_end_post);
  const double resistance = chi * s.fy * web.height * web.thickness * web.count / (std::numbers::sqrt3 * gamma_m1);
  trail.add(clause, "h_w", "clear height of the web", web.height, of_length);
  trail.add(clause, "h_w/t_w", "must be checked above 72 epsilon/eta, or 31 epsilon sqrt(k_tau)/eta (5.1(2))", ratio,
            plain_number);
  trail.add(clause, "k_tau", "5.34 + 4.00 (h_w/a)^2, or 4.00 + 5.34 (h_w/a)^2 for a < h_w (A.5)", k, plain_number);
  trail.add(clause, "lambda_w", "h_w/(37.4 t_w epsilon sqrt(k_tau)) (5.6)", slenderness, plain_number);
  trail.add(clause, "chi_w", member.rigid_end_post ? "table 5.1, rigid end post" : "table 5.1, non-rigid end post", chi,
            plain_number);
  trail.add(clause, "V_bw,Rd", "chi_w f_yw h_w t_w/(sqrt(3) gamma_M1) (5.2)", resistance, of_force);
  return resistance;
}

/// Flanges alone: area that counts of one (an outstand of class 4 less), moment, with an axial force (5.4(2)).
struct Flanges {
  double moment = 0, plastic = 0;  ///< M_f,Rd; M_pl,Rd of flanges and whole web (7.1(1))
};

Flanges flanges_alone(const SteelSection& s, double axial) {
  const double outstand = ((s.width - s.web) / 2 - s.fillet) / s.flange;
  const double counts = s.kind == SteelSection::Kind::I ? std::min(1.0, 14 * epsilon(s.fy) / outstand)
                                                        : std::min(1.0, 42 * epsilon(s.fy) * s.flange / s.width);
  const double force = s.width * s.flange * counts * s.fy, arm = s.depth - s.flange;
  const double share = std::max(0.0, 1 - std::abs(axial) * gamma_m0 / (2 * force));
  const int webs = s.kind == SteelSection::Kind::box ? 2 : 1;
  const double web = webs * s.web * std::pow(s.web_height(), 2) / 4 * s.fy;
  Flanges f;
  f.moment = force * arm * share / gamma_m0;
  f.plastic = (force * arm + web) / gamma_m0;
  if (axial != 0) f.plastic = std::max(f.moment, f.plastic * std::max(0.0, 1 - std::abs(axial) / (s.area * s.fy)));
  return f;
}

/// 5.4 (5.8): what flanges add that the bending moment does not need, between stiffeners.
double flange_resistance(const SteelSection& s, const DesignMember& member, double moment, const Flanges& f) {
  if (s.kind != SteelSection::Kind::I || !(member.stiffener_spacing > 0) || moment >= f.moment) return 0;
  const double hw = s.web_height(), width = std::min(s.width, s.web + 30 * epsilon(s.fy) * s.flange);
  const double plastic = width * s.flange * s.flange * s.fy;
  const double c = member.stiffener_spacing * (0.25 + 1.6 * plastic / (s.web * hw * hw * s.fy));
  return plastic / (c * gamma_m1) * (1 - std::pow(moment / f.moment, 2));
}

struct ShearUtilisation {
  double shear = 0, with_moment = 0;
};

ShearUtilisation utilisation_at(const SteelSection& s, const DesignMember& member, const SectionForces& at,
                                double web) {
  const Flanges f = flanges_alone(s, at[0]);
  const double moment = std::abs(at[4]), shear = std::abs(at[2]);
  const double most = eta * s.fy * s.web_height() * s.web * (s.kind == SteelSection::Kind::box ? 2 : 1) /
                      (std::numbers::sqrt3 * gamma_m1);
  ShearUtilisation use;
  use.shear = shear / std::min(web + flange_resistance(s, member, moment, f), most);
  const double of_web = shear / web;
  if (of_web > 0.5 && moment > f.moment)
    use.with_moment = moment / f.plastic + (1 - f.moment / f.plastic) * std::pow(2 * of_web - 1, 2);
  return use;
}

void trace(const SteelSection& s, const DesignMember& member, const SectionForces& at, double web, const Trail& trail) {
  const char* const clause = "EN 1993-1-5 5.2 (5.10)";
  const Flanges f = flanges_alone(s, at[0]);
  trail.add(clause, "V_Ed", "at the governing section", at[2], of_force);
  trail.add(clause, "M_Ed", "at the governing section", at[4], of_moment);
  trail.add(clause, "M_f,Rd", "b t_f f_yf (h - t_f) (1 - N_Ed/(2 A_f f_yf)) (5.4, 7.1)", f.moment, of_moment);
  trail.add(clause, "M_pl,Rd", "of effective flanges and the whole web (7.1(1))", f.plastic, of_moment);
  trail.add(clause, "V_bf,Rd", "b_f t_f^2 f_yf/(c gamma_M1) (1 - (M_Ed/M_f,Rd)^2) (5.8); 0 without stiffeners",
            flange_resistance(s, member, std::abs(at[4]), f), of_force);
  const ShearUtilisation use = utilisation_at(s, member, at, web);
  trail.add(clause, "eta_3", "V_Ed/V_b,Rd (5.10)", use.shear, plain_number);
  trail.add("EN 1993-1-5 7.1 (7.1)", "use", "eta_1 + (1 - M_f,Rd/M_pl,Rd) (2 eta_3 - 1)^2 (7.1)", use.with_moment,
            plain_number);
}

/// Section 8 (8.1): the flange does not push the web over.
void check_flange_induced(ClauseList& clauses, const SteelSection& s, const SectionClass& cls, const Trail& trail) {
  const double k = cls.number <= 2 ? 0.4 : 0.55;  // 0.4: the plastic moment is used
  const double limit = k * s.E / s.fy * std::sqrt(s.web_height() * s.web / (s.width * s.flange));
  const double use = s.web_height() / s.web / limit;
  clauses.add("EN 1993-1-5 8 (8.1)", use);
  trail.add("EN 1993-1-5 8 (8.1)", "limit", "k E/f_yf sqrt(A_w/A_fc), k = 0.4 (plastic) or 0.55 (elastic)", limit,
            plain_number);
}

void check_strong_axis(ClauseList& clauses, const SteelSection& s, const SectionClass& cls, const DesignMember& member,
                       std::span<const SectionForces> stations, const Trail& trail) {
  const Web web{s.web_height(), s.web, s.kind == SteelSection::Kind::box ? 2 : 1};
  const double resistance = web_resistance(s, web, member, trail);
  if (!(resistance > 0)) return;
  double most = -1;
  const SectionForces* worst = nullptr;
  for (const SectionForces& at : stations) {
    const ShearUtilisation use = utilisation_at(s, member, at, resistance);
    clauses.add("EN 1993-1-5 5.2 (5.10)", use.shear);
    if (use.with_moment > 0) clauses.add("EN 1993-1-5 7.1 (7.1)", use.with_moment);
    if (std::max(use.shear, use.with_moment) <= most) continue;
    most = std::max(use.shear, use.with_moment);
    worst = &at;
  }
  if (trail.on() && worst != nullptr) trace(s, member, *worst, resistance, trail);
  if (s.kind == SteelSection::Kind::I) check_flange_induced(clauses, s, cls, trail);
}

}  // namespace

void check_plates(ClauseList& clauses, const SteelSection& steel, const SectionClass& cls, const DesignMember& member,
                  std::span<const SectionForces> stations, const Trail& trail) {
  if (steel.kind == SteelSection::Kind::pipe && cls.number == 4)
    clauses.refuse("a tube of class 4 is a shell (EN 1993-1-6), which is not checked");
  if (!(steel.web_height() > 0)) return;
  check_strong_axis(clauses, steel, cls, member, stations, trail);
  if (steel.kind != SteelSection::Kind::box) return;
  const double across = web_resistance(steel, {steel.width - 2 * steel.web, steel.web, 2}, member, {});
  if (!(across > 0)) return;
  for (const SectionForces& at : stations) clauses.add("EN 1993-1-5 5.2 (5.10)", std::abs(at[1]) / across);
}

}  // namespace topple::structure::en1993
