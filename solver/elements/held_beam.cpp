#include "topple/solver/held_beam.h"

#include "elements/beam.h"
#include "elements/beam_energy.h"
#include "topple/solver/beam_diagram.h"

namespace topple::solver {

HeldBeam hold_beam(const Beam& beam, std::span<const BeamLoad> loads) {
  HeldBeam held;
  held.end_forces = CondensedBeam(beam).fixed_end_forces(loads).force;
  const Vec12 at_nodes = node_forces(beam, held.end_forces);
  held.on_nodes = {-at_nodes.head<6>(), -at_nodes.tail<6>()};
  return held;
}

double held_strain_energy(const Beam& beam, std::span<const BeamLoad> loads) {
  return beam_strain_energy(beam, 1, CondensedBeam(beam).fixed_end_forces(loads).force, loads);
}

Vec3 held_displacement(const Beam& beam, double distance, std::span<const BeamLoad> loads) {
  const Vec12 forces = CondensedBeam(beam).fixed_end_forces(loads).force;
  const Vec6 local = BeamDiagram(beam, forces, loads).displacement(distance, Vec12::Zero());
  return beam.axes.transpose() * local.head<3>();
}

}  // namespace topple::solver
