#include "standing/motion/motion_model.h"

#include <utility>

#include "model/index_of.h"
#include "model/own_mass.h"

namespace topple::structure {

solver::FrameModel MotionModel::frame(int c) const {
  solver::FrameModel model = from_.statics.model(c);
  const std::vector<MemberId>& members = from_.statics.members(c);
  for (std::size_t b = 0; b < members.size(); ++b) {
    solver::Beam& beam = model.beams[b];
    beam.density = masses_.of(members[b]) / (beam.area * beam.length);
    if (!from_.parts.stands(members[b])) beam.end_stiffness = {Vec6::Zero(), Vec6::Zero()};
  }
  for (solver::Shell& shell : model.shells) shell.density = 0;
  const std::vector<PanelId>& membranes = from_.statics.membranes(c);
  for (std::size_t s = 0; s < membranes.size(); ++s)
    if (!from_.statics.stiff(membranes[s])) model.shell_stiffness[static_cast<int>(s)].setZero();
  for (const PanelId shell : from_.statics.shells(c))
    if (from_.statics.stiff(shell))
      model.patches[static_cast<std::size_t>(from_.statics.number(shell))].mass = mass(shell);
  const std::vector<NodeId>& nodes = from_.statics.nodes(c);
  for (std::size_t n = 0; n < nodes.size(); ++n)
    if (from_.node_solved[index_of(nodes[n])] == 0)
      model.supports.push_back({static_cast<int>(n), Vec6::Constant(solver::rigid)});
  return model;
}

solver::MassModel MotionModel::node_masses(int c) const {
  solver::MassModel masses;
  const std::vector<NodeId>& nodes = from_.statics.nodes(c);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const double mass = masses_.of(nodes[n]);
    if (mass > 0 && from_.node_solved[index_of(nodes[n])] != 0)
      masses.nodes.push_back({static_cast<int>(n), mass, Vec3::Zero()});
  }
  return masses;
}

std::vector<Vec6> MotionModel::at_rest(int c) const {
  std::vector<Vec6> rest;
  for (const NodeId node : from_.statics.nodes(c))
    rest.push_back(from_.node_solved[index_of(node)] != 0 ? from_.statics.displacement(node) : Vec6(Vec6::Zero()));
  return rest;
}

void MotionModel::lay_on(int c, solver::FrameDynamics& frame) const {
  for (const MemberId member : from_.statics.members(c)) {
    if (!from_.parts.stands(member)) continue;
    std::vector<solver::BeamLoad> loads = from_.statics.loads(member);
    for (solver::BeamLoad& load : loads) load.beam = from_.statics.number(member);
    if (!loads.empty()) frame.set_beam_loads(from_.statics.number(member), std::move(loads));
    if (const double factor = from_.statics.stiffness(member); factor != 1)
      frame.set_beam_stiffness_factor(from_.statics.number(member), factor);
  }
  for (const NodeId node : from_.statics.nodes(c))
    if (from_.node_solved[index_of(node)] != 0 && !from_.statics.load(node).isZero(0))
      frame.set_node_load(from_.statics.number(node), from_.statics.load(node));
  for (const PlasticHinge& hinge : from_.yielding.hinges(c)) {
    if (hinge.plastic_rotation == 0 || !from_.parts.standing(hinge.joint)) continue;
    const Joint& own = from_.building[hinge.joint];
    frame.set_plastic_rotation(from_.statics.number(own.member), own.end, hinge.axis, hinge.plastic_rotation);
  }
}

double MotionModel::kilograms(PanelId shell) const {
  const double by_weight = from_.loads.mass(shell);
  return by_weight > 0 ? by_weight : own_mass(from_.building, shell);
}

Eigen::MatrixXd MotionModel::mass(PanelId id) const { return from_.shells.of(id)->mass(kilograms(id)); }

}  // namespace topple::structure
