#include "energy_account.h"

#include <Eigen/Geometry>
#include <cmath>

#include "index_of.h"

namespace topple::structure {

EnergyAccount::EnergyAccount(const Sources& sources) : from_(sources), held_(sources.building.joints.size(), 1) {}

void EnergyAccount::start() {
  started_ = true;
  elastic_at_start_ = from_.statics.strain_energy();
  start_ = load_work();
}

Vec3 EnergyAccount::local_gravity(MemberId member) const { return from_.building[member].axes * gravity_; }

Vec6 EnergyAccount::hub_now(MemberId member, int end) const {
  const Member& own = from_.building[member];
  const auto e = static_cast<std::size_t>(end);
  const Vec6& node = from_.statics.displacement(own.nodes[e]);
  Vec6 hub;
  hub << own.axes * (node.head<3>() + node.tail<3>().cross(own.offsets[e])), own.axes * node.tail<3>();
  return hub;
}

MemberShape EnergyAccount::shape_now(MemberId member) const {
  solver::Beam beam = from_.statics.beam(member);
  solver::Vec12 hubs;
  for (int end = 0; end < 2; ++end) {
    const JointId joint = from_.building.joint(member, end);
    beam.end_stiffness[static_cast<std::size_t>(end)] =
        held_[index_of(joint)] ? from_.building[joint].stiffness : Vec6(Vec6::Zero());
    hubs.segment<6>(6 * end) = hub_now(member, end);
  }
  return {beam, from_.statics.end_forces(member), hubs, from_.applied[index_of(member)]};
}

const MemberShape& EnergyAccount::shape_before(MemberId member) {
  const auto found = before_.find(member);
  return found != before_.end() ? found->second : before_.emplace(member, shape_now(member)).first->second;
}

void EnergyAccount::lose_joint(JointId joint, int told) {
  const Joint& own = from_.building[joint];
  Opening opening{joint, told, from_.statics.end_forces(own.member).segment<6>(6 * own.end),
                  hub_now(own.member, own.end)};
  shape_before(own.member);  // while the loads are those of the state before
  openings_.push_back(opening);
}

void EnergyAccount::lose_membrane(PanelId panel) {
  MembraneLoss loss{panel, from_.statics.corner_forces(panel), {}};
  for (std::size_t corner = 0; corner < 4; ++corner)
    loss.displacements[corner] = from_.statics.displacement(from_.building[panel].nodes[corner]);
  membranes_.push_back(loss);
}

void EnergyAccount::lose_support(NodeId node) {
  SupportLoss loss{node, Vec6::Zero(), from_.statics.displacement(node)};
  for (std::size_t s = 0; s < from_.building.supports.size(); ++s)
    if (from_.building.supports[s].node == node) loss.reaction += from_.statics.reaction(s);
  supports_.push_back(loss);
}

void EnergyAccount::drop(NodeId node) {
  // A hub that springs back on its support: nothing else hangs on it any more.
  const Vec6& u = from_.statics.displacement(node);
  for (const NodeSupport& support : from_.building.supports)
    for (int c = 0; c < 6; ++c)
      if (support.node == node && std::isfinite(support.stiffness(c)))
        freed_now_ += 0.5 * support.stiffness(c) * u(c) * u(c);
}

void EnergyAccount::leave(MemberId member) {
  const MemberShape& shape = shape_before(member);
  left_ += shape.work(from_.loads.own(member), local_gravity(member));
  freed_now_ += shape.strain_energy();
}

void EnergyAccount::leave(NodeId node) {
  left_ += work(from_.loads.own(node), from_.statics.displacement(node), gravity_);
  left_.other += from_.loads.event_load(node).dot(from_.statics.displacement(node));
}

void EnergyAccount::add_share(MemberId member, const solver::BeamLoad& load, Shares& shares) {
  const LoadWork done = shape_before(member).work({&load, 1}, local_gravity(member));
  (from_.segments.label(member) >= 0 ? shares.standing : shares.left) += done;
}

void EnergyAccount::add_share(NodeId node, const Vec6& load, Shares& shares) {
  const LoadWork done = work(load, from_.statics.displacement(node), gravity_);
  (from_.segments.label(node) >= 0 ? shares.standing : shares.left) += done;
}

/// A panel that leaves keeps the work that its load has done; one that stays moves to where its new bearings are, and
/// what its lost bearings bore is among the load changes of what stands.
void EnergyAccount::hand_on(PanelId panel) {
  Shares own;
  const HandOver& handed = from_.loads.handed(panel);
  for (const solver::BeamLoad& load : handed.beams) add_share(MemberId(static_cast<std::size_t>(load.beam)), load, own);
  for (const solver::NodeLoad& load : handed.nodes)
    add_share(NodeId(static_cast<std::size_t>(load.node)), load.load, own);
  if (!from_.bearings.stands(panel)) {
    left_ += own.standing;
    left_ += own.left;
    freed_now_ += own.standing.sum();
    return;
  }
  freed_now_ -= own.left.sum();
  for (const auto& [key, placed] : from_.loads.contacts()) {
    if (placed.panel != panel) continue;
    Shares contact;
    for (const auto& [member, load] : placed.members) add_share(member, load, contact);
    for (const auto& [node, load] : placed.nodes) add_share(node, load, contact);
    freed_now_ -= contact.left.sum();
  }
}

void EnergyAccount::drop_contact(const PlacedLoad& placed) {
  Shares shares;
  for (const auto& [member, load] : placed.members) add_share(member, load, shares);
  for (const auto& [node, load] : placed.nodes) add_share(node, load, shares);
  contact_left_ += shares.standing.sum() + shares.left.sum();
  freed_now_ += shares.standing.sum();
}

void EnergyAccount::add_load(NodeId node, const Vec6& load) {
  if (!from_.node_solved[index_of(node)]) return;
  const double present = load.dot(from_.statics.displacement(node));
  left_.other -= present;
  freed_now_ -= present;
}

LoadWork EnergyAccount::load_work() const {
  LoadWork sum;
  for (std::size_t m = 0; m < from_.building.members.size(); ++m) {
    const MemberId member(m);
    if (from_.segments.label(member) < 0) continue;
    const auto loads = from_.loads.own_and_handed(member);
    if (!loads.empty()) sum += shape_now(member).work(loads, local_gravity(member));
  }
  for (std::size_t n = 0; n < from_.building.nodes.size(); ++n) {
    const NodeId node(n);
    if (!from_.node_solved[n]) continue;
    const Vec6& u = from_.statics.displacement(node);
    sum += work(from_.loads.own_and_handed(node), u, gravity_);
    sum.other += from_.loads.event_load(node).dot(u);
  }
  return sum;
}

void EnergyAccount::gravity_turned(const LoadWork& before, const Vec3& gravity) {
  if (gravity.norm() > 0) gravity_ = gravity.normalized();
  const LoadWork now = load_work();
  left_.gravity += before.gravity - now.gravity;
  left_.other += before.other - now.other;
  freed_now_ += before.sum() - now.sum();
}

void EnergyAccount::write(MemberId member) {
  if (!started_) return;
  shape_before(member);
  member_loads_before_.emplace(member, from_.applied[index_of(member)]);
}

void EnergyAccount::write(NodeId node, const Vec6& before) {
  if (!started_) return;
  node_loads_before_.emplace(node, std::pair{before, from_.statics.displacement(node)});
}

Vec6 EnergyAccount::after(NodeId node, const Vec6& before) const {
  return from_.node_solved[index_of(node)] ? from_.statics.displacement(node) : before;
}

/// 1/2 (F1 - F0).(u0 + u1) over what stands.
double EnergyAccount::load_changes() const {
  double sum = 0;
  for (const auto& [member, loads] : member_loads_before_) {
    if (from_.segments.label(member) < 0) continue;
    const Vec3 down = local_gravity(member);
    const MemberShape &before = before_.at(member), now = shape_now(member);
    const auto& loads_now = from_.applied[index_of(member)];
    sum += 0.5 * (before.work(loads_now, down).sum() + now.work(loads_now, down).sum() -
                  before.work(loads, down).sum() - now.work(loads, down).sum());
  }
  for (const auto& [node, state] : node_loads_before_) {
    if (!from_.node_solved[index_of(node)]) continue;
    const auto& [load, displacement] = state;
    sum += 0.5 * (from_.loads.on(node) - load).dot(displacement + from_.statics.displacement(node));
  }
  return sum;
}

/// Work that the joint's force could have done while its gap opened; a side that left stays where it was.
double EnergyAccount::opened(const Opening& opening) const {
  const Joint& own = from_.building[opening.joint];
  const NodeId node = from_.building[own.member].nodes[static_cast<std::size_t>(own.end)];
  const Vec6 end = from_.segments.label(own.member) >= 0 ? shape_now(own.member).end(own.end) : opening.hub;
  const Vec6 hub = from_.node_solved[index_of(node)] ? hub_now(own.member, own.end) : opening.hub;
  return -0.5 * opening.force.dot(end - hub);
}

void EnergyAccount::finish(bool slow, std::vector<JointBreak>& breaks) {
  for (const Opening& opening : openings_) held_[index_of(opening.joint)] = 0;
  const double changes = load_changes();
  if (slow) {
    contact_left_ -= changes;
  } else {
    freed_now_ += changes;
    for (const SupportLoss& loss : supports_)
      freed_now_ -= 0.5 * loss.reaction.dot(after(loss.node, loss.displacement));
    for (const MembraneLoss& loss : membranes_)
      for (std::size_t corner = 0; corner < 4; ++corner)
        freed_now_ +=
            0.5 * loss.forces[corner].dot(after(from_.building[loss.panel].nodes[corner], loss.displacements[corner]));
    int told = 0;
    for (const Opening& opening : openings_) {
      const double energy = opened(opening);
      if (opening.told < 0) {
        freed_now_ += energy;
        continue;
      }
      breaks[static_cast<std::size_t>(opening.told)].energy = energy;
      freed_ += energy;
      ++told;
    }
    for (const Opening& opening : openings_)
      if (opening.told >= 0) breaks[static_cast<std::size_t>(opening.told)].energy += freed_now_ / told;
    freed_ += freed_now_;
  }
  before_.clear();
  openings_.clear();
  supports_.clear();
  membranes_.clear();
  member_loads_before_.clear();
  node_loads_before_.clear();
  freed_now_ = 0;
}

double EnergyAccount::contact_work() const {
  double sum = 0;
  for (const auto& [key, placed] : from_.loads.contacts()) {
    for (const auto& [member, load] : placed.members)
      sum += shape_now(member).work({&load, 1}, local_gravity(member)).sum();
    for (const auto& [node, load] : placed.nodes) sum += load.dot(from_.statics.displacement(node));
  }
  return sum;
}

FrameEnergy EnergyAccount::energy() const {
  const LoadWork now = load_work();
  FrameEnergy energy;
  energy.elastic = from_.statics.strain_energy();
  energy.elastic_at_start = elastic_at_start_;
  energy.gravity_work = now.gravity + left_.gravity - start_.gravity;
  energy.other_work = now.other + left_.other - start_.other;
  energy.contact_work = contact_work() + contact_left_;
  energy.freed = freed_;
  return energy;
}

}  // namespace topple::structure
