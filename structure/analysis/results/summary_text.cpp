#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "model/short_number.h"
#include "topple/structure/analysis.h"

namespace topple::structure {

namespace {

constexpr std::size_t joints_shown = 10;
constexpr double no_drift = 1e-12;  // what rounding leaves of none

class Text {
 public:
  [[gnu::format(printf, 2, 3)]] void line(const char* format, ...) {
    char buffer[512];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(buffer, sizeof buffer, format, arguments);
    va_end(arguments);
    text_ += buffer;
    text_ += '\n';
  }
  std::string release() { return std::move(text_); }

 private:
  std::string text_;
};

constexpr int digits = 5;

/// Of a drift: 1/350, but 1/0.7 where a structure all but lies down.
std::string whole_number(double number) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, number < 10 ? "%.2g" : "%.0f", number);
  return buffer;
}

/// A use in percent, as wide as its column. Where there is next to no resistance it says no more than that.
std::string percent(double use) {
  constexpr double told = 1e6;  // percent
  char buffer[32];
  if (100 * use <= told)
    std::snprintf(buffer, sizeof buffer, "%7.1f %%", 100 * use);
  else
    std::snprintf(buffer, sizeof buffer, ">%.0f %%", told);
  return buffer;
}

void most_used(Text& text, const Building& building, const CombinationResult& c) {
  std::vector<std::size_t> order;
  for (std::size_t j = 0; j < c.joints.size(); ++j)
    if (building.joints[j].capacity.breakable) order.push_back(j);
  const std::size_t shown = std::min(joints_shown, order.size());
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(shown), order.end(),
                    [&](std::size_t a, std::size_t b) {
                      return c.joints[a].value != c.joints[b].value ? c.joints[a].value > c.joints[b].value : a < b;
                    });
  if (shown == 0) return;
  text.line("  most used joints");
  for (std::size_t k = 0; k < shown; ++k) {
    const Utilisation& used = c.joints[order[k]];
    text.line("    %-20s %s  %s", building.joints[order[k]].name.c_str(), percent(used.value).c_str(),
              sense_names[static_cast<std::size_t>(used.sense)]);
  }
}

/// How a member's effective lengths were found, about y and about z.
std::string lengths_from(const DesignResult& used) {
  const auto [y, z] = used.length_source;
  std::string text(length_source_name(y));
  if (z != y) text += "; " + std::string(length_source_name(z));
  const auto [of_y, of_z] = used.mode_part;
  const std::string_view why = mode_part_reason(of_y), why_z = mode_part_reason(of_z);
  if (!why.empty()) text += ": " + std::string(why);
  if (!why_z.empty() && of_z != of_y) text += (why.empty() ? ": " : "; ") + std::string(why_z);
  return text;
}

/// The ten most used members with clause, and what the clauses of those say.
void most_used_members(Text& text, const Building& building, const AnalysisResult& result, const CombinationResult& c) {
  std::vector<std::size_t> order, refused;
  std::size_t over = 0;
  for (std::size_t m = 0; m < c.designs.size(); ++m) {
    if (c.designs[m].governing.empty()) continue;
    order.push_back(m);
    if (!(c.designs[m].utilisation <= 1)) ++over;
    if (!c.designs[m].refusal.empty()) refused.push_back(m);
  }
  if (order.empty()) return;
  const std::size_t shown = std::min(joints_shown, order.size());
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(shown), order.end(),
                    [&](std::size_t a, std::size_t b) {
                      const double ua = c.designs[a].utilisation, ub = c.designs[b].utilisation;
                      return ua != ub ? ua > ub : a < b;
                    });
  text.line("  most used members by %s: %zu of %zu checked are above 100 %%",
            std::string(design_code_name(*result.design_code)).c_str(), over, order.size());
  std::vector<std::string> clauses;
  for (std::size_t k = 0; k < shown; ++k) {
    const DesignResult& used = c.designs[order[k]];
    const double length = building.members[order[k]].length;
    text.line("    %-20s %s  %s  K %.2f, %.2f (%s)", building.members[order[k]].name.c_str(),
              percent(used.utilisation).c_str(), used.governing.c_str(), used.lengths.y / length,
              used.lengths.z / length, lengths_from(used).c_str());
    if (std::find(clauses.begin(), clauses.end(), used.governing) == clauses.end()) clauses.push_back(used.governing);
  }
  for (std::size_t k = 0; k < std::min<std::size_t>(joints_shown, refused.size()); ++k)
    text.line("    %-20s is not said to pass: %s", building.members[refused[k]].name.c_str(),
              c.designs[refused[k]].refusal.c_str());
  if (refused.size() > joints_shown) text.line("    and %zu more that are not", refused.size() - joints_shown);
  for (const std::string& clause : clauses)
    text.line("    %s: %s", clause.c_str(), std::string(design_formula(clause)).c_str());
}

