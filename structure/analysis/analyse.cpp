#include <Eigen/Geometry>
#include <cmath>
#include <numeric>

#include "analysis/equilibrium.h"
#include "analysis/instability.h"
#include "analysis/one_way_members.h"
#include "analysis/storeys.h"
#include "panel_bearings.h"
#include "panel_demand.h"
#include "topple/solver/beam_diagram.h"
#include "topple/structure/analysis.h"
#include "topple/structure/error.h"
#include "topple/structure/frame.h"

namespace topple::structure {

namespace {

/// Everything that the combinations share.
class Analysis {
 public:
  Analysis(const Building& building, const AnalysisRequest& request)
      : building_(building),
        request_(request),
        frame_(make_frame(building)),
        edges_(building),
        bearings_(building, edges_),
        storeys_(building) {
    combinations_ = request.combinations;
    if (combinations_.empty())
      for (std::size_t i = 0; i < building.combinations.size(); ++i) combinations_.emplace_back(i);
    for (const CombinationId id : combinations_) {
      parts_.push_back(part_loads(building, id));
      loads_.push_back(load_set(building, edges_, parts_.back()));
    }
  }

  AnalysisResult run() {
    AnalysisResult result;
    try {
      solver::StaticAnalysis analysis(carrying_both(frame_.model), request_.solver);
      const std::vector<solver::StaticSolution> solutions = analysis.solve(loads_);
      result.statistics = analysis.statistics();
      for (std::size_t k = 0; k < solutions.size(); ++k)
        result.combinations.push_back(gather(k, settled(k, solutions[k])));
    } catch (const solver::Instability& unstable) {
      throw UnstableModel(building_.file + ": " + describe_instability(building_, unstable));
    } catch (const std::invalid_argument& error) {
      // What a reader cannot see: settlements that bend a rigid floor, for one.
      throw InputError(building_.file + ": " + error.what());
    }
    result.warnings = building_.warnings;
    if (result.statistics.nearly_unstable)
      result.warnings.push_back("the model is nearly unstable: about " +
                                std::to_string(static_cast<int>(result.statistics.digits_left)) +
                                " digits of the answer are left");
    return result;
  }

 private:
  /// With tension-only and compression-only members slack where they have to be.
  [[nodiscard]] OneWayAnswer settled(std::size_t k, const solver::StaticSolution& solution) const {
    const OneWayMembers one_way(frame_.model);
    if (!one_way.any()) return {solution, {}, {}, 0};
    std::vector<std::string> names;
    for (const Member& member : building_.members) names.push_back(member.name);
    try {
      return one_way.settle(loads_[k], solution, request_.solver, names);
    } catch (const solver::Instability& unstable) {
      throw UnstableModel(building_.file + ", combination " + building_[combinations_[k]].name +
                          ", with members slack: " + describe_instability(building_, unstable));
    } catch (const std::runtime_error& cycle) {
      throw std::runtime_error(building_.file + ", combination " + building_[combinations_[k]].name + ": " +
                               cycle.what());
    }
  }

  [[nodiscard]] CombinationResult gather(std::size_t k, const OneWayAnswer& answer) const {
    const solver::StaticSolution& solution = answer.solution;
    CombinationResult result;
    result.combination = combinations_[k];
    result.displacements = solution.displacements;
    result.reactions = solution.reactions;
    solver::LoadSet acting = loads_[k];
    turn_pushes_into_reactions(parts_[k], acting, result.reactions);
    result.quality = solution.quality;
    result.members = members(loads_[k], answer);
    result.panels = panels(solution);
    result.joints = joints(parts_[k], result);
    result.storeys = storeys_.results(result.displacements, result.members);
    const Equilibrium balance = equilibrium(frame_.model, acting, result.reactions);
    result.total_load = balance.load;
    result.total_reaction = balance.reaction;
    result.equilibrium_error = balance.error;
    return result;
  }

  /// A spring support whose far end is moved pushes its node: that is part of its reaction, not a load.
  void turn_pushes_into_reactions(const PartLoads& parts, solver::LoadSet& loads, std::vector<Vec6>& reactions) const {
    for (const solver::Settlement& settlement : parts.settlements)
      for (std::size_t s = 0; s < building_.supports.size(); ++s) {
        const NodeSupport& support = building_.supports[s];
        const double stiffness = support.stiffness(settlement.component);
        if (support.node.index != settlement.node || stiffness == unlimited) continue;
        Vec6 push = Vec6::Zero();
        push(settlement.component) = stiffness * settlement.value;
        reactions[s] += push;
        loads.nodes.push_back({settlement.node, -push});
      }
  }

