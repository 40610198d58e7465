// What breaks, goes or is loaded otherwise: the matrices, and what becomes of momentum and energy.
#include <Eigen/Geometry>
#include <algorithm>

#include "assembly/scaled_equations.h"
#include "dynamics/dynamic_state.h"
#include "dynamics/impulse_factor.h"
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

/// With all that came since the last one.
void FrameDynamics::State::begin_changed() {
  begin_substep();
  const bool changes = !prepared || core().pending();
  apply_changes();
  if (!changes && !brought.empty()) find_substep_load();
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
  const bool supports_change = !own.changes.supports().empty();
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
  LoadVector load = own.load.vector();
  own.system->drop_idle_loads(load);
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

/// The motion goes on by a matrix of another s, which has another scale.
void FrameDynamics::State::set_method(const GeneralizedAlpha& other) {
  const auto scale = [&]() -> Eigen::VectorXd { return scale_of(system()); };
  const Eigen::VectorXd scaled_by = scale();
  method = other;
  impulses_by.reset();
  inertia.factor = method.s;
  core().rebuild();
  core().answered = false;
  take_changes();
  const Eigen::VectorXd ratio = scale().cwiseQuotient(scaled_by);
  for (Eigen::VectorXd* motion : {&before.u, &before.v, &before.a}) *motion = motion->cwiseQuotient(ratio);
  now = before;
  substep_load.setZero(equations());
  for (LoadPattern& pattern : patterns) {
    if (pattern.kind == LoadPattern::Kind::holding)
      pattern.force = pattern.force.cwiseProduct(ratio);
    else
      pattern.force.resize(0);
  }
  products_known = nodes_known = end_known = false;
  forget_kinks();
  for (Kink& kink : kinks)
    if (kink.current != 0) find_kink(kink);
}

/// How the ends of beams that change followed their nodes at the start of this substep.
void FrameDynamics::State::remember_changing_beams() {
  for (const int beam : core().changes.beams()) {
    const auto i = static_cast<std::size_t>(beam);
    const Beam& now_is = system().model.beams[i];
    if (now_is.density == 0 || system().beam_stands[i] == 0 ||
        now_is.end_stiffness == core().changes.beam(i).end_stiffness)
      continue;
    const bool known = std::any_of(changed.begin(), changed.end(), [&](const auto& c) { return c.beam == beam; });
    if (known) continue;
    const Mat12 follows = ends_by_rigid_ends(now_is);
    changed.push_back({beam, follows, momentum_of(beam, follows, before.v) + brought_to(beam)});
  }
}

bool FrameDynamics::State::shell_holds(int shell, int node) {
  const auto i = static_cast<std::size_t>(shell);
  if (core().changes.shell_removed(i)) return false;
  const FrameModel& model = system().model;
  if (model.shells[i].density != 0) return true;
  const Mat24* stiffness = core().changes.stiffness_of_shell(model, shell);
  if (stiffness == nullptr) return true;
  for (std::size_t corner = 0; corner < 4; ++corner)
    if (model.shells[i].node[corner] == node &&
        !stiffness->middleRows<6>(static_cast<Eigen::Index>(6 * corner)).isZero(0))
      return true;
  return false;
}

bool FrameDynamics::State::patch_holds(int patch, int node) {
  const Patch& own = system().model.patches[static_cast<std::size_t>(patch)];
  const Eigen::MatrixXd& stiffness = core().changes.stiffness_of_patch(system().model, patch);
  for (std::size_t n = 0; n < own.node.size(); ++n)
    if (own.node[n] == node && !stiffness.middleRows<6>(static_cast<Eigen::Index>(6 * n)).isZero(0)) return true;
  return false;
}

bool FrameDynamics::State::patch_weighs(int patch) {
  return !core().changes.mass_of_patch(system().model, patch).isZero(0);
}

/// The nodes to which what holds this one goes on, itself first; none where something of them has mass, or a support.
std::vector<int> FrameDynamics::State::bare_part(int start) {
  const FrameModel& model = system().model;
  std::vector<int> part{start};
  const auto reach = [&](int node) {
    if (std::find(part.begin(), part.end(), node) == part.end()) part.push_back(node);
  };
  for (std::size_t next = 0; next < part.size(); ++next) {
    const int node = part[next];
    const auto n = static_cast<std::size_t>(node);
    if (system().node_stands[n] == 0) continue;
    if (system().dofs().diaphragm_of_node[n] >= 0 || !inertia.at_node[n].head<3>().isZero(0)) return {};
    for (const int patch : system().patches_of_node(node))  // some hold on to the ground
      if (patch_weighs(patch) || patch_holds(patch, node)) return {};
    for (const Support& support : model.supports)
      if (support.node == node && !support.stiffness.head<3>().isZero(0)) return {};
    for (const int beam : system().beams_of_node(node)) {
      const BeamTarget& target = core().changes.beam(static_cast<std::size_t>(beam));
      const Beam& b = model.beams[static_cast<std::size_t>(beam)];
      if (target.removed) continue;
      for (std::size_t end = 0; end < 2; ++end) {
        if (b.node[end] != node || target.end_stiffness[end].isZero(0)) continue;
        if (target.density != 0) return {};
        if (!target.end_stiffness[1 - end].isZero(0)) reach(b.node[1 - end]);
      }
    }
    for (const int shell : system().shells_of_node(node)) {
      if (!shell_holds(shell, node)) continue;
      if (model.shells[static_cast<std::size_t>(shell)].density != 0) return {};
      for (const int corner : model.shells[static_cast<std::size_t>(shell)].node)
        if (shell_holds(shell, corner)) reach(corner);
    }
  }
  return part;
}

/// A part without mass on nothing that holds it is left out: often a node to which nothing holds any more.
void FrameDynamics::State::drop_bare_nodes() {
  std::vector<int> nodes;
  const auto look_at = [&](const auto& element_nodes) {
    for (const int node : element_nodes) {
      if (system().node_stands[static_cast<std::size_t>(node)] == 0) continue;
      const std::vector<int> part = bare_part(node);
      nodes.insert(nodes.end(), part.begin(), part.end());
    }
  };
  for (const int beam : core().changes.beams()) look_at(system().model.beams[static_cast<std::size_t>(beam)].node);
  for (const int shell : core().changes.shells()) look_at(system().model.shells[static_cast<std::size_t>(shell)].node);
  for (const auto& [shell, stiffness] : core().changes.shell_stiffness())
    look_at(system().model.shells[static_cast<std::size_t>(shell)].node);
  for (const auto& [patch, stiffness] : core().changes.patch_stiffness())
    look_at(system().model.patches[static_cast<std::size_t>(patch)].node);
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
  for (Eigen::VectorXd* values : {&before.u, &before.v, &before.a}) system().drop_idle_motion(*values);
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

/// Momentum that came to beams, as forces over a substep on the ends that hold them.
void FrameDynamics::State::add_brought(Eigen::VectorXd& force) const {
  for (const auto& [beam, momentum] : brought) {
    const Beam& own = system().model.beams[static_cast<std::size_t>(beam)];
    std::vector<int> held;
    for (std::size_t end = 0; end < 2; ++end)
      if (!own.end_stiffness[end].isZero(0) && system().node_stands[static_cast<std::size_t>(own.node[end])] != 0)
        held.push_back(own.node[end]);
    if (held.empty()) continue;  // it left
    const Vec6 share = momentum / (method.h * static_cast<double>(held.size()));
    const Vec3 linear = share.head<3>();
    Vec3 turning = share.tail<3>();
    for (const int node : held)
      turning -= system().model.nodes[static_cast<std::size_t>(node)].cross(linear) / static_cast<double>(held.size());
    for (const int node : held) {
      Vec6 own_force;
      own_force << linear, turning;
      system().dofs().add_node_force(node, own_force, force.data());
    }
  }
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
  add_brought(force);
  substep_load = scaled(force);
}

}  // namespace topple::solver