/// Where something moves most, in the building's names.
std::string location_of(const Building& building, const LargestDisplacement& largest) {
  if (largest.member.valid())
    return "in member " + building[largest.member].name + ", " +
           short_number(largest.at / building.units.length, digits) + " from its first end";
  if (largest.mesh_node >= 0) return "within a shell panel";
  return largest.node.valid() ? "at node " + building[largest.node].name : "anywhere";
}

/// What passes each cut; what rounding leaves of nothing is shown as nothing.
void cuts(Text& text, const Building& building, const AnalysisResult& result, const CombinationResult& c) {
  const Units& units = building.units;
  double far = 0;
  for (const Node& node : building.nodes) far = std::max(far, (node.position - building.nodes[0].position).norm());
  for (std::size_t k = 0; k < c.cuts.size(); ++k) {
    const Vec6& f = c.cuts[k].force;
    const double force = 1e-12 * c.total_load.head<3>().norm(), moment = force * far;
    const auto shown = [&](int i) {
      const double unit = i < 3 ? units.force : units.force * units.length;
      return std::abs(f[i]) <= (i < 3 ? force : moment) ? 0.0 : f[i] / unit;
    };
    text.line(
        "  cut %-16s normal %.6g  shear along %.6g, across %.6g  torsion %.6g  moment about along %.6g, across %.6g",
        result.cuts[k].name.c_str(), shown(0), shown(1), shown(2), shown(3), shown(4), shown(5));
  }
}

/// Of a direct analysis with tau_b: how many members are softer, and which most.
void softened(Text& text, const Building& building, const CombinationResult& c) {
  std::size_t count = 0, softest = c.designs.size();
  bool asked = false;
  for (std::size_t m = 0; m < c.designs.size(); ++m) {
    const auto& yielded = c.designs[m].yielded;
    asked = asked || yielded.has_value();
    if (!yielded || yielded->tau_b == 1) continue;
    ++count;
    if (softest == c.designs.size() || yielded->tau_b < c.designs[softest].yielded->tau_b) softest = m;
  }
  if (!asked) return;
  if (count == 0)
    text.line("  tau_b is 1 for all members: P_r is nowhere above half of P_ns");
  else
    text.line("  tau_b is below 1 for %zu members, least in %s: %.3f (P_r/P_ns %.3f)", count,
              building.members[softest].name.c_str(), c.designs[softest].yielded->tau_b,
              c.designs[softest].yielded->ratio);
}

