// Second order in motion: the axial forces of the moment push and pull the beams that have moved. The matrix stays
// elastic, these forces act as loads, K u' = F - Kg(N) u, at both ends of each substep: those at its end are found with
// the motion there. Beside K + s M the geometric stiffness is small, so that each pass brings several digits.
#include "assembly/scaled_equations.h"
#include "dynamics/dynamic_state.h"
#include "dynamics/rigid_ends.h"
#include "topple/solver/geometric_forces.h"

namespace topple::solver {
namespace {

constexpr int most_passes = 20;

}  // namespace

Vec12 FrameDynamics::State::geometric_end_forces(int beam, const std::vector<Vec6>& displacements,
                                                 const Vec12& elastic) const {
  const Beam& own = system().model.beams[static_cast<std::size_t>(beam)];
  const auto at = [&](std::size_t end) -> const Vec6& {
    return displacements[static_cast<std::size_t>(own.node[end])];
  };
  return geometric_forces(own, elastic, at(0), at(1));
}

/// Scaled; `at_end`: plastic rotations and loads as at the end of the substep under way, else as at its start.
Eigen::VectorXd FrameDynamics::State::find_geometric_load(const std::vector<Vec6>& displacements, bool at_end) const {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(system().dofs().equations + system().dofs().held);
  for (int beam = 0; beam < static_cast<int>(system().model.beams.size()); ++beam) {
    if (system().beam_stands[static_cast<std::size_t>(beam)] == 0) continue;
    const Vec12 own = geometric_end_forces(beam, displacements, elastic_end_forces(beam, displacements, at_end));
    if (!own.isZero(0)) add_on_rigid_ends(system(), beam, -own, force);
  }
  return scaled_force(system(), force);
}

/// Where the passes do not settle, a beam is pressed beyond what it bears: the loads of the substep's start act on.
void FrameDynamics::State::advance_second_order(const JointLaw* law) {
  accepted = false;  // the nodes at the start are those of `before`
  nodes.set_start(system(), before);
  geometric.begin(find_geometric_load(nodes.start().u, false));
  for (int pass = 0; pass < most_passes; ++pass) {
    advance_first_order(law);
    evaluate_end();
    const SettlingLoad::Pass done = geometric.iterate(find_geometric_load(nodes.end().u, true));
    if (done == SettlingLoad::Pass::settled) return;
    if (done == SettlingLoad::Pass::lost) break;
  }
  ++counters.unsettled;
  geometric.give_up();
  advance_first_order(law);
}

double FrameDynamics::geometric_work_to(const std::vector<Vec6>& displacements) {
  State& state = *state_;
  if (!state.options.second_order) return 0;
  state.begin_changed();
  state.evaluate_nodes();
  const Eigen::VectorXd way = scaled_displacements(state.system(), displacements) - state.current().u;
  return 0.5 *
         way.dot(state.find_geometric_load(state.nodes.end().u, true) + state.find_geometric_load(displacements, true));
}

}  // namespace topple::solver