  [[nodiscard]] std::vector<MemberResult> members(const solver::LoadSet& loads, const OneWayAnswer& answer) const {
    const std::vector<solver::Beam>& beams = answer.beams.empty() ? frame_.model.beams : answer.beams;
    std::vector<std::vector<solver::BeamLoad>> on(building_.members.size());
    for (const solver::BeamLoad& load : loads.beams) on[static_cast<std::size_t>(load.beam)].push_back(load);
    std::vector<MemberResult> all(building_.members.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      MemberResult& member = all[i];
      member.end_forces = answer.solution.beam_end_forces[i];
      member.active = answer.active.empty() || answer.active[i] != 0;
      const solver::BeamDiagram diagram(beams[i], member.end_forces, on[i]);
      for (std::size_t q = 0; q < 8; ++q) {
        const auto range = diagram.extremes(static_cast<solver::BeamDiagram::Quantity>(q));
        member.min[q] = {range.least.value, range.least.at};
        member.max[q] = {range.greatest.value, range.greatest.at};
      }
      for (int s = 0; request_.stations > 0 && s <= request_.stations; ++s)
        member.stations.push_back(diagram.values(building_.members[i].length * s / request_.stations));
    }
    return all;
  }

  /// Mean membrane forces of a membrane panel from its corner forces (the virial theorem), panel axes.
  [[nodiscard]] std::vector<PanelResult> panels(const solver::StaticSolution& solution) const {
    std::vector<PanelResult> all(building_.panels.size());
    for (std::size_t p = 0; p < all.size(); ++p) {
      const int shell = frame_.shell_of_panel[p];
      all[p].corner_forces.fill(Vec6::Zero());
      if (shell < 0) continue;
      const Panel& panel = building_.panels[p];
      const auto& forces = solution.shell_corner_forces[static_cast<std::size_t>(shell)];
      Mat3 virial = Mat3::Zero();
      const Vec3 origin = building_[panel.nodes[0]].position;
      for (std::size_t c = 0; c < 4; ++c) {
        all[p].corner_forces[c] = forces[c];
        virial += (panel.axes * forces[c].head<3>()) *
                  (panel.axes * (building_[panel.nodes[c]].position - origin)).transpose();
      }
      const Vec3 d1 = building_[panel.nodes[2]].position - origin;
      const Vec3 d2 = building_[panel.nodes[3]].position - building_[panel.nodes[1]].position;
      const Mat3 stress = (virial + virial.transpose()) / d1.cross(d2).norm();
      all[p].membrane = {stress(0, 0), stress(1, 1), stress(0, 1)};
    }
    return all;
  }

  [[nodiscard]] std::vector<Utilisation> joints(const PartLoads& parts, const CombinationResult& result) const {
    std::vector<Utilisation> used(building_.joints.size());
    for (std::size_t m = 0; m < building_.members.size(); ++m)
      for (int end = 0; end < 2; ++end) {
        const JointId id = building_.joint(MemberId(m), end);
        if (building_[id].capacity.breakable)
          used[static_cast<std::size_t>(id.index)] =
              utilisation(building_[id].capacity, member_joint_demand(result.members[m].end_forces, end));
      }
    for (std::size_t p = 0; p < building_.panels.size(); ++p) {
      const PanelId panel(p);
      if (building_.panels[p].model == PanelModel::shell) continue;
      std::array<Vec6, 4> demand{Vec6::Zero(), Vec6::Zero(), Vec6::Zero(), Vec6::Zero()};
      if (frame_.shell_of_panel[p] >= 0)
        demand = membrane_edge_demands(building_, panel, result.panels[p].corner_forces);
      const HandOver given = hand_over(building_, edges_, panel, parts.panels[p], {true, true, true, true});
      for (int edge = 0; edge < 4; ++edge) {
        const JointId id = building_.joint(panel, edge);
        const auto e = static_cast<std::size_t>(edge);
        if (!building_[id].capacity.breakable) continue;
        demand[e] += handed_edge_demand(building_, bearings_, panel, edge, given.edge_force[e]);
        used[static_cast<std::size_t>(id.index)] = utilisation(building_[id].capacity, demand[e]);
      }
    }
    return used;
  }

  const Building& building_;
  const AnalysisRequest& request_;
  Frame frame_;
  EdgeMembers edges_;
  PanelBearings bearings_;
  Storeys storeys_;
  std::vector<CombinationId> combinations_;
  std::vector<PartLoads> parts_;
  std::vector<solver::LoadSet> loads_;
};

}  // namespace

AnalysisResult analyse(const Building& building, const AnalysisRequest& request) {
  return Analysis(building, request).run();
}

}  // namespace topple::structure
