#include "report_audit.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace topple::app {

using namespace topple::structure;
using Json = structure::JsonTree;

namespace {

constexpr std::size_t most_audits = 40, most_arrows = 3000;

/// The units that a step is written in: factors to SI and names.
struct StepUnits {
  double force = 1, length = 1;
  std::string force_name, length_name;
};

/// Moments are written with the longer unit of length, section properties with the shorter.
std::pair<double, std::string> written(const DesignStep& step, const Units& units) {
  StepUnits u{units.force, units.length, units.force_name, units.length_name};
  if (units.force_name == "N" && units.length_name == "m") {
    const bool stress = step.force == 1 && step.length == -2;
    u = stress ? StepUnits{1, 1e-3, "N", "mm"}
               : StepUnits{1e3, step.force != 0 ? 1 : 1e-3, "kN", step.force != 0 ? "m" : "mm"};
  }
  constexpr double nothing = 1e-6;  // N, N m: what rounding leaves of no force
  const bool noise = step.force == 1 && step.length >= 0 && std::abs(step.value) < nothing;
  const double value = noise ? 0 : step.value / (std::pow(u.force, step.force) * std::pow(u.length, step.length));
  std::string name = step.force != 0 ? u.force_name : "";
  if (step.length < 0)
    name += "/" + u.length_name + (step.length < -1 ? std::to_string(-step.length) : "");
  else if (step.length > 0)
    name += u.length_name + (step.length > 1 ? std::to_string(step.length) : "");
  return {value, name};
}

struct Chosen {
  std::size_t member = 0, combination = 0;
  double use = 0;
};

/// Of each member the combination in which it is used most.
std::vector<Chosen> worst_utilisations(const Building& building, const AnalysisResult& result) {
  std::vector<Chosen> all;
  for (std::size_t m = 0; m < building.members.size(); ++m) {
    Chosen worst{m, 0, -1};
    for (std::size_t c = 0; c < result.combinations.size(); ++c) {
      const DesignResult& used = result.combinations[c].designs[m];
      if (!used.governing.empty() && used.utilisation > worst.use) worst = {m, c, used.utilisation};
    }
    if (worst.use >= 0) all.push_back(worst);
  }
  std::stable_sort(all.begin(), all.end(), [](const Chosen& a, const Chosen& b) { return a.use > b.use; });
  return all;
}

std::vector<Chosen> governing_members(const Building& building, const AnalysisResult& result) {
  std::map<int, int> of_section;
  std::vector<Chosen> chosen;
  for (const Chosen& one : worst_utilisations(building, result))
    if (of_section[building.members[one.member].section.index]++ == 0 && chosen.size() < most_audits)
      chosen.push_back(one);
  return chosen;
}

std::string lengths_text(const DesignResult& used, const Building& building, const Member& member) {
  const double unit = building.units.length;
  const auto source = [&](std::size_t way) {
    const std::string_view why = mode_part_reason(used.mode_part[way]);
    return std::string(length_source_name(used.length_source[way])) +
           (why.empty() ? "" : "; not from the buckling modes: " + std::string(why));
  };
  const std::string name = building.units.consistent ? "" : " " + building.units.length_name;
  char lateral[64] = "flanges held along its length";
  if (used.lengths.lateral > 0)
    std::snprintf(lateral, sizeof lateral, "lateral %.4g%s", used.lengths.lateral / unit, name.c_str());
  char text[640];
  std::snprintf(text, sizeof text,
                "Effective lengths: about y %.4g%s (K %.3f, %s), about z %.4g%s (K %.3f, %s), torsion %.4g%s; %s.",
                used.lengths.y / unit, name.c_str(), used.lengths.y / member.length, source(0).c_str(),
                used.lengths.z / unit, name.c_str(), used.lengths.z / member.length, source(1).c_str(),
                used.lengths.torsion / unit, name.c_str(), lateral);
  return text;
}

}  // namespace

Json report_audits(const Building& building, const AnalysisResult& result, const DesignInput& input) {
  Json list = Json::array();
  if (!result.design_code) return list;
  const DesignMembers members(building, input);
  for (const Chosen& chosen : governing_members(building, result)) {
    const CombinationResult& c = result.combinations[chosen.combination];
    const Member& member = building.members[chosen.member];
    const DesignAudit audit = audit_design(members, *result.design_code, MemberId(chosen.member), building, c);
    Json steps = Json::array(), clauses = Json::array();
    for (const DesignStep& step : audit.steps) {
      const auto [value, unit] = written(step, building.units);
      steps.push_back({step.clause, step.symbol, step.formula, value, unit});
    }
    for (const DesignClause& clause : audit.result.clauses)
      clauses.push_back({clause.clause, clause.utilisation, std::string(design_formula(clause.clause))});
    list.push_back({{"member", member.name},
                    {"combination", building[c.combination].name},
                    {"section", building[member.section].name},
                    {"material", building[member.material].name},
                    {"length", member.length / building.units.length},
                    {"use", audit.result.utilisation},
                    {"governing", audit.result.governing},
                    {"formula", std::string(design_formula(audit.result.governing))},
                    {"lengths", lengths_text(audit.result, building, member)},
                    {"refusal", audit.result.refusal},
                    {"steps", std::move(steps)},
                    {"clauses", std::move(clauses)}});
  }
  return list;
}

Json load_drawings(const Building& building) {
  Json list = Json::array();
  const double length = building.units.length;
  const auto vector = [](const Vec3& v) { return Json::array({v.x(), v.y(), v.z()}); };
  for (const LoadCase& c : building.cases) {
    Json arrows = Json::array(), panels = Json::array();
    std::size_t left_out = 0;
    const auto arrow = [&](const Vec3& at, const Vec3& to) {
      if (to.isZero(0)) return;
      if (arrows.size() < most_arrows)
        arrows.push_back({{"at", vector(at / length)}, {"to", vector(to / building.units.force)}});
      else
        ++left_out;
    };
    for (const NodeLoad& load : c.nodes) arrow(building[load.node].position, load.load.head<3>());
    for (const MemberLoad& load : c.members) {
      if (load.kind == MemberLoad::Kind::temperature) continue;
      const Member& member = building[load.member];
      const double middle = load.kind == MemberLoad::Kind::point ? load.from : (load.from + load.to) / 2;
      const Vec3 start = building[member.nodes[0]].position + member.offsets[0];
      const double span = load.kind == MemberLoad::Kind::point ? 1 : load.to - load.from;
      Vec3 force = load.kind == MemberLoad::Kind::point ? load.first.head<3>()
                                                        : Vec3((load.first + load.last).head<3>() / 2 * span);
      if (load.frame == LoadFrame::local) force = member.axes.transpose() * force;
      arrow(start + middle * member.axes.row(0).transpose(), force);
    }
    for (const PanelLoad& load : c.panels)
      if (load.pressure != 0) panels.push_back(load.panel.index);
    list.push_back({{"name", c.name},
                    {"self_weight", !c.self_weight.isZero()},
                    {"arrows", std::move(arrows)},
                    {"panels", std::move(panels)},
                    {"left_out", left_out}});
  }
  return list;
}

}  // namespace topple::app
