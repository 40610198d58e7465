// Momentum of parts of a frame that moves, and impulses on it.
#include <Eigen/Geometry>
#include <stdexcept>
#include <utility>

#include "assembly/checked_index.h"
#include "dynamics/dynamic_state.h"
#include "dynamics/impulse_factor.h"
#include "elements/beam_mass.h"

namespace topple::solver {
namespace {

/// Velocities are found to this share of the impulses: by so many passes of conjugate gradients at most, or so many
/// answers of the factor, of which one is nearly always enough.
constexpr double solved = 1e-12;
constexpr int most_passes = 2000, most_refinements = 3;
/// Damping over a substep, of s: with less than this conjugate gradients on M take few passes.
constexpr double least_share = 0.01;

/// Of a point at `at` in the rigid motion number `component`: translations along the axes, rotations about them through
/// the origin.
Vec6 rigid_motion_at(const Vec3& at, int component) {
  Vec6 motion = Vec6::Zero();
  motion(component) = 1;
  if (component >= 3) motion.head<3>() = Vec3::Unit(component - 3).cross(at);
  return motion;
}

/// Force and moment about the beam's first end of one of its loads, local axes; what makes no force is left out.
Vec6 resultant(const BeamLoad& load) {
  Vec6 sum = Vec6::Zero();
  const auto add = [&](double at, const Vec6& force) {
    sum += force;
    sum.tail<3>() += Vec3(at, 0, 0).cross(Vec3(force.head<3>()));
  };
  if (load.kind == BeamLoad::Kind::point) add(load.from, load.first);
  if (load.kind != BeamLoad::Kind::distributed) return sum;
  const double length = load.to - load.from;
  add(load.from + length / 3, load.first * (length / 2));
  add(load.to - length / 3, load.last * (length / 2));
  return sum;
}

double diagonal_of(const SparseSymmetric& A, Eigen::Index equation) {
  return A.value[static_cast<std::size_t>(A.start[static_cast<std::size_t>(equation)])];
}

}  // namespace

/// Its nodes move with these velocities (scaled equations), its ends follow them.
Vec6 FrameDynamics::State::momentum_of(int beam, const Mat12& follows, const Eigen::VectorXd& velocities) const {
  const auto i = static_cast<std::size_t>(beam);
  const Beam& own = system().model.beams[i];
  const double spread = i < inertia.masses.beam_lengths.size() ? inertia.masses.beam_lengths[i] : 0;
  const Vec12 rigid_ends = rigid_end_displacements(own, system().node_displacement_of_scaled(own.node[0], velocities),
                                                   system().node_displacement_of_scaled(own.node[1], velocities));
  const Vec12 momentum =
      mass_between_ends(own, inertia.masses, spread > 0 ? spread : own.length) * (follows * rigid_ends);
  Vec6 sum;
  for (int c = 0; c < 6; ++c) {
    const auto at = [&](std::size_t end) {
      return rigid_motion_at(system().model.nodes[static_cast<std::size_t>(own.node[end])], c);
    };
    sum(c) = rigid_end_displacements(own, at(0), at(1)).dot(momentum);
  }
  return sum;
}

/// Its joints' forces until they broke pushed it the other way, and its loads went on.
Vec6 FrameDynamics::State::momentum_left_with(const ChangedBeam& gone) const {
  const auto i = static_cast<std::size_t>(gone.beam);
  const Beam& own = system().model.beams[i];
  Vec12 impulse = Vec12::Zero();
  for (const BrokenJoint& joint : broken)
    if (joint.beam == gone.beam)
      impulse.segment<6>(static_cast<Eigen::Index>(6 * joint.end)) += method.h * joint.mean_force;
  for (const BeamLoad& load : core().changes.beam(i).loads) impulse.head<6>() += method.h * resultant(load);
  Vec6 sum = gone.momentum;
  for (int c = 0; c < 6; ++c) {
    const auto at = [&](std::size_t end) {
      return rigid_motion_at(system().model.nodes[static_cast<std::size_t>(own.node[end])], c);
    };
    sum(c) += rigid_end_displacements(own, at(0), at(1)).dot(impulse);
  }
  return sum;
}

Eigen::VectorXd FrameDynamics::State::scaled_impulses(std::span<const Impulse> impulses) const {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(system().dofs().equations + system().dofs().held);
  for (const Impulse& one : impulses) {
    if (system().node_stands[checked_node(system().model, one.node)] != 0)
      system().dofs().add_node_force(one.node, one.impulse, force.data());
  }
  return scaled(force);
}

/// What freedoms without mass are given comes to nothing.
Eigen::VectorXd FrameDynamics::State::on_mass(Eigen::VectorXd impulses) const {
  for (Eigen::Index e = 0; e < equations(); ++e)
    if (!(diagonal_of(system().mass(), e) > 0)) impulses(e) = 0;
  return impulses;
}

/// Stiffness damps what an impulse sets going within a substep: by so much of s that it has to be counted.
bool FrameDynamics::State::damps_jumps() const { return method.h * options.damping.stiffness * method.s > least_share; }

/// (M + h a1 K)^-1 times scaled impulses on mass.
Eigen::VectorXd FrameDynamics::State::velocities_of(const Eigen::VectorXd& impulses) {
  if (!damps_jumps()) return velocities_by_mass(impulses);
  const double damped = method.h * options.damping.stiffness, inert = 1 - damped * method.s;
  ImpulseFactor& factor = impulse_factor();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(impulses.size()), left = impulses, more;
  SideBySide<1> of_whole, of_mass;
  const double enough = solved * impulses.norm();
  for (int pass = 0; pass < most_refinements && left.norm() > enough; ++pass) {
    more = left;
    factor.solve(more);
    x += more;
    // K is what the substep's matrix has beside s M.
    multiply<1>(system().matrix(), x.transpose(), of_whole);
    multiply<1>(system().mass(), x.transpose(), of_mass);
    left = impulses - (damped * of_whole.row(0) + inert * of_mass.row(0)).transpose();
  }
  if (!x.allFinite()) throw std::runtime_error("the velocities that an impulse leaves were not found");
  return x;
}

/// The same where damping is next to nothing: conjugate gradients, each equation by its own mass.
Eigen::VectorXd FrameDynamics::State::velocities_by_mass(Eigen::VectorXd left) const {
  const Eigen::Index n = equations();
  const SparseSymmetric &M = system().mass(), &whole = system().matrix();
  const double damped = method.h * options.damping.stiffness, inert = 1 - damped * method.s;
  Eigen::VectorXd inverse(n), x = Eigen::VectorXd::Zero(n);
  for (Eigen::Index e = 0; e < n; ++e) {
    const double diagonal = damped > 0 ? damped * diagonal_of(whole, e) + inert * diagonal_of(M, e) : diagonal_of(M, e);
    inverse(e) = diagonal > 0 ? 1 / diagonal : 0;
  }
  SideBySide<1> of_whole;
  const auto apply = [&](const SideBySide<1>& v, SideBySide<1>& product) {
    multiply<1>(M, v, product);
    if (!(damped > 0)) return;
    multiply<1>(whole, v, of_whole);
    product = damped * of_whole + inert * product;
  };
  Eigen::VectorXd guided = inverse.cwiseProduct(left);
  double now_left = left.dot(guided);
  const double enough = solved * solved * now_left;
  SideBySide<1> direction = guided.transpose(), product;
  for (int pass = 0; now_left > enough; ++pass) {
    if (pass == most_passes) throw std::runtime_error("the velocities that an impulse leaves were not found");
    apply(direction, product);
    const double step = now_left / direction.row(0).dot(product.row(0));
    x += step * direction.row(0).transpose();
    left -= step * product.row(0).transpose();
    guided = inverse.cwiseProduct(left);
    const double before_this = std::exchange(now_left, left.dot(guided));
    direction = (guided + now_left / before_this * direction.row(0).transpose()).transpose();
  }
  return x;
}

/// Damping answers a jump of velocities at once: accelerations that did not would make the method create energy in
/// modes that it does not resolve. Implicit, as in velocities_of(): the acceleration itself would throw a mode that is
/// damped within much less than a substep far beyond its place.
void FrameDynamics::State::follow_jump(const Eigen::VectorXd& change) {
  const double a0 = options.damping.mass, a1 = options.damping.stiffness;
  if (a1 > 0) {
    const SideBySide<1> v = change.transpose();
    SideBySide<1> whole, inert;
    multiply<1>(system().matrix(), v, whole);
    multiply<1>(system().mass(), v, inert);
    before.a -= a1 * velocities_of(on_mass((whole.row(0) - method.s * inert.row(0)).transpose()));
  }
  before.a -= a0 * change;
}

std::vector<Vec6> FrameDynamics::velocities_of(std::span<const Impulse> impulses) const {
  State& state = *state_;
  std::vector<Vec6> result(state.frame.model().nodes.size(), Vec6::Zero());
  state.system().node_displacements_of_scaled(state.velocities_of(state.on_mass(state.scaled_impulses(impulses))),
                                              result);
  return result;
}

Eigen::MatrixXd FrameDynamics::mobility(std::span<const std::vector<Impulse>> forces) const {
  State& state = *state_;
  const auto count = static_cast<Eigen::Index>(forces.size());
  Eigen::MatrixXd F(state.equations(), count), on_mass(state.equations(), count);
  for (Eigen::Index j = 0; j < count; ++j) {
    F.col(j) = state.scaled_impulses(forces[static_cast<std::size_t>(j)]);
    on_mass.col(j) = state.on_mass(F.col(j));
  }
  Eigen::MatrixXd result(count, count);
  if (state.damps_jumps())
    result = state.impulse_factor().between(F, on_mass);
  else
    for (Eigen::Index j = 0; j < count; ++j) result.col(j) = F.transpose() * state.velocities_by_mass(on_mass.col(j));
  return (result + result.transpose()) / 2;
}

void FrameDynamics::strike(std::span<const Impulse> impulses) {
  State& state = *state_;
  // What changed comes first; the momentum that it leaves out is an impulse here, and no load of a substep to come.
  state.begin_changed();
  const Eigen::VectorXd own = state.on_mass(state.scaled_impulses(impulses)),
                        of_changes = state.on_mass(state.method.h * state.substep_load +
                                                   state.scaled_impulses(std::exchange(state.impulses, {})));
  state.brought.clear();
  if ((own + of_changes).isZero(0)) return;
  const Eigen::VectorXd change = state.velocities_of(own + of_changes);
  const Eigen::VectorXd mean = state.before.v + change / 2;
  SideBySide<1> inert;
  multiply<1>(state.system().mass(), change.transpose(), inert);
  state.energy.struck += own.dot(mean);
  state.energy.freed -= of_changes.dot(mean);
  state.energy.damped += (own + of_changes - inert.row(0).transpose()).dot(mean);
  state.substep_load.setZero();
  state.before.v += change;
  state.follow_jump(change);
  state.products_known = state.nodes_known = state.end_known = false;
  state.stored_energy();
}

void FrameDynamics::add_impulses(std::span<const Impulse> impulses) {
  State& state = *state_;
  (void)state.scaled_impulses(impulses);  // each has a node
  state.impulses.insert(state.impulses.end(), impulses.begin(), impulses.end());
}

void FrameDynamics::add_momentum(int beam, const Vec6& momentum) {
  (void)checked_beam(model(), beam);
  state_->brought.try_emplace(beam, Vec6::Zero()).first->second += momentum;
}

Vec6 FrameDynamics::State::brought_to(int beam) const {
  const auto found = brought.find(beam);
  return found == brought.end() ? Vec6(Vec6::Zero()) : found->second;
}

Vec6 FrameDynamics::beam_momentum(int beam) const {
  const State& state = *state_;
  const auto i = checked_beam(model(), beam);
  const Beam& own = state.system().model.beams[i];
  const bool hangs = !own.end_stiffness[0].isZero(0) || !own.end_stiffness[1].isZero(0);
  if (state.system().beam_stands[i] != 0 && hangs)
    return state.momentum_of(beam, ends_by_rigid_ends(own), state.current().v) + state.brought_to(beam);
  for (const ChangedBeam& change : state.changed)
    if (change.beam == beam) return state.momentum_left_with(change);
  return Vec6::Zero();
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
