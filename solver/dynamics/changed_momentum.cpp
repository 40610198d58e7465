#include "dynamics/changed_momentum.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "dynamics/rigid_ends.h"
#include "elements/beam_mass.h"

namespace topple::solver {
namespace {

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

/// In this time.
Vec12 impulse_of(const std::vector<BeamLoad>& loads, double time) {
  Vec12 impulse = Vec12::Zero();
  for (const BeamLoad& load : loads) impulse.head<6>() += time * resultant(load);
  return impulse;
}

/// Momentum of a beam that its nodes' velocities leave out now (local node impulses), since its ends followed them
/// otherwise.
Vec12 missing_momentum(const FrameSystem& system, const MassModel& masses, int beam, const Mat12& followed,
                       const Eigen::VectorXd& velocities) {
  const auto i = static_cast<std::size_t>(beam);
  if (system.beam_stands[i] == 0) return Vec12::Zero();
  const Mat12 follows = ends_by_rigid_ends(system.model.beams[i]);
  const Mat12 M = mass_of_beam(system, masses, beam);
  const Vec12 rigid_ends = rigid_end_motion(system, beam, velocities);
  return follows.transpose() * M * (followed - follows) * rigid_ends;
}

}  // namespace

void ChangedMomentum::forget_part() {
  broken_.clear();
  changed_.clear();
  fixed_end_.clear();
}

void ChangedMomentum::begin_substep() {
  forget_part();
  left_.clear();
}

void ChangedMomentum::begin_part(const FrameSystem& system, const RequestedChanges& changes, double h, int left) {
  for (const ChangedBeam& one : changed_) {
    if (left_.contains(one.beam) || is_held(system, one.beam)) continue;
    const std::vector<BeamLoad>& loads = changes.beam(static_cast<std::size_t>(one.beam)).loads;
    const double later = h * static_cast<double>(left);
    Left gone = *left_with(system, one.beam, loads, h);
    gone.momentum += about_origin(system, one.beam, impulse_of(loads, later));
    gone.ends += later * one.end_rates;
    left_.emplace(one.beam, gone);
  }
  forget_part();
}

void ChangedMomentum::remember(const FrameSystem& system, const SystemInertia& inertia, const RequestedChanges& changes,
                               const MotionState& motion) {
  for (const int beam : changes.beams()) {
    const auto i = static_cast<std::size_t>(beam);
    const Beam& now_is = system.model.beams[i];
    if (now_is.density == 0 || system.beam_stands[i] == 0 || now_is.end_stiffness == changes.beam(i).end_stiffness)
      continue;
    const bool known = std::any_of(changed_.begin(), changed_.end(), [&](const auto& c) { return c.beam == beam; });
    if (known) continue;
    const Mat12 follows = ends_by_rigid_ends(now_is);
    changed_.push_back(
        {beam, follows, momentum_of_beam(system, inertia.masses, beam, follows, motion.v) + brought_to(beam),
         own_end_motion(system, beam, follows, motion.u), own_end_motion(system, beam, follows, motion.v)});
  }
}

void ChangedMomentum::break_joint(int beam, std::size_t end, const Vec6& mean_force) {
  broken_.push_back({beam, end, mean_force});
}

void ChangedMomentum::bring(int beam, const Vec6& momentum) {
  brought_.try_emplace(beam, Vec6::Zero()).first->second += momentum;
}

Vec6 ChangedMomentum::brought_to(int beam) const {
  const auto found = brought_.find(beam);
  return found == brought_.end() ? Vec6(Vec6::Zero()) : found->second;
}

Vec12 ChangedMomentum::fixed_end(int beam) const {
  const auto found = fixed_end_.find(beam);
  return found == fixed_end_.end() ? Vec12(Vec12::Zero()) : found->second;
}

/// Its joints' forces until they broke pushed it the other way, and its loads went on.
auto ChangedMomentum::left_with(const FrameSystem& system, int beam, const std::vector<BeamLoad>& loads, double h) const
    -> std::optional<Left> {
  if (const auto before = left_.find(beam); before != left_.end()) return before->second;
  const auto gone = std::find_if(changed_.begin(), changed_.end(), [&](const auto& c) { return c.beam == beam; });
  if (gone == changed_.end()) return std::nullopt;
  Vec12 impulse = impulse_of(loads, h);
  for (const BrokenJoint& joint : broken_)
    if (joint.beam == beam) impulse.segment<6>(static_cast<Eigen::Index>(6 * joint.end)) += h * joint.mean_force;
  return Left{gone->momentum + about_origin(system, beam, impulse), gone->ends + h * gone->end_rates};
}

/// Momentum that came to beams, on the ends that hold them.
void ChangedMomentum::add_brought(const FrameSystem& system, Eigen::VectorXd& impulse) const {
  for (const auto& [beam, momentum] : brought_) {
    const Beam& own = system.model.beams[static_cast<std::size_t>(beam)];
    std::vector<int> held;
    for (std::size_t end = 0; end < 2; ++end)
      if (!own.end_stiffness[end].isZero(0) && system.node_stands[static_cast<std::size_t>(own.node[end])] != 0)
        held.push_back(own.node[end]);
    if (held.empty()) continue;  // it left
    const Vec6 share = momentum / static_cast<double>(held.size());
    const Vec3 linear = share.head<3>();
    Vec3 turning = share.tail<3>();
    for (const int node : held)
      turning -= system.model.nodes[static_cast<std::size_t>(node)].cross(linear) / static_cast<double>(held.size());
    for (const int node : held) {
      Vec6 on_node;
      on_node << linear, turning;
      system.dofs().add_node_force(node, on_node, impulse.data());
    }
  }
}

/// Forces of joints until they broke act on the node and on the beam's own end, which hands it to its other node.
Eigen::VectorXd ChangedMomentum::load(const FrameSystem& system) {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(system.dofs().equations + system.dofs().held);
  fixed_end_.clear();
  for (const BrokenJoint& joint : broken_) {
    const Beam& beam = system.model.beams[static_cast<std::size_t>(joint.beam)];
    Vec12 on_rigid_end = Vec12::Zero();
    on_rigid_end.segment<6>(static_cast<Eigen::Index>(6 * joint.end)) = -joint.mean_force;
    add_on_rigid_ends(system, joint.beam, on_rigid_end, force);
    BeamLoad at_end;
    at_end.beam = joint.beam;
    at_end.kind = BeamLoad::Kind::point;
    at_end.from = joint.end == 0 ? 0 : beam.length;
    at_end.first = joint.mean_force;
    if (system.beam_stands[static_cast<std::size_t>(joint.beam)] == 0) continue;
    const Vec12 fixed = system.fixed_end_forces(joint.beam, {&at_end, 1}).force;
    add_on_rigid_ends(system, joint.beam, -fixed, force);
    fixed_end_.try_emplace(joint.beam, Vec12::Zero()).first->second += fixed;
  }
  return force;
}

Eigen::VectorXd ChangedMomentum::impulses(const FrameSystem& system, const SystemInertia& inertia,
                                          const Eigen::VectorXd& velocities) const {
  Eigen::VectorXd impulse = Eigen::VectorXd::Zero(system.dofs().equations + system.dofs().held);
  for (const ChangedBeam& change : changed_)
    add_on_rigid_ends(system, change.beam,
                      missing_momentum(system, inertia.masses, change.beam, change.followed, velocities), impulse);
  add_brought(system, impulse);
  return impulse;
}

void ChangedMomentum::forget_impulses(const FrameSystem& system) {
  brought_.clear();
  std::erase_if(changed_, [&](const ChangedBeam& change) { return is_held(system, change.beam); });
}

}  // namespace topple::solver
