// One substep: from the motion before it to the one after it, and the accounts of energy.
#include <algorithm>
#include <utility>

#include "dynamics/dynamic_state.h"

namespace topple::solver {
void FrameDynamics::State::find_products() {
  if (products_known) return;
  products_known = true;
  const Eigen::Index n = equations();
  motion_columns.resize(4, n);
  motion_columns.row(0) = before.u;
  motion_columns.row(1) = before.v;
  motion_columns.row(2) = before.a;
  motion_columns.row(3).setZero();
  multiply<4>(system().mass(), motion_columns, mass_products);
  moved_columns.resize(2, n);
  moved_columns.row(0) = before.u;
  moved_columns.row(1) = before.v;
  multiply<2>(system().matrix(), moved_columns, matrix_products);
}

void FrameDynamics::State::find_collocated_load() {
  collocated_load = constant_load + substep_load;
  for (const LoadPattern& pattern : patterns) {
    const double value = method.af * pattern.before + (1 - method.af) * pattern.now;
    if (value != 0) collocated_load += value * pattern.force;
  }
  for (Kink& kink : kinks) {
    if (kink.before == 0) continue;
    find_kink(kink);
    collocated_load += kink.before * kink.force;
  }
  if (options.second_order) collocated_load += method.af * geometric_before + (1 - method.af) * geometric_now;
}

void FrameDynamics::State::take_substep(const JointLaw* law) {
  options.second_order ? take_second_order_substep(law) : take_first_order_substep(law);
}

void FrameDynamics::State::take_first_order_substep(const JointLaw* law) {
  const double h = method.h, am = method.am, af = method.af, a0 = options.damping.mass, a1 = options.damping.stiffness;
  for (Kink& kink : kinks) kink.now = kink.before;
  const double by_v = (1 - af) * h + a1;
  const double by_a = (1 - af) * h * h * (0.5 - method.beta) + a1 * (1 - af) * h * (1 - method.gamma);
  q = before.u + by_v * before.v + by_a * before.a;
  find_collocated_load();
  w = collocated_load;
  const double foreseen = (1 - af) * h;
  if (options.keep_energy) {
    find_products();
    w += (method.s * mass_products.row(0) + (method.s * by_v - a0) * mass_products.row(1) +
          (method.s * by_a - am - a0 * foreseen) * mass_products.row(2))
             .transpose();
  } else {
    z = (method.s * q - am * before.a - a0 * (before.v + foreseen * before.a)).transpose();
    multiply<1>(system().mass(), z, mass_z);
    w += mass_z.row(0).transpose();
  }
  core().solve_as_it_stands(w);
  find_end();
  if (law != nullptr) yield(law->plastic_hinges());
}

/// From w: the motion at the substep's end.
void FrameDynamics::State::find_end() {
  const double h = method.h;
  now.a = (w - q) / method.c;
  now.u = before.u + h * before.v + h * h * ((0.5 - method.beta) * before.a + method.beta * now.a);
  now.v = before.v + h * ((1 - method.gamma) * before.a + method.gamma * now.a);
  nodes_known = end_known = accepted = false;
}

/// By nodes, as far as they are asked for.
void FrameDynamics::State::know_nodes() {
  if (nodes_known) return;
  know_end();
  nodes_known = true;
  const MotionState& start = accepted ? now : before;
  const MotionState& end = accepted ? before : now;
  system().node_displacements_of_scaled(start.u, nodes_before.u);
  system().node_displacements_of_scaled(start.v, nodes_before.v);
  system().node_displacements_of_scaled(end.v, nodes_now.v);
}

void FrameDynamics::State::know_end() {
  if (end_known) return;
  end_known = true;
  reactions.clear();
  system().node_displacements_of_scaled((accepted ? before : now).u, nodes_now.u);
}

/// 1/2 v'Mv + 1/2 u'Ku at the start of the substep under way.
double FrameDynamics::State::stored_energy() {
  if (!options.keep_energy) return 0;
  find_products();
  energy.kinetic = 0.5 * mass_products.row(1).dot(before.v.transpose());
  energy.elastic = 0.5 * (matrix_products.row(0) - method.s * mass_products.row(0)).dot(before.u.transpose());
  energy.elastic += elastic_of_kinks();
  return energy.kinetic + energy.elastic;
}

/// What the forces of the substep have done, along its displacement.
void FrameDynamics::State::book() {
  const double a0 = options.damping.mass, a1 = options.damping.stiffness, foreseen = (1 - method.af) * method.h;
  moved = now.u - before.u;
  const double of_breaks = substep_load.dot(moved);
  for (const Kink& kink : kinks)
    if (kink.now != kink.before) collocated_load += (kink.now - kink.before) * of_new_turn() * kink.force;
  energy.external_work += collocated_load.dot(moved) - of_breaks;
  account_kinks();
  energy.freed -= of_breaks;
  if (a0 > 0) energy.damped += a0 * (mass_products.row(1) + foreseen * mass_products.row(2)).dot(moved.transpose());
  if (a1 > 0)
    energy.damped += a1 * method.af * (matrix_products.row(1) - method.s * mass_products.row(1)).dot(moved.transpose());
  old_products.resize(2, equations());
  old_products.row(0) = mass_products.row(2);
  old_products.row(1) = matrix_products.row(0) - method.s * mass_products.row(0);
}

/// What the substep's equation, times its displacement du, has beyond the change of energy, all at its end: of K
/// (1/2 - af) du'K du, and of M what is left of du'M a(n+1-am) once the change of 1/2 v'Mv is taken out, with
/// du = h (v + v(n+1))/2 + h2 (b - g/2) da and a(n+1-am) = dv/h + (1/2 - af) da.
void FrameDynamics::State::account_numerical() {
  const double h = method.h, part = 0.5 - method.af, by_a = method.beta - method.gamma / 2;
  if (part == 0 && by_a == 0) return;
  const auto& start = now;  // both were exchanged
  const auto& end = before;
  const auto stiff = matrix_products.row(0) - method.s * mass_products.row(0) - old_products.row(1);
  const auto inert = (mass_products.row(2) - old_products.row(0)).eval();
  energy.numerical += part * stiff.dot(moved.transpose());
  energy.numerical += part * h / 2 * inert.dot((start.v + end.v).transpose());
  energy.numerical += h * by_a * inert.dot((end.v - start.v).transpose());
  energy.numerical += h * h * by_a * part * inert.dot((end.a - start.a).transpose());
}

void FrameDynamics::State::accept() {
  if (options.keep_energy) book();
  std::swap(before, now);
  for (Kink& kink : kinks) kink.current = kink.now;
  accepted = true;
  products_known = false;
  if (options.keep_energy) {
    stored_energy();
    account_numerical();
    if (options.damping.stiffness > 0)
      energy.damped += options.damping.stiffness * (1 - method.af) *
                       (matrix_products.row(1) - method.s * mass_products.row(1)).dot(moved.transpose());
  }
  time += method.h;
  brought.clear();
  for (LoadPattern& pattern : patterns) pattern.current = pattern.now;
  if (std::any_of(kinks.begin(), kinks.end(), [](const Kink& kink) { return kink.held != 0; })) ++counters.yielding;
}

}  // namespace topple::solver
