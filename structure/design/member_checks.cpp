#include "topple/structure/member_checks.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>

#include "topple/structure/error.h"

namespace topple::structure {

namespace {

constexpr double sway_factor = 2;  // of a cantilever, fixed at one end and free to move at the other

/// For every node: how many members, panels, supports and rigid floors hold it.
std::vector<int> holds_of_nodes(const Building& building) {
  std::vector<int> holds(building.nodes.size(), 0);
  const auto hold = [&](NodeId node) { ++holds[static_cast<std::size_t>(node.index)]; };
  for (const Member& member : building.members)
    for (const NodeId node : member.nodes) hold(node);
  for (const Panel& panel : building.panels)
    if (panel.model != PanelModel::cladding)
      for (const NodeId node : panel.nodes) hold(node);
  for (const NodeSupport& support : building.supports) hold(support.node);
  for (const Diaphragm& diaphragm : building.diaphragms)
    for (const NodeId node : diaphragm.nodes) hold(node);
  return holds;
}

/// Longest stretch of the compression flange between lateral restraints.
double lateral_length(const Member& member) {
  if (member.design.restrained_throughout) return 0;
  double longest = 0, last = 0;
  for (const double at : member.design.restraints) {
    longest = std::max(longest, at - last);
    last = at;
  }
  return std::max(longest, member.length - last);
}

/// Forces at the stations and at the critical sections.
std::vector<SectionForces> forces_along(const MemberResult& member) {
  std::vector<SectionForces> all;
  for (const auto& sections : {std::span(member.stations), std::span(member.critical)})
    for (const std::array<double, 8>& at : sections) {
      SectionForces& forces = all.emplace_back();
      std::copy_n(at.begin(), forces.size(), forces.begin());
    }
  return all;
}

}  // namespace

DesignMember design_member(const Building& building, MemberId id, bool has_free_end) {
  const Member& member = building[id];
  const MemberDesign& given = member.design;
  const double sway = member.kind == MemberKind::post || has_free_end ? sway_factor : 1;
  const auto length = [&](std::size_t way, double factor) {
    if (given.lengths[way]) return *given.lengths[way];
    return given.factors[way].value_or(factor) * member.length;
  };
  DesignMember checked;
  checked.section = &building[member.section];
  checked.material = &building[member.material];
  checked.lengths = {length(0, sway), length(1, sway), length(2, 1), lateral_length(member)};
  if (has_free_end && given.restraints.empty()) checked.lengths.lateral *= sway_factor;
  checked.factors = {given.moment_factor, given.equivalent_moment_y, given.equivalent_moment_z};
  return checked;
}

void check_design(const Building& building, DesignCode code, double drift_limit, AnalysisResult& result) {
  if (building.units.consistent)
    throw InputError(building.file +
                     ": the units are \"consistent\", and a design check has units in its formulas; accepted: a model "
                     "that names its units");
  const std::vector<int> holds = holds_of_nodes(building);
  std::vector<DesignMember> members(building.members.size());
  for (std::size_t m = 0; m < members.size(); ++m) {
    const auto& nodes = building.members[m].nodes;
    const bool free_end = std::any_of(nodes.begin(), nodes.end(),
                                      [&](NodeId node) { return holds[static_cast<std::size_t>(node.index)] == 1; });
    if (building.members[m].design.checked) members[m] = design_member(building, MemberId(m), free_end);
  }
  for (CombinationResult& combination : result.combinations) {
    combination.designs.assign(members.size(), {});
    for (std::size_t m = 0; m < members.size(); ++m) {
      if (members[m].section == nullptr) continue;
      const MemberResult& forces = combination.members[m];
      if (forces.stations.size() < 2 || forces.critical.empty())
        throw std::invalid_argument("check_design: the analysis was made without stations or critical sections");
      try {
        combination.designs[m] = check_member(code, members[m], forces_along(forces));
      } catch (const InputError& error) {
        throw InputError(building.file + ": members." + building.members[m].name + ": " + error.what() +
                         "; or \"design\": \"none\" for a member that is not to be checked");
      }
    }
  }
  result.design_code = code;
  result.drift_limit = drift_limit;
}

}  // namespace topple::structure
