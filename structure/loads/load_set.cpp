// A combination as one right-hand side of the frame, everything standing.
#include "loads/case_loads.h"
#include "model/index_of.h"
#include "topple/structure/frame.h"

namespace topple::structure {

namespace {

TributaryLoads handed_by(const Building& building, const EdgeMembers& edges, const PartLoads& loads, std::size_t p) {
  return tributary_loads(building, edges, PanelId(p), loads.panels[p], {true, true, true, true});
}

void add_panels(const Building& building, const EdgeMembers& edges, const PartLoads& loads, solver::LoadSet& set,
                EdgeForces* forces) {
  if (forces) forces->reserve(building.panels.size());
  int shell = 0;
  for (std::size_t p = 0; p < building.panels.size(); ++p) {
    const Panel& panel = building.panels[p];
    const int own_shell = panel.model == PanelModel::membrane ? shell++ : -1;
    const PanelAction& action = loads.panels[p];
    const TributaryLoads handed = handed_by(building, edges, loads, p);
    if (forces) forces->push_back(handed.edge_force);
    set.beams.insert(set.beams.end(), handed.beams.begin(), handed.beams.end());
    set.nodes.insert(set.nodes.end(), handed.nodes.begin(), handed.nodes.end());
    if (own_shell >= 0 && action.strain != 0) set.shells.push_back({own_shell, Vec3::Zero(), action.strain});
  }
}

/// A spring whose far end is moved pushes its node.
void add_settlements(const Building& building, const PartLoads& loads, solver::LoadSet& set) {
  for (const solver::Settlement& settlement : loads.settlements) {
    for (const NodeSupport& support : building.supports) {
      const double stiffness = support.stiffness(settlement.component);
      if (support.node.index != settlement.node || stiffness == 0) continue;
      if (stiffness == unlimited) {
        set.settlements.push_back(settlement);
      } else {
        solver::NodeLoad push{settlement.node, Vec6::Zero()};
        push.load(settlement.component) = stiffness * settlement.value;
        set.nodes.push_back(push);
      }
    }
  }
}

}  // namespace

EdgeForces edge_forces(const Building& building, const EdgeMembers& edges, const PartLoads& loads) {
  EdgeForces forces;
  for (std::size_t p = 0; p < building.panels.size(); ++p)
    forces.push_back(handed_by(building, edges, loads, p).edge_force);
  return forces;
}

solver::LoadSet load_set(const Building& building, const EdgeMembers& edges, const PartLoads& loads) {
  std::vector<solver::BeamLoad> beams;
  for (const auto& member : loads.members) beams.insert(beams.end(), member.begin(), member.end());
  return load_set(building, edges, loads, std::move(beams));
}

solver::LoadSet load_set(const Building& building, const EdgeMembers& edges, const PartLoads& loads,
                         std::vector<solver::BeamLoad> on_members, EdgeForces* forces) {
  solver::LoadSet set;
  set.beams = std::move(on_members);
  for (std::size_t n = 0; n < loads.nodes.size(); ++n)
    if (!loads.nodes[n].isZero(0)) set.nodes.push_back({static_cast<int>(n), loads.nodes[n]});
  add_panels(building, edges, loads, set, forces);
  add_settlements(building, loads, set);
  return set;
}

solver::LoadSet load_set(const Building& building, const PartLoads& loads) {
  return load_set(building, EdgeMembers(building), loads);
}

}  // namespace topple::structure
