#include "topple/structure/direct_analysis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>

#include "design/aisc360_parts.h"
#include "model/index_of.h"
#include "model/panel_area.h"
#include "model/short_number.h"
#include "topple/structure/error.h"

namespace topple::structure {

namespace {

struct Direction {
  const char* name;
  std::size_t axis;
  double sign;
};
constexpr std::array<Direction, 4> directions{{{"+x", 0, 1}, {"-x", 0, -1}, {"+y", 1, 1}, {"-y", 1, -1}}};

/// What is downward of a load along a member, turned sideways, global; a load along the axes of the member or of its
/// projection is taken as it acts.
MemberLoad sideways(const MemberLoad& load, const Member& member, Eigen::Index axis, double share) {
  MemberLoad turned = load;
  turned.frame = LoadFrame::global;
  const double level =
      std::hypot(member.axes(0, 0), member.axes(0, 1));  // of a projected load's length to the member's
  for (const auto& [from, to] : {std::pair(&load.first, &turned.first), std::pair(&load.last, &turned.last)}) {
    Vec3 force = from->head<3>();
    if (load.frame == LoadFrame::local) force = member.axes.transpose() * force;
    if (load.frame == LoadFrame::projected && load.kind == MemberLoad::Kind::distributed) force *= level;
    to->setZero();
    (*to)(axis) = -share * force.z();
  }
  return turned;
}

/// A case's downward loads, sideways.
LoadCase notional_case(const Building& building, const LoadCase& whole, std::size_t direction, double share) {
  const auto axis = static_cast<Eigen::Index>(direction);
  LoadCase turned;
  turned.name = whole.name + (direction == 0 ? " notional x" : " notional y");
  turned.self_weight(axis) = -share * whole.self_weight.z();
  std::map<NodeId, double> at_nodes;  // one load for each: panels meet at most of them
  const auto at_node = [&](NodeId node, double downward) {
    if (downward != 0) at_nodes[node] += share * downward;
  };
  for (const NodeLoad& load : whole.nodes) at_node(load.node, -load.load(2));
  for (const MemberLoad& load : whole.members)
    if (load.kind != MemberLoad::Kind::temperature)
      turned.members.push_back(sideways(load, building[load.member], axis, share));
  for (const PanelLoad& load : whole.panels) {
    const Panel& panel = building[load.panel];
    // Pressure acts against the normal.
    const double downward = load.pressure * panel.axes(2, 2) * panel_area(building, panel, true);
    for (const NodeId node : panel.nodes) at_node(node, downward / 4);
  }
  for (const auto& [node, force] : at_nodes) {
    NodeLoad load{node, Vec6::Zero()};
    load.load(axis) = force;
    turned.nodes.push_back(load);
  }
  return turned;
}

}  // namespace

Building with_notional_loads(const Building& building, const std::vector<CombinationId>& combinations, double share) {
  Building leaning = building;
  const std::size_t cases = building.cases.size();
  for (std::size_t direction = 0; direction < 2; ++direction)
    for (std::size_t c = 0; c < cases; ++c)
      leaning.cases.push_back(notional_case(building, building.cases[c], direction, share));
  leaning.combinations.clear();
  for (const CombinationId id : combinations)
    for (const Direction& to : directions) {
      Combination combination{building[id].name + " " + to.name, building[id].factors};
      for (const auto& [load, factor] : building[id].factors)
        combination.factors.emplace_back(LoadCaseId(cases + to.axis * cases + index_of(load)), to.sign * factor);
      for (const Combination& other : leaning.combinations)
        if (other.name == combination.name)
          throw InputError(building.file + ": combination " + combination.name +
                           " is there twice with the notional loads of the direct analysis; accepted: other names");
      leaning.combinations.push_back(std::move(combination));
    }
  return leaning;
}

Building with_reduced_stiffness(Building building, const std::vector<YieldedStiffness>& yielded) {
  for (Material& material : building.materials) {
    material.youngs_modulus *= stiffness_share;
    material.shear_modulus *= stiffness_share;
  }
  for (std::size_t m = 0; m < yielded.size(); ++m) {
    if (yielded[m].tau_b == 1) continue;
    Section softened = building[building.members[m].section];
    softened.Iy *= yielded[m].tau_b;
    softened.Iz *= yielded[m].tau_b;
    building.members[m].section = SectionId(building.sections.size());
    building.sections.push_back(std::move(softened));
  }
  return building;
}

double tau_b(double ratio) { return ratio <= 0.5 ? 1 : 4 * ratio * (1 - ratio); }

std::vector<YieldedStiffness> yielded_stiffness(const Building& building, const AnalysisResult& result) {
  std::vector<YieldedStiffness> all(building.members.size());
  for (std::size_t m = 0; m < all.size(); ++m) {
    const Member& member = building.members[m];
    const Material& material = building[member.material];
    if (!member.design.checked || !material.yield_strength) continue;
    double compression = 0;
    for (const CombinationResult& c : result.combinations)
      compression = std::max(compression, -c.members[m].min[0].value);
    all[m].ratio = compression / aisc360::section_strength(steel_section(building[member.section], material));
    if (!(all[m].ratio < 1)) {
      throw InputError(building.file + ": members." + member.name + ": its compression is " +
                       short_number(all[m].ratio, 3) +
                       " of what its section bears: no stiffness is left (AISC 360 C2.3(b)); accepted: a stronger "
                       "section, or --direct-analysis without tau-b");
    }
    all[m].tau_b = tau_b(all[m].ratio);
  }
  return all;
}

DirectAnalysis analyse_directly(const Building& building, const AnalysisRequest& request) {
  constexpr int most_rounds = 30;
  constexpr double settled = 1e-3;
  AnalysisRequest forces_alone;  // all that the rounds need
  forces_alone.combinations = request.combinations;
  forces_alone.solver = request.solver;
  forces_alone.second_order = request.second_order;
  forces_alone.workers = request.workers;
  DirectAnalysis found;
  for (found.yielded.assign(building.members.size(), {}); found.rounds < most_rounds;) {
    if (request.progress) request.progress("stiffness that yielding leaves", -1);
    ++found.rounds;
    const auto next =
        yielded_stiffness(building, analyse(with_reduced_stiffness(building, found.yielded), forces_alone));
    double change = 0;
    for (std::size_t m = 0; m < next.size(); ++m)
      change = std::max(change, std::abs(next[m].tau_b - found.yielded[m].tau_b));
    if (change > settled) {
      found.yielded = next;
      continue;
    }
    for (std::size_t m = 0; m < next.size(); ++m) found.yielded[m].ratio = next[m].ratio;
    found.result = analyse(with_reduced_stiffness(building, found.yielded), request);
    return found;
  }
  throw std::runtime_error(building.file + ": tau_b does not settle (AISC 360 C2.3(b))");
}

}  // namespace topple::structure
