// What breaks, goes or is loaded otherwise: the matrices, and what becomes of momentum and energy.
#include <algorithm>

#include "dynamics/dynamic_state.h"
#include "elements/beam_mass.h"

namespace topple::solver {

/// Loads of the last substep's breaks end.
void FrameDynamics::State::begin_substep() {
  breaks.clear();
  broken.clear();
  changed.clear();
  substep_load.setZero(equations());
  for (LoadPattern& pattern : patterns) {
    pattern.before = pattern.current;
    pattern.now = pattern.next;
  }
  begin_kinks();
}

void FrameDynamics::State::apply_changes() {
  if (prepared && !core().pending()) return;
  if (!prepared) {
    take_changes();
    prepared = true;
    before.u.setZero(equations());
    before.v = before.a = before.u;
    now = before;
    substep_load.setZero(equations());
    return;
  }
  const double stored = stored_energy();
  remember_changing_beams();
  drop_bare_nodes();
  take_changes();
  clear_dropped();
  products_known = nodes_known = end_known = false;
  forget_kinks();
  for (Kink& kink : kinks)
    if (kink.current != 0) find_kink(kink);
  if (options.keep_energy) energy.freed += stored - stored_energy();
  find_substep_load();
  for (LoadPattern& pattern : patterns)
    if (pattern.kind != LoadPattern::Kind::holding) pattern.force.resize(0);
}

void FrameDynamics::State::take_changes() {
  Reanalysis::State& own = core();
  const bool supports_change = !own.changed_supports.empty();
  const NodeMotion motion = [&] {
    NodeMotion found;
    if (!prepared || !supports_change) return found;
    found.u.resize(own.system->model.nodes.size());
    found.v = found.u;
    own.system->node_displacements_of_scaled(before.u, found.u);
    own.system->node_displacements_of_scaled(before.v, found.v);
    return found;
  }();
  const FrameSystem* numbered = own.system.get();
  own.take_changes(nullptr);
  if (own.mechanism) {
    const Defect defect = *std::exchange(own.mechanism, std::nullopt);
    throw Instability(defect.message, defect.motion);
  }
  LoadVector load = own.load;
  own.system->drop_idle_moments(load);
  constant_load = scaled(load.force);
  if (own.system.get() == numbered || motion.u.empty()) return;
  // A support's freedom became free or held: the equations are others now. Accelerations begin anew.
  before.u = scaled_equations(motion.u);
  before.v = scaled_equations(motion.v);
  before.a.setZero(equations());
  now = before;
  substep_load.setZero(equations());
  for (LoadPattern& pattern : patterns) pattern.force.resize(0);
}

/// How the ends of beams that change followed their nodes at the start of this substep.
void FrameDynamics::State::remember_changing_beams() {
  for (const int beam : core().changed_beams) {
    const auto i = static_cast<std::size_t>(beam);
    const Beam& now_is = system().model.beams[i];
    if (now_is.density == 0 || system().beam_stands[i] == 0 || now_is.end_stiffness == core().targets[i].end_stiffness)
      continue;
    const bool known = std::any_of(changed.begin(), changed.end(), [&](const auto& c) { return c.beam == beam; });
    if (known) continue;
    const Mat12 follows = ends_by_rigid_ends(now_is);
    changed.push_back({beam, follows, momentum_of(beam, follows, before.v)});
  }
}

bool FrameDynamics::State::bare(int node) {
  const auto n = static_cast<std::size_t>(node);
  const FrameModel& model = system().model;
  if (system().node_stands[n] == 0 || system().dofs().diaphragm_of_node[n] >= 0) return false;
  if (!inertia.at_node[n].head<3>().isZero(0) || !system().patches_of_node(node).empty()) return false;
  for (const Support& support : model.supports)
    if (support.node == node && !support.stiffness.head<3>().isZero(0)) return false;
  for (const int shell : system().shells_of_node(node))
    if (core().shell_removed[static_cast<std::size_t>(shell)] == 0) return false;
  for (const int beam : system().beams_of_node(node)) {
    const BeamTarget& target = core().targets[static_cast<std::size_t>(beam)];
    const Beam& b = model.beams[static_cast<std::size_t>(beam)];
    for (std::size_t end = 0; end < 2; ++end)
      if (b.node[end] == node && !target.removed && !target.end_stiffness[end].isZero(0)) return false;
  }
  return true;
}

/// A node that holds nothing any more and has no mass is left out.
void FrameDynamics::State::drop_bare_nodes() {
  std::vector<int> nodes;
  const auto look_at = [&](const auto& element_nodes) {
    for (const int node : element_nodes)
      if (bare(node)) nodes.push_back(node);
  };
  for (const int beam : core().changed_beams) look_at(system().model.beams[static_cast<std::size_t>(beam)].node);
  for (const int shell : core().changed_shells) look_at(system().model.shells[static_cast<std::size_t>(shell)].node);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  if (!nodes.empty()) frame.drop_nodes(nodes);
}

void FrameDynamics::State::clear_dropped() {
  const auto& first = system().dofs().first_equation;
  for (std::size_t n = 0; n < system().model.nodes.size(); ++n) {
    if (system().node_stands[n] != 0) continue;
    for (int e = first[n]; e < first[n + 1]; ++e) before.u(e) = before.v(e) = before.a(e) = 0;
  }
}

void FrameDynamics::State::add_on_rigid_ends(int beam, const Vec12& local, Eigen::VectorXd& force) const {
  const Beam& b = system().model.beams[static_cast<std::size_t>(beam)];
  const Vec12 global = node_forces(b, local);
  for (std::size_t end = 0; end < 2; ++end)
    if (system().node_stands[static_cast<std::size_t>(b.node[end])] != 0)
      system().dofs().add_node_force(b.node[end], global.segment<6>(static_cast<Eigen::Index>(6 * end)), force.data());
}

Vec12 FrameDynamics::State::missing_momentum(const ChangedBeam& change) {
  const auto i = static_cast<std::size_t>(change.beam);
  if (system().beam_stands[i] == 0) return Vec12::Zero();
  const Beam& beam = system().model.beams[i];
  const double spread = i < inertia.masses.beam_lengths.size() ? inertia.masses.beam_lengths[i] : 0;
  const Mat12 follows = ends_by_rigid_ends(beam);
  const Mat12 M = mass_between_ends(beam, inertia.masses, spread > 0 ? spread : beam.length);
  const auto velocity = [&](std::size_t end) { return system().node_displacement_of_scaled(beam.node[end], before.v); };
  const Vec12 rigid_ends = rigid_end_displacements(beam, velocity(0), velocity(1));
  return follows.transpose() * M * (change.followed - follows) * rigid_ends;
}

/// Forces of joints until they broke, on the node and on the beam's own end, which hands it to its other node; and the
/// momentum of beams that swing from one end alone now.
void FrameDynamics::State::find_substep_load() {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(system().dofs().equations + system().dofs().held);
  substep_fixed_end.clear();
  for (const BrokenJoint& joint : broken) {
    const Beam& beam = system().model.beams[static_cast<std::size_t>(joint.beam)];
    Vec12 on_rigid_end = Vec12::Zero();
    on_rigid_end.segment<6>(static_cast<Eigen::Index>(6 * joint.end)) = -joint.mean_force;
    add_on_rigid_ends(joint.beam, on_rigid_end, force);
    BeamLoad at_end;
    at_end.beam = joint.beam;
    at_end.kind = BeamLoad::Kind::point;
    at_end.from = joint.end == 0 ? 0 : beam.length;
    at_end.first = joint.mean_force;
    if (system().beam_stands[static_cast<std::size_t>(joint.beam)] == 0) continue;
    const Vec12 fixed = system().fixed_end_forces(joint.beam, {&at_end, 1}).force;
    add_on_rigid_ends(joint.beam, -fixed, force);
    const auto place = substep_fixed_end.try_emplace(joint.beam, Vec12::Zero()).first;
    place->second += fixed;
  }
  for (const ChangedBeam& change : changed) add_on_rigid_ends(change.beam, missing_momentum(change) / method.h, force);
  substep_load = scaled(force);
}

}  // namespace topple::solver
