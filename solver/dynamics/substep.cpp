// One substep: from the motion before it to the one after it, and the accounts of energy.
#include <optional>
#include <utility>

#include "dynamics/dynamic_state.h"
#include "dynamics/shorter_substeps.h"

namespace topple::solver {

void FrameDynamics::State::advance_substep(const JointLaw* law) {
  options.second_order ? advance_second_order(law) : advance_first_order(law);
}

void FrameDynamics::State::break_all(const JointLaw* law) {
  std::optional<MotionState> start;
  while (law != nullptr && break_joints(*law)) {
    ++counters.retaken;
    if (!start) start = before;
    (void)apply_changes(&*start);
    patterns.find(system());
    advance_substep(law);
  }
  accept();
}

void FrameDynamics::State::advance_first_order(const JointLaw* law) {
  solve_elastic();
  find_end();
  if (law != nullptr) yield(law->plastic_hinges());
}

void FrameDynamics::State::solve_elastic() {
  kinks.restore();
  collocated_load = constant_load + substep_load;
  patterns.add_to(method.af, collocated_load);
  kinks.add_start(system(), collocated_load);
  if (options.second_order) geometric.add_to(method.af, collocated_load);
  equation.set(system(), method, options.damping, before, collocated_load,
               options.keep_energy ? &ledger.products(system(), before) : nullptr);
  solve_substep(equation.w());
}

void FrameDynamics::State::solve_substep(Eigen::VectorXd& x) { solve_of_parts(parts, method.s, x); }

void FrameDynamics::State::solve_of_parts(int into, double s, Eigen::VectorXd& x) {
  into == 1 ? core().solve_as_it_stands(x) : shorter->solve(system(), into, s, x);
}

void FrameDynamics::State::foresee() {
  patterns.find(system());
  if (options.second_order) {
    evaluate_end();
    geometric.begin(find_geometric_load(nodes.end().u, true));
  }
  solve_elastic();
  MotionState end;
  equation.find_end(method, before, end);
  foreseen.assign(frame.model().nodes.size(), Vec6::Zero());
  system().node_displacements_of_scaled((end.v - before.v) / method.h, foreseen);
}

void FrameDynamics::State::find_end() {
  equation.find_end(method, before, now);
  nodes.forget();
  accepted = false;
}

/// By nodes, as far as they are asked for.
void FrameDynamics::State::evaluate_nodes() {
  evaluate_end();
  nodes.evaluate(system(), accepted ? now : before, accepted ? before : now);
}

void FrameDynamics::State::evaluate_end() {
  if (nodes.evaluate_end(system(), accepted ? before : now)) reactions.clear();
}

/// At the start of the substep under way.
double FrameDynamics::State::stored_energy() {
  return options.keep_energy ? ledger.store(system(), before, kinks.elastic(before.u)) : 0;
}

/// What the forces of the substep have done, along its displacement.
void FrameDynamics::State::account_energy() {
  kinks.add_turned(of_new_turn(), collocated_load);
  ledger.book_loads(before, now, collocated_load, substep_load);
  kinks.account(
      before.u, now.u, method, options.damping.stiffness,
      [this](std::size_t beam) { return fixed_end_of_loads(beam, true); }, ledger.terms());
  ledger.book_start(method, options.damping);
}

void FrameDynamics::State::accept() {
  if (options.keep_energy) account_energy();
  std::swap(before, now);
  if (kinks.accept()) ++counters.yielding;
  accepted = true;
  foreseen.clear();
  ledger.forget_products();
  if (options.keep_energy) {
    stored_energy();
    ledger.book_end(now, before, method, options.damping);  // both were exchanged
  }
  time += method.h;
  patterns.accept();
  recent_loads.accept(method.h);
}

}  // namespace topple::solver
