#include "failure/edge_demands.h"

#include "model/index_of.h"

namespace topple::structure {

EdgeDemands::EdgeDemands(const Building& building, const PanelBearings& bearings, const FrameLoads& loads)
    : bearings_(bearings), loads_(loads), building_(building), states_(building.panels.size()) {
  for (std::size_t p = 0; p < building.panels.size(); ++p) edges_.push_back(panel_edge_axes(building, PanelId(p)));
}

void EdgeDemands::set_corner_forces(PanelId membrane, const std::array<Vec6, 4>& forces) {
  State& own = states_[index_of(membrane)];
  own.corner_forces = forces;
  own.corners_read = false;
}

bool EdgeDemands::changed(PanelId panel) const {
  const State& own = states_[index_of(panel)];
  const bool membrane = bearings_.membrane(panel);
  return own.version != loads_.edges_version(panel) || own.membrane != membrane || (membrane && !own.corners_read);
}

const std::array<Vec6, 4>& EdgeDemands::read(PanelId panel) {
  State& own = states_[index_of(panel)];
  if (!changed(panel)) return own.demands;
  const std::array<bool, 4>& holds = bearings_.holds(panel);
  if (own.version != loads_.edges_version(panel)) {
    for (int edge = 0; edge < 4; ++edge)
      own.handed[static_cast<std::size_t>(edge)] =
          holds[static_cast<std::size_t>(edge)]
              ? handed_edge_demand(building_, bearings_, panel, edge, loads_.edge_force(panel, edge))
              : Vec6(Vec6::Zero());
    own.version = loads_.edges_version(panel);
  }
  own.membrane = bearings_.membrane(panel);
  own.corners_read = true;
  own.demands = own.handed;
  if (!own.membrane) return own.demands;
  const std::array<Vec6, 4> traction = membrane_edge_demands(edges_[index_of(panel)], own.corner_forces);
  for (std::size_t edge = 0; edge < 4; ++edge)
    if (holds[edge]) own.demands[edge] = traction[edge] + own.handed[edge];
  return own.demands;
}

}  // namespace topple::structure
