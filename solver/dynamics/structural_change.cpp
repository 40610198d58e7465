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

/// With all that came since the last one.
void FrameDynamics::State::begin_changed() {
  begin_substep();
  const bool changes = !prepared || core().pending();
  apply_changes();
  if (!changes && changed.any_brought()) find_substep_load();
}

void FrameDynamics::State::forget_motion() {
  ledger.forget_products();
  nodes.forget();
  foreseen.clear();
}

void FrameDynamics::State::apply_changes() {
  if (prepared && !core().pending()) return;
  if (!prepared) {
    renumber();
    prepared = true;
    before.u.setZero(equations());
    before.v = before.a = before.u;
    now = before;
    substep_load.setZero(equations());
    return;
  }
  const double stored = stored_energy();
  changed.remember(system(), inertia, core().changes, before);
  if (const std::vector<int> bare = bare_nodes(system(), inertia, core().changes); !bare.empty())
    frame.drop_nodes(bare);
  renumber();
  clear_dropped();
  forget_motion();
  kinks.find_anew(system());
  if (options.keep_energy) ledger.terms().freed += stored - stored_energy();
  find_substep_load();
  patterns.forget();
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

void FrameDynamics::State::find_substep_load() {
  substep_load = scaled_force(system(), changed.load(system(), inertia, method.h, before.v));
}

}  // namespace topple::solver
