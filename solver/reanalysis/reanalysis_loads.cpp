// The right-hand side of a structure that changes: summed up from nothing once, and then only at the nodes whose loads
// or members changed, term by term in the same order, so that it has the same bits either way.
#include <algorithm>

#include "reanalysis/reanalysis_state.h"

namespace topple::solver {

void Reanalysis::State::update_load() {
  // What a diaphragm gathers belongs to many nodes.
  const auto gathered = [&](int node) { return system->dofs().diaphragm_of_node[static_cast<std::size_t>(node)] >= 0; };
  if (!load_known || std::any_of(stale_load_nodes.begin(), stale_load_nodes.end(), gathered)) {
    sum_up_load();
    load_known = true;
  } else {
    for (const int node : stale_load_nodes) sum_up_load_at(node);
  }
  stale_load_nodes.clear();
  load.unbalanced_beams.clear();
  for (std::size_t i = 0; i < unbalanced.size(); ++i)
    if (unbalanced[i] != 0 && system->beam_stands[i] != 0) load.unbalanced_beams.push_back(static_cast<int>(i));
}

void Reanalysis::State::sum_up_load() {
  const DofMap& dofs = system->dofs();
  load.force = Eigen::VectorXd::Zero(dofs.equations + dofs.held);
  load.held_displacement = Eigen::VectorXd::Zero(dofs.held);
  for (std::size_t n = 0; n < node_loads.size(); ++n) {
    if (system->node_stands[n] != 0) dofs.add_node_force(static_cast<int>(n), node_loads[n], load.force.data());
  }
  for (std::size_t i = 0; i < fixed_end.size(); ++i) {
    if (system->beam_stands[i] == 0) continue;
    const Beam& beam = system->model.beams[i];
    dofs.add_node_force(beam.node[0], fixed_at_nodes[i].head<6>(), load.force.data());
    dofs.add_node_force(beam.node[1], fixed_at_nodes[i].tail<6>(), load.force.data());
  }
}

void Reanalysis::State::sum_up_load_at(int node) {
  const DofMap& dofs = system->dofs();
  const auto n = static_cast<std::size_t>(node);
  for (const int number : dofs.number[n]) load.force(number) = 0;
  if (system->node_stands[n] != 0) dofs.add_node_force(node, node_loads[n], load.force.data());
  for (const int beam : system->beams_of_node(node)) {
    const auto i = static_cast<std::size_t>(beam);
    if (system->beam_stands[i] == 0) continue;
    const bool first = system->model.beams[i].node[0] == node;
    dofs.add_node_force(node, first ? Vec6(fixed_at_nodes[i].head<6>()) : Vec6(fixed_at_nodes[i].tail<6>()),
                        load.force.data());
  }
}

}  // namespace topple::solver
