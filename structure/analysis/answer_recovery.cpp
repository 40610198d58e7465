#include "analysis/answer_recovery.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "analysis/divided_member.h"
#include "analysis/largest_displacement.h"
#include "analysis/resultants/discretisation.h"
#include "analysis/resultants/section_cuts.h"
#include "analysis/resultants/shell_results.h"
#include "analysis/second_order_member.h"
#include "failure/panel_demand.h"
#include "mesh/semi_rigid_elements.h"
#include "model/index_of.h"
#include "parallel/in_order.h"
#include "topple/solver/beam_diagram.h"
#include "topple/solver/parallel_for.h"

namespace topple::structure {

AnswerRecovery::AnswerRecovery(const Building& building, const Frame& frame, const EdgeMembers& edges,
                               const AnalysisRequest& request, bool brief, bool parallel)
    : building_(building),
      frame_(frame),
      edges_(edges),
      request_(request),
      brief_(brief),
      parallel_(parallel),
      bearing_edges_(building, frame, edges),
      bearings_(building, edges),
      storeys_(building) {
  for (std::size_t m = 0; m < building.members.size(); ++m)
    for (int end = 0; end < 2; ++end)
      if (building[building.joint(MemberId(m), end)].capacity.breakable) breakable_ends_.emplace_back(m, end);
}

template <class LoadsOn>
CombinationResult AnswerRecovery::gathered(const OneWayAnswer& answer, const solver::StaticSolution& solution,
                                           const PartLoads& parts, const EdgeForces& forces, LoadsOn loads_on) const {
  CombinationResult result;
  const auto of_mesh = solution.displacements.begin() + static_cast<std::ptrdiff_t>(building_.nodes.size());
  result.displacements.assign(solution.displacements.begin(), of_mesh);
  result.mesh_displacements.assign(of_mesh, solution.displacements.end());
  result.reactions = solution.reactions;
  result.quality = solution.quality;
  result.members = members(answer, loads_on);
  result.panels = panels(parts, solution);
  result.joints = joints(parts, forces, solution, result);
  result.storeys = storeys_.results(result.displacements, result.members);
  if (brief_) return result;
  result.discretisation_error = recover_resultants(building_, frame_, parts, solution, result.panels);
  result.largest = largest_displacement(building_, result, [&](std::size_t m, double at) {
    Vec2 bent = Vec2::Zero();
    solver::Vec12 unused;
    with_diagram(answer, loads_on(m), m, unused, [&](double, const auto& diagram) {
      const std::array<double, 8> values = diagram.values(at);
      bent = {values[6], values[7]};
    });
    return bent;
  });
  return result;
}

void AnswerRecovery::hold_against_reactions(const Balance& applied, bool displaced, CombinationResult& result) const {
  const Equilibrium balance = equilibrium(frame_.model, applied, result.reactions, displaced);
  result.edge_reactions = edge_reactions(building_, frame_, result.reactions);
  result.reactions.resize(building_.supports.size());
  result.total_load = balance.load;
  result.total_reaction = balance.reaction;
  result.equilibrium_error = balance.error;
}

std::vector<solver::NodeLoad> AnswerRecovery::pushes_of_supports(const PartLoads& parts,
                                                                 std::vector<Vec6>& reactions) const {
  std::vector<solver::NodeLoad> taken_off;
  for (const solver::Settlement& settlement : parts.settlements)
    for (std::size_t s = 0; s < building_.supports.size(); ++s) {
      const NodeSupport& support = building_.supports[s];
      const double stiffness = support.stiffness(settlement.component);
      if (support.node.index != settlement.node || stiffness == unlimited) continue;
      Vec6 push = Vec6::Zero();
      push(settlement.component) = stiffness * settlement.value;
      reactions[s] += push;
      taken_off.push_back({settlement.node, -push});
    }
  return taken_off;
}

template <class Diagram>
void AnswerRecovery::fill(MemberResult& member, double length, const Diagram& diagram) const {
  if (brief_) return;
  for (std::size_t q = 0; q < 8; ++q) {
    const auto range = diagram.extremes(static_cast<solver::BeamDiagram::Quantity>(q));
    member.min[q] = {range.least.value, range.least.at};
    member.max[q] = {range.greatest.value, range.greatest.at};
  }
  for (int s = 0; request_.stations > 0 && s <= request_.stations; ++s)
    member.stations.push_back(diagram.values(length * s / request_.stations));
  if (request_.critical_sections) add_critical_sections(member, length, diagram);
}

template <class Diagram>
void AnswerRecovery::add_critical_sections(MemberResult& member, double length, const Diagram& diagram) {
  const std::vector<double> breaks = diagram.breaks();
  const auto add = [&](double at, bool beyond) {
    member.critical.push_back(diagram.values(at, beyond));
    member.critical_at.push_back(at);
  };
  for (const double at : breaks)
    for (const bool beyond : {false, true}) add(at, beyond);
  // Both sides of a break are there already: the extreme of one side does not go with the others of the other.
  const auto at_a_break = [&](double at) {
    constexpr double rounding = 1e-9;
    return std::any_of(breaks.begin(), breaks.end(),
                       [&](double place) { return std::abs(place - at) <= rounding * length; });
  };
  for (std::size_t q = 0; q < 6; ++q)
    for (const Extreme& extreme : {member.min[q], member.max[q]})
      if (!at_a_break(extreme.at)) add(extreme.at, false);
}

template <class LoadsOn>
std::vector<MemberResult> AnswerRecovery::members(const OneWayAnswer& answer, LoadsOn loads_on) const {
  const std::vector<solver::Vec12>& end_forces = answer.solution.beam_end_forces;
  std::vector<MemberResult> all(building_.members.size());
  const auto one = [&](std::size_t i) {
    MemberResult& member = all[i];
    member.active = answer.active.empty() || answer.active[i] != 0;
    member.end_forces = end_forces[i];
    with_diagram(answer, loads_on(i), i, member.end_forces,
                 [&](double length, const auto& diagram) { fill(member, length, diagram); });
  };
  // Linear combinations go side by side themselves, and the sums of their loads have one place.
  constexpr std::size_t together = 256;
  const std::size_t parts = (all.size() + together - 1) / together;
  solver::parallel_for(parts, workers_for(parts, parallel_ ? 1 : request_.workers), [&](std::size_t part) {
    for (std::size_t i = part * together; i < std::min(all.size(), (part + 1) * together); ++i) one(i);
  });
  return all;
}

template <class Use>
void AnswerRecovery::with_diagram(const OneWayAnswer& answer, std::span<const solver::BeamLoad> on, std::size_t i,
                                  solver::Vec12& member_end_forces, Use use) const {
  const std::vector<solver::Beam>& beams = answer.beams.empty() ? frame_.model.beams : answer.beams;
  const std::vector<solver::Vec12>& end_forces = answer.solution.beam_end_forces;
  const bool first_order = answer.axial.mode == solver::SecondOrder::none;
  if (frame_.pieces[i].empty() && first_order) {
    use(beams[i].length, solver::BeamDiagram(beams[i], end_forces[i], on));
    return;
  }
  const WholeMember whole = whole_member(frame_, i, beams, end_forces, {on.begin(), on.end()});
  member_end_forces = whole.end_forces;
  if (first_order)
    use(whole.beam.length, solver::BeamDiagram(whole.beam, whole.end_forces, whole.loads));
  else
    use(whole.beam.length, SecondOrderMember(frame_, i, beams, answer.axial, answer.solution));
}

std::vector<PanelResult> AnswerRecovery::panels(const PartLoads& parts, const solver::StaticSolution& solution) const {
  std::vector<PanelResult> all(building_.panels.size());
  for (std::size_t p = 0; p < all.size(); ++p) {
    if (!frame_.meshes[p].elements.empty()) {
      all[p] = shell_panel_result(building_, frame_, PanelId(p), parts, solution);
      continue;
    }
    const int shell = frame_.shell_of_panel[p];
    all[p].corner_forces.fill(Vec6::Zero());
    if (shell < 0) continue;
    const Panel& panel = building_.panels[p];
    const auto& forces = solution.shell_corner_forces[static_cast<std::size_t>(shell)];
    Mat3 virial = Mat3::Zero();
    const Vec3 origin = building_[panel.nodes[0]].position;
    for (std::size_t c = 0; c < 4; ++c) {
      all[p].corner_forces[c] = forces[c];
      virial +=
          (panel.axes * forces[c].head<3>()) * (panel.axes * (building_[panel.nodes[c]].position - origin)).transpose();
    }
    const Vec3 d1 = building_[panel.nodes[2]].position - origin;
    const Vec3 d2 = building_[panel.nodes[3]].position - building_[panel.nodes[1]].position;
    const Mat3 stress = (virial + virial.transpose()) / d1.cross(d2).norm();
    all[p].membrane = {stress(0, 0), stress(1, 1), stress(0, 1)};
  }
  return all;
}

std::vector<Utilisation> AnswerRecovery::joints(const PartLoads& parts, const EdgeForces& forces,
                                                const solver::StaticSolution& solution,
                                                const CombinationResult& result) const {
  std::vector<Utilisation> used(building_.joints.size());
  for (const auto& [m, end] : breakable_ends_) {
    const JointId id = building_.joint(MemberId(m), end);
    used[index_of(id)] = utilisation(building_[id].capacity, member_joint_demand(result.members[m].end_forces, end));
  }
  for (std::size_t p = 0; p < building_.panels.size(); ++p) {
    const PanelId panel(p);
    std::array<Vec6, 4> demand{Vec6::Zero(), Vec6::Zero(), Vec6::Zero(), Vec6::Zero()};
    const bool meshed = !frame_.meshes[p].elements.empty();
    if (meshed) demand = shell_edge_demands(building_, frame_, bearing_edges_, panel, parts, solution);
    if (frame_.shell_of_panel[p] >= 0) demand = membrane_edge_demands(building_, panel, result.panels[p].corner_forces);
    for (int edge = 0; edge < 4; ++edge) {
      const JointId id = building_.joint(panel, edge);
      const auto e = static_cast<std::size_t>(edge);
      if (!building_[id].capacity.breakable) continue;
      if (!meshed) demand[e] += handed_edge_demand(building_, bearings_, panel, edge, forces[p][e]);
      used[index_of(id)] = utilisation(building_[id].capacity, demand[e]);
    }
  }
  return used;
}

CombinationResult AnswerRecovery::recovered(CombinationId combination, const OneWayAnswer& answer,
                                            CombinationLoads loads) const {
  solver::StaticSolution absolute;
  if (!frame_.semi_rigid_nodes.empty()) {
    absolute = answer.solution;
    make_absolute(frame_, absolute.displacements);
  }
  const solver::StaticSolution& solution = frame_.semi_rigid_nodes.empty() ? answer.solution : absolute;
  const LoadsByMember by_member(building_.members.size(), loads.whole ? loads.whole->beams : loads.set.beams);
  CombinationResult result = gathered(answer, solution, loads.parts, loads.edge_forces,
                                      [&](std::size_t member) { return by_member.on(member); });
  result.cuts = cut_results(building_, frame_, request_.cuts, loads.parts, loads.set, solution,
                            answer.axial.mode != solver::SecondOrder::none);
  std::vector<solver::NodeLoad> pushes = pushes_of_supports(loads.parts, result.reactions);
  loads.set.nodes.insert(loads.set.nodes.end(), pushes.begin(), pushes.end());
  leave_out_semi_rigid_sides(frame_, loads.set, result.reactions);
  hold_against_reactions(balance_of(frame_.model, loads.set), answer.axial.mode != solver::SecondOrder::none, result);
  result.combination = combination;
  return result;
}

CombinationResult AnswerRecovery::recovered_sum(CombinationId combination, const OneWayAnswer& answer,
                                                const SummedCases& cases, std::size_t k) const {
  const PartLoads parts = loads_beside_members(building_, building_[combination]);
  std::vector<solver::BeamLoad> sum;
  const EdgeForces forces = edge_forces(building_, edges_, parts);
  CombinationResult result = gathered(answer, answer.solution, parts, forces, [&](std::size_t member) {
    cases.on_members.add_up(k, member, sum);
    return std::span<const solver::BeamLoad>(sum);
  });
  if (!request_.cuts.empty()) {
    const CombinationLoads loads = combination_loads(building_, frame_, edges_, building_[combination]);
    result.cuts = cut_results(building_, frame_, request_.cuts, loads.parts, loads.set, answer.solution, false);
  }
  Balance applied = balance_of(frame_.model, pushes_of_supports(parts, result.reactions));
  for (std::size_t c = 0; c < cases.balances.size(); ++c)
    applied.add(cases.balances[c], cases.factors(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(k)));
  hold_against_reactions(applied, false, result);
  result.combination = combination;
  return result;
}

}  // namespace topple::structure
