// What breaks, goes or is loaded otherwise: the matrices, and what becomes of momentum and energy.
#include <utility>

#include "assembly/scaled_equations.h"
#include "dynamics/bare_nodes.h"
#include "dynamics/dynamic_state.h"
#include "dynamics/jumps.h"
#include "dynamics/shorter_substeps.h"

namespace topple::solver {

void FrameDynamics::State::begin_substep() {
  breaks.clear();
  changed.begin_substep();
  substep_load.setZero(equations());
  patterns.begin_substep();
  kinks.begin_substep();
}

void FrameDynamics::State::begin_changed() {
  begin_substep();
  if (!apply_changes() && changed.any_brought()) {
    const double stored = stored_energy();
    begin_motion_anew();
    if (options.keep_energy) ledger.terms().freed += stored - stored_energy();
  }
  changed.forget_impulses(system());
}

/// At an instant at which masses, stiffnesses or joints change: momentum that the velocities leave out is shared at
/// once, and accelerations are those of what stands from now on. Those of a light node would throw what a beam that
/// lost its other end hangs on it, and an impulse spread over the substep is followed by its like of the other sign: of
/// either the method makes energy, by an amount that hangs on the substep.
void FrameDynamics::State::begin_motion_anew() {
  const Eigen::VectorXd impulse = scaled_force(system(), changed.impulses(system(), inertia, before.v));
  if (!impulse.isZero(0)) before.v += velocities_that_share(Jumps::on_mass(system(), impulse));
  forget_motion();
  Eigen::VectorXd force = constant_load + substep_load;
  patterns.find(system());
  patterns.add_to(1, force);
  kinks.add_start(system(), force);
  if (options.second_order) {
    nodes.set_start(system(), before);
    force += find_geometric_load(nodes.start().u, false);
  }
  const SideBySide<8>& products = ledger.products(system(), before);
  const double a0 = options.damping.mass, a1 = options.damping.stiffness, s = inertia.factor;
  force -= (products.row(4) - s * products.row(0) + a1 * (products.row(5) - s * products.row(1)) + a0 * products.row(1))
               .transpose();
  before.a = at_once(std::move(force));
  forget_motion();
}

/// Without damping by M^-1, so that momentum is kept to rounding. With it M + d a1 K, by which other impulses go, would
/// hand more of it to supports than the shortest parts of a substep do, and need a factor of its own.
Eigen::VectorXd FrameDynamics::State::velocities_that_share(const Eigen::VectorXd& impulses) {
  return jumps->damps(system()) ? at_once(impulses) : jumps->velocities(system(), impulses);
}

/// Accelerations under a force, or velocities by an impulse: by (M + K/s)^-1, s of the shortest parts of a substep. By
/// M^-1 alone what they do not resolve would be thrown far beyond its place. For what they do resolve it is M^-1 to the
/// second order, and a factor is there.
Eigen::VectorXd FrameDynamics::State::at_once(Eigen::VectorXd force) {
  const int most = options.most_parts;
  const double s = method_of_parts(most).s;
  force *= s;
  solve_of_parts(most, s, force);
  return force;
}

void FrameDynamics::State::forget_motion() {
  ledger.forget_products();
  nodes.forget();
  foreseen.clear();
}

bool FrameDynamics::State::apply_changes(const MotionState* start) {
  if (prepared && !core().pending()) return false;
  if (!prepared) {
    renumber();
    prepared = true;
    before.u.setZero(equations());
    before.v = before.a = before.u;
    now = before;
    substep_load.setZero(equations());
    return false;
  }
  const double stored = stored_energy();
  if (start != nullptr) before = *start;
  const std::uint64_t changes = counters.changes;
  changed.remember(system(), inertia, core().changes, before);
  if (const std::vector<int> bare = bare_nodes(system(), inertia, core().changes); !bare.empty())
    frame.drop_nodes(bare);
  renumber();
  clear_dropped();
  forget_motion();
  kinks.find_anew(system());
  substep_load = scaled_force(system(), changed.load(system()));
  patterns.forget();
  const bool loads_alone = counters.changes == changes;
  if (!loads_alone) begin_motion_anew();
  if (options.keep_energy) ledger.terms().freed += stored - stored_energy();
  return !loads_alone;
}

void FrameDynamics::State::renumber() {
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
  const std::uint64_t of_loads = own.work.counters.load_solves;
  own.apply_changes(nullptr);
  if (own.work.counters.load_solves == of_loads) {  // not of loads alone
    jumps->forget_frame();
    shorter->forget_frame();
    ++counters.changes;
  }
  require_none(std::exchange(own.mechanism, std::nullopt));
  LoadVector load = own.load.vector();
  own.system->drop_idle_loads(load);
  constant_load = scaled_force(system(), load.force);
  if (own.system.get() == numbered || motion.u.empty()) return;
  // A support's freedom became free or held: the equations are others now. Accelerations begin anew.
  before.u = scaled_displacements(system(), motion.u);
  before.v = scaled_displacements(system(), motion.v);
  before.a.setZero(equations());
  now = before;
  substep_load.setZero(equations());
  patterns.forget_equations();
}

/// The motion goes on by a matrix of another s, which has another scale.
void FrameDynamics::State::set_method(const GeneralizedAlpha& other) {
  const auto scale = [&]() -> Eigen::VectorXd { return scale_of(system()); };
  const Eigen::VectorXd scaled_by = scale();
  whole = method = other;
  parts = 1;
  jumps->set_softened(damped_in_impulse());
  shorter->clear();
  inertia.factor = method.s;
  core().rebuild();
  core().answered = false;
  renumber();
  const Eigen::VectorXd ratio = scale().cwiseQuotient(scaled_by);
  for (Eigen::VectorXd* motion : {&before.u, &before.v, &before.a}) *motion = motion->cwiseQuotient(ratio);
  now = before;
  substep_load.setZero(equations());
  patterns.forget_equations();
  forget_motion();
  kinks.find_anew(system());
}

void FrameDynamics::State::clear_dropped() {
  const auto& first = system().dofs().first_equation;
  for (std::size_t n = 0; n < system().model.nodes.size(); ++n) {
    if (system().node_stands[n] != 0) continue;
    for (int e = first[n]; e < first[n + 1]; ++e) before.u(e) = before.v(e) = before.a(e) = 0;
  }
  for (Eigen::VectorXd* values : {&before.u, &before.v, &before.a}) system().drop_idle_motion(*values);
}

}  // namespace topple::solver