void combination(Text& text, const Building& building, const AnalysisResult& result, const CombinationResult& c) {
  const Units& units = building.units;
  const std::string length = units.consistent ? "" : " " + units.length_name,
                    force = units.consistent ? "" : " " + units.force_name;
  text.line("combination %s", building[c.combination].name.c_str());
  const Vec3 moved = c.largest.moved / units.length;
  text.line("  largest displacement %.4g%s %s (x %.4g, y %.4g, z %.4g)", c.largest.value / units.length, length.c_str(),
            location_of(building, c.largest).c_str(), moved.x(), moved.y(), moved.z());
  // What rounding leaves of nothing is shown as nothing.
  const double rounding = 1e-12 * c.total_load.head<3>().norm();
  const auto shown = [&](double f) { return std::abs(f) < rounding ? 0.0 : f / units.force; };
  const auto forces = [&](const char* what, const Vec6& f) {
    text.line("  %-20s x %.6g  y %.6g  z %.6g%s", what, shown(f[0]), shown(f[1]), shown(f[2]), force.c_str());
  };
  forces("loads", c.total_load);
  forces("reactions", c.total_reaction);
  double drift = 0;
  std::size_t storey = 0;
  for (std::size_t i = 0; i < c.storeys.size(); ++i)
    if (c.storeys[i].drift > std::max(drift, no_drift)) {
      drift = c.storeys[i].drift;
      storey = i + 1;
    }
  if (drift > 0 && result.design_code)
    text.line("  largest drift        1/%s in storey %zu: %.1f %% of the limit 1/%.0f", whole_number(1 / drift).c_str(),
              storey, 100 * drift / result.drift_limit, 1 / result.drift_limit);
  else if (drift > 0)
    text.line("  largest drift        1/%s in storey %zu", whole_number(1 / drift).c_str(), storey);
  cuts(text, building, result, c);
  softened(text, building, c);
  most_used_members(text, building, result, c);
  most_used(text, building, c);
  if (!c.buckling.empty()) {
    std::string factors;
    for (const solver::BucklingMode& mode : c.buckling) factors += " " + short_number(mode.factor, digits);
    text.line("  buckling factors    %s", factors.c_str());
  }
  if (c.second_order_iterations > 0)
    text.line("  second order: axial forces settled in %d iterations, tangent positive definite",
              c.second_order_iterations);
  text.line("  equations solved: backward error %.1e, equilibrium error %.1e, condition %.1e, rounding below %.1e",
            c.quality.backward_error, c.equilibrium_error, c.quality.condition, c.quality.error_bound);
  if (c.discretisation_error > 0)
    text.line("  shell meshes: estimated error of stresses %.1f %% (energy norm, within elements)",
              100 * c.discretisation_error);
}

void losses(Text& text, const Building& building, const LossResult& result) {
  if (result.losses.empty()) return;
  constexpr std::size_t losses_shown = 20;
  std::size_t survived = 0;
  for (const MemberLoss& loss : result.losses)
    survived += std::all_of(loss.states.begin(), loss.states.end(), [](const LossState& s) { return s.survives(); });
  text.line("losses of members: %zu of %zu survived; %llu by correction, %llu by a new factor", survived,
            result.losses.size(), static_cast<unsigned long long>(result.counters.low_rank),
            static_cast<unsigned long long>(result.counters.refactorisations));
  text.line("  %-20s %-16s %9s  %s", "lost", "combination", "worst use", "joint, or what moves");
  for (std::size_t k = 0; k < std::min(losses_shown, result.losses.size()); ++k) {
    const MemberLoss& loss = result.losses[k];
    for (const LossState& state : loss.states) {
      const char* lost = building[loss.member].name.c_str();
      const char* under = building[state.combination].name.c_str();
      if (!state.stands())
        text.line("  %-20s %-16s mechanism  %.300s", lost, under, state.mechanism.c_str());
      else if (state.worst.valid())
        text.line("  %-20s %-16s %s  %s %s", lost, under, percent(state.utilisation.value).c_str(),
                  building[state.worst].name.c_str(), sense_names[static_cast<std::size_t>(state.utilisation.sense)]);
      else
        text.line("  %-20s %-16s    stands  no joint has a capacity", lost, under);
    }
  }
  if (result.losses.size() > losses_shown)
    text.line("  and %zu more, of less use", result.losses.size() - losses_shown);
}

