// Momentum of parts of a frame that moves, and impulses on it.
#include <utility>

#include "assembly/checked_index.h"
#include "assembly/scaled_equations.h"
#include "dynamics/dynamic_state.h"
#include "dynamics/jumps.h"
#include "dynamics/rigid_ends.h"
#include "elements/beam_mass.h"

namespace topple::solver {
Eigen::VectorXd FrameDynamics::State::scaled_impulses(std::span<const Impulse> impulses) const {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(system().dofs().equations + system().dofs().held);
  for (const Impulse& one : impulses) {
    if (system().node_stands[checked_node(system().model, one.node)] != 0)
      system().dofs().add_node_force(one.node, one.impulse, force.data());
  }
  return scaled_force(system(), force);
}

Eigen::MatrixXd FrameDynamics::State::scaled_columns(std::span<const std::vector<Impulse>> forces) const {
  Eigen::MatrixXd F(equations(), static_cast<Eigen::Index>(forces.size()));
  for (std::size_t j = 0; j < forces.size(); ++j) F.col(static_cast<Eigen::Index>(j)) = scaled_impulses(forces[j]);
  return F;
}

/// Damping answers a jump of velocities at once: accelerations that did not would make the method create energy in
/// modes that it does not resolve. Implicit, as velocities that follow impulses: the acceleration itself would throw a
/// mode that is damped within much less than a substep far beyond its place.
void FrameDynamics::State::follow_jump(const Eigen::VectorXd& change) {
  const double a0 = options.damping.mass, a1 = options.damping.stiffness;
  if (a1 > 0) {
    const SideBySide<1> v = change.transpose();
    SideBySide<1> whole, inert;
    multiply<1>(system().matrix(), v, whole);
    multiply<1>(system().mass(), v, inert);
    before.a -= a1 * jumps->velocities(
                         system(), Jumps::on_mass(
                                       system(), (whole.row(0) - system().inertia->factor * inert.row(0)).transpose()));
  }
  before.a -= a0 * change;
}

std::vector<Vec6> FrameDynamics::velocities_of(std::span<const Impulse> impulses) const {
  const State& state = *state_;
  std::vector<Vec6> result(state.frame.model().nodes.size(), Vec6::Zero());
  const Eigen::VectorXd on_mass = State::Jumps::on_mass(state.system(), state.scaled_impulses(impulses));
  state.system().node_displacements_of_scaled(state.jumps->velocities(state.system(), on_mass), result);
  return result;
}

Eigen::MatrixXd FrameDynamics::mobility(std::span<const std::vector<Impulse>> forces) const {
  const State& state = *state_;
  const Eigen::MatrixXd result = state.jumps->mobility(state.system(), state.scaled_columns(forces));
  return (result + result.transpose()) / 2;
}

Eigen::MatrixXd FrameDynamics::substep_mobility(std::span<const std::vector<Impulse>> forces) const {
  State& state = *state_;
  const Eigen::MatrixXd F = state.scaled_columns(forces), result = state.core().answers_between(F, F);
  return state.whole.gamma / (2 * state.whole.c) * (result + result.transpose());
}

void FrameDynamics::strike(std::span<const Impulse> impulses) {
  State& state = *state_;
  state.begin_changed();
  const FrameSystem& system = state.system();
  const Eigen::VectorXd own = State::Jumps::on_mass(system, state.scaled_impulses(impulses)),
                        of_changes =
                            State::Jumps::on_mass(system, state.scaled_impulses(std::exchange(state.waiting, {})));
  if ((own + of_changes).isZero(0)) return;
  const Eigen::VectorXd change = state.jumps->velocities(system, own + of_changes);
  const Eigen::VectorXd mean = state.before.v + change / 2;
  SideBySide<1> inert;
  multiply<1>(system.mass(), change.transpose(), inert);
  DynamicEnergy& energy = state.ledger.terms();
  energy.struck += own.dot(mean);
  energy.freed -= of_changes.dot(mean);
  energy.damped += (own + of_changes - inert.row(0).transpose()).dot(mean);
  state.before.v += change;
  state.follow_jump(change);
  state.forget_motion();
  state.stored_energy();
}

void FrameDynamics::add_impulses(std::span<const Impulse> impulses) {
  State& state = *state_;
  (void)state.scaled_impulses(impulses);  // each has a node
  state.waiting.insert(state.waiting.end(), impulses.begin(), impulses.end());
}

void FrameDynamics::add_momentum(int beam, const Vec6& momentum) {
  (void)checked_beam(model(), beam);
  state_->changed.bring(beam, momentum);
}

std::optional<ChangedMomentum::Left> FrameDynamics::State::left_with(int beam) const {
  return changed.left_with(system(), beam, core().changes.beam(static_cast<std::size_t>(beam)).loads, method.h);
}

Vec6 FrameDynamics::beam_momentum(int beam) const {
  const State& state = *state_;
  const Beam& own = model().beams[checked_beam(model(), beam)];
  if (is_held(state.system(), beam))
    return momentum_of_beam(state.system(), state.inertia.masses, beam, ends_by_rigid_ends(own), state.current().v) +
           state.changed.brought_to(beam);
  const std::optional<ChangedMomentum::Left> left = state.left_with(beam);
  return left ? left->momentum : Vec6(Vec6::Zero());
}

Vec12 FrameDynamics::beam_ends(int beam) const {
  const State& state = *state_;
  const Beam& own = model().beams[checked_beam(model(), beam)];
  Vec12 ends = Vec12::Zero();
  if (is_held(state.system(), beam))
    ends = own_end_motion(state.system(), beam, ends_by_rigid_ends(own), state.current().u);
  else if (const std::optional<ChangedMomentum::Left> left = state.left_with(beam))
    ends = left->ends;
  for (Eigen::Index part = 0; part < 12; part += 3)
    ends.segment<3>(part) = own.axes.transpose() * ends.segment<3>(part);
  return ends;
}

Vec6 FrameDynamics::node_momentum(int node) const {
  const State& state = *state_;
  const Vec6& mass = state.inertia.at_node.at(static_cast<std::size_t>(node));
  const Vec6 momentum = mass.cwiseProduct(state.system().node_displacement_of_scaled(node, state.current().v));
  Vec6 sum;
  for (int c = 0; c < 6; ++c)
    sum(c) = rigid_motion_at(state.system().model.nodes[static_cast<std::size_t>(node)], c).dot(momentum);
  return sum;
}

Vec6 FrameDynamics::patch_momentum(int patch) const {
  const State& state = *state_;
  const std::size_t i = checked_patch(model(), patch);
  const Patch& own = state.system().model.patches[i];
  if (own.mass.size() == 0) return Vec6::Zero();
  Eigen::VectorXd velocity(own.mass.cols());
  Eigen::Matrix<double, Eigen::Dynamic, 6> motions(own.mass.cols(), 6);
  for (std::size_t n = 0; n < own.node.size(); ++n) {
    const auto row = static_cast<Eigen::Index>(6 * n);
    const int node = own.node[n];
    velocity.segment<6>(row) = state.system().node_displacement_of_scaled(node, state.current().v);
    for (int c = 0; c < 6; ++c)
      motions.block<6, 1>(row, c) = rigid_motion_at(state.system().model.nodes[static_cast<std::size_t>(node)], c);
  }
  return motions.transpose() * (state.system().patch_node_mass(i) * velocity);
}

}  // namespace topple::solver
