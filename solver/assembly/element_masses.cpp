#include "assembly/element_masses.h"

#include <stdexcept>
#include <string>

#include "assembly/frame_elements.h"
#include "elements/beam_mass.h"

namespace topple::solver {

double mass_length(const MassModel& masses, const Beam& beam, int index) {
  const auto i = static_cast<std::size_t>(index);
  const double given = i < masses.beam_lengths.size() ? masses.beam_lengths[i] : 0;
  return given > 0 ? given : beam.length;
}

Mat12 beam_mass(const FrameElements& frame, const MassModel& masses, int index) {
  const Beam& beam = frame.model.beams[static_cast<std::size_t>(index)];
  std::array<Mat3, 2> arm;
  for (std::size_t end = 0; end < 2; ++end)
    arm[end] = arm_matrix(beam.offset[end]) + frame.dofs().diaphragm_arm(beam.node[end]);
  return to_node_freedoms(beam.axes, beam_mass_matrix(beam, masses, mass_length(masses, beam, index)), arm);
}

Mat24 shell_mass(const FrameElements& frame, const MassModel& masses, int index) {
  const Shell& shell = frame.model.shells[static_cast<std::size_t>(index)];
  const bool lumped = masses.distribution == MassDistribution::lumped;
  return ShellElement(shell, corner_places(shell, frame.model.nodes)).mass(shell.density * shell.thickness, lumped);
}

std::vector<Vec6> masses_at_nodes(const FrameModel& model, const MassModel& masses) {
  std::vector<Vec6> at(model.nodes.size(), Vec6::Zero());
  for (const NodeMass& given : masses.nodes) {
    if (given.node < 0 || static_cast<std::size_t>(given.node) >= at.size())
      throw std::invalid_argument("mass on node " + std::to_string(given.node) + ", which does not exist");
    if (!(given.mass >= 0) || !(given.inertia.array() >= 0).all())
      throw std::invalid_argument("mass on node " + std::to_string(given.node) + " is negative");
    Vec6& here = at[static_cast<std::size_t>(given.node)];
    here.head<3>().array() += given.mass;
    here.tail<3>() += given.inertia;
  }
  return at;
}

}  // namespace topple::solver