/// Worst joints of one motion, and how far its peaks are settled.
void motion(Text& text, const std::string& what, const Building& building, const MotionResult& result) {
  text.line("%s: lowest period %.4g s, damping %.3g at %.4g and %.4g Hz; %.4g s by substeps of %.4g s", what.c_str(),
            result.period, result.damping, 1 / result.period, result.shape_frequency, result.duration, result.substep);
  text.line("  after %d halvings of the substep %s changes by more than %.2g %%%s", result.halvings, "no peak",
            100 * result.change, result.change > settled_peak ? ": NOT settled to 0.5 %" : "");
  if (result.unsettled > 0)
    text.line("  in %ld substeps a member was pressed beyond what it bears as it lay: it buckles on its way",
              result.unsettled);
  std::vector<const JointPeak*> order;
  for (const JointPeak& joint : result.joints) order.push_back(&joint);
  const std::size_t shown = std::min(joints_shown, order.size());
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(shown), order.end(),
                    [](const JointPeak* a, const JointPeak* b) {
                      return a->utilisation.value != b->utilisation.value ? a->utilisation.value > b->utilisation.value
                                                                          : a->joint.index < b->joint.index;
                    });
  for (std::size_t k = 0; k < shown; ++k) {
    const JointPeak& joint = *order[k];
    const std::string times = joint.amplification ? short_number(*joint.amplification, digits) + " x static" : "";
    text.line("    %-20s %s  %-11s at %.4g s  %s", building[joint.joint].name.c_str(),
              percent(joint.utilisation.value).c_str(), sense_names[static_cast<std::size_t>(joint.utilisation.sense)],
              joint.at, times.c_str());
  }
}

void motions(Text& text, const Building& building, const AnalysisResult& result) {
  for (const MemberLoss& loss : result.losses.losses)
    for (const LossState& state : loss.states)
      if (state.dynamic)
        motion(text, "motion after the loss of " + building[loss.member].name + ", " + building[state.combination].name,
               building, *state.dynamic);
  for (const auto& [combination, found] : result.motions)
    motion(text, "time history, " + building[combination].name, building, found);
}

void modes(Text& text, const Building& building, const AnalysisResult& result) {
  constexpr double pi = 3.14159265358979323846;
  const Vec3 mass = result.moving_mass / building.units.mass;
  const bool consistent = building.units.mass_name == "consistent";
  text.line("natural modes (moving mass x %.6g, y %.6g, z %.6g%s)", mass.x(), mass.y(), mass.z(),
            consistent ? "" : (" " + building.units.mass_name).c_str());
  for (std::size_t m = 0; m < result.modes.size(); ++m) {
    const solver::VibrationMode& mode = result.modes[m];
    text.line("  %2zu  %12.6g Hz   mass share x %.3f  y %.3f  z %.3f", m + 1, mode.angular_frequency / (2 * pi),
              mode.mass_share[0], mode.mass_share[1], mode.mass_share[2]);
  }
}

}  // namespace

std::string summary_text(const Building& building, const AnalysisResult& result,
                         const std::map<std::string, double>& seconds) {
  Text text;
  text.line("%s", building.title.empty() ? building.file.c_str() : building.title.c_str());
  const bool solved = !result.combinations.empty();  // what floats has modes alone
  text.line("  %zu nodes, %zu members, %zu panels%s", building.nodes.size(), building.members.size(),
            building.panels.size(),
            solved ? (", " + std::to_string(result.statistics.freedoms) + " equations").c_str() : "");
  for (const CombinationResult& c : result.combinations) combination(text, building, result, c);
  losses(text, building, result.losses);
  motions(text, building, result);
  if (!result.modes.empty()) modes(text, building, result);
  std::string times;
  for (const auto& [stage, time] : seconds) {
    char part[64];
    std::snprintf(part, sizeof part, "%s%s %.3f s", times.empty() ? "" : ", ", stage.c_str(), time);
    times += part;
  }
  const std::string factor =
      result.statistics.factorisation + " factor, " + std::to_string(result.statistics.factor_entries) + " entries; ";
  text.line("%s%s", solved ? factor.c_str() : "", times.c_str());
  if (result.design_code) {
    text.line("not checked by %s:", std::string(design_code_name(*result.design_code)).c_str());
    for (const std::string_view clause : design_not_checked(*result.design_code))
      text.line("  %s", std::string(clause).c_str());
  }
  for (const std::string& missing : result.unfinished) text.line("not computed: %s", missing.c_str());
  for (const std::string& warning : result.warnings) text.line("warning: %s", warning.c_str());
  return text.release();
}

}  // namespace topple::structure
