#include "reanalysis/changing_load.h"

#include <algorithm>

namespace topple::solver {

ChangingLoad::ChangingLoad(const FrameModel& model)
    : node_loads_(model.nodes.size(), Vec6::Zero()),
      borne_(node_loads_),
      fixed_end_(model.beams.size(), Vec12::Zero()),
      at_nodes_(model.beams.size(), Vec12::Zero()),
      unbalanced_(model.beams.size(), 0) {}

void ChangingLoad::set_node(int node, const Vec6& load) {
  Vec6& own = node_loads_[static_cast<std::size_t>(node)];
  if (own == load) return;
  own = load;
  touch(node);
}

void ChangingLoad::set_beam(int index, const Beam& beam, const FixedEndForces& fixed) {
  const auto i = static_cast<std::size_t>(index);
  fixed_end_[i] = fixed.force;
  at_nodes_[i] = -node_forces(beam, fixed.force);
  unbalanced_[i] = fixed.unbalanced > 0 ? 1 : 0;
  for (const int node : beam.node) touch(node);
}

void ChangingLoad::update(const FrameSystem& system) {
  // What a diaphragm gathers belongs to many nodes.
  const auto gathered = [&](int node) { return system.dofs().diaphragm_of_node[static_cast<std::size_t>(node)] >= 0; };
  if (!known_ || std::any_of(stale_nodes_.begin(), stale_nodes_.end(), gathered)) {
    sum_up(system);
    known_ = true;
  } else {
    for (const int node : stale_nodes_) sum_up_at(system, node);
  }
  for (const int node : stale_nodes_)
    borne_[static_cast<std::size_t>(node)] = node_loads_[static_cast<std::size_t>(node)];
  stale_nodes_.clear();
  load_.unbalanced_beams.clear();
  for (std::size_t i = 0; i < unbalanced_.size(); ++i)
    if (unbalanced_[i] != 0 && system.beam_stands[i] != 0) load_.unbalanced_beams.push_back(static_cast<int>(i));
}

void ChangingLoad::sum_up(const FrameSystem& system) {
  const DofMap& dofs = system.dofs();
  load_.force = Eigen::VectorXd::Zero(dofs.equations + dofs.held);
  load_.held_displacement = Eigen::VectorXd::Zero(dofs.held);
  for (std::size_t n = 0; n < node_loads_.size(); ++n) {
    if (system.node_stands[n] != 0) dofs.add_node_force(static_cast<int>(n), node_loads_[n], load_.force.data());
  }
  for (std::size_t i = 0; i < fixed_end_.size(); ++i) {
    if (system.beam_stands[i] == 0) continue;
    const Beam& beam = system.model.beams[i];
    dofs.add_node_force(beam.node[0], at_nodes_[i].head<6>(), load_.force.data());
    dofs.add_node_force(beam.node[1], at_nodes_[i].tail<6>(), load_.force.data());
  }
}

void ChangingLoad::sum_up_at(const FrameSystem& system, int node) {
  const DofMap& dofs = system.dofs();
  const auto n = static_cast<std::size_t>(node);
  for (const int number : dofs.number[n]) load_.force(number) = 0;
  if (system.node_stands[n] != 0) dofs.add_node_force(node, node_loads_[n], load_.force.data());
  for (const int beam : system.beams_of_node(node)) {
    const auto i = static_cast<std::size_t>(beam);
    if (system.beam_stands[i] == 0) continue;
    const bool first = system.model.beams[i].node[0] == node;
    dofs.add_node_force(node, first ? Vec6(at_nodes_[i].head<6>()) : Vec6(at_nodes_[i].tail<6>()), load_.force.data());
  }
}

}  // namespace topple::solver
