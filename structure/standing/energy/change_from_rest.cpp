#include "standing/energy/change_from_rest.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/index_of.h"

namespace topple::structure {

const SolvedMember& ChangeFromRest::shape_at_rest(MemberId member) {
  if (const auto found = shapes_.find(member); found != shapes_.end()) return found->second;
  return shapes_.emplace(member, rest_.shape(member)).first->second;
}

/// A change of stiffness is told before it is made, so that the first one finds the stiffness that the panel had at
/// rest.
PanelAtRest& ChangeFromRest::at_rest(PanelId panel) {
  if (const auto found = panels_.find(panel); found != panels_.end()) return found->second;
  return panels_.emplace(panel, rest_.panel(panel)).first->second;
}

void ChangeFromRest::lose_joint(JointId joint, int line) {
  const Joint& own = now_.building[joint];
  openings_.push_back(
      {joint, line, rest_.end_forces(own.member).segment<6>(6 * own.end),
       shape_at_rest(own.member).rigid_end(own.end) + rest_.plastic_rotations(own.member).segment<6>(6 * own.end)});
}

void ChangeFromRest::lose_membrane(PanelId panel) { membranes_.push_back({panel, at_rest(panel).forces}); }

void ChangeFromRest::soften(PanelId panel, const Eigen::MatrixXd& lost) {
  const std::vector<NodeId> nodes = now_.building[panel].all_nodes();
  Eigen::VectorXd displacements(lost.rows());
  for (std::size_t n = 0; n < nodes.size(); ++n)
    displacements.segment<6>(static_cast<Eigen::Index>(6 * n)) = rest_.displacement(nodes[n]);
  const Eigen::VectorXd force = lost * displacements;
  std::vector<Vec6> forces(nodes.size());
  for (std::size_t n = 0; n < nodes.size(); ++n) forces[n] = force.segment<6>(static_cast<Eigen::Index>(6 * n));
  // What is lost later, in the same change, is what is left of it now.
  PanelAtRest& whole = at_rest(panel);
  for (std::size_t n = 0; n < nodes.size(); ++n) whole.forces[n] -= forces[n];
  membranes_.push_back({panel, std::move(forces)});
}

void ChangeFromRest::soften(MemberId member) {
  shape_at_rest(member);
  softened_.push_back(member);
}

void ChangeFromRest::drop(NodeId node) {
  for (const NodeSupport& support : now_.building.supports)
    for (int c = 0; c < 6; ++c)
      if (support.node == node && std::isfinite(support.stiffness(c)))
        sums_.freed += 0.5 * support.stiffness(c) * std::pow(rest_.displacement(node)(c), 2);
}

void ChangeFromRest::leave(MemberId member) {
  const SolvedMember& shape = shape_at_rest(member);
  sums_.left += shape.work(now_.loads.own(member), now_.local_gravity(member));
  sums_.freed += shape.strain_energy();
}

void ChangeFromRest::leave(NodeId node) {
  sums_.left += work(now_.loads.own(node), rest_.displacement(node), now_.gravity);
  sums_.left.other += now_.loads.event_load(node).dot(rest_.displacement(node));
  // One that came in this change leaves before it has moved: load_changes(), which that corrects, leaves it out.
  if (const auto came = came_.find(node); came != came_.end()) sums_.freed += std::exchange(came->second, 0);
}

/// The part that left keeps the work that its load has done, as a panel that leaves does (settle_panels).
void ChangeFromRest::lighten(PanelId panel, const TributaryLoads& before, const TributaryLoads& after) {
  const Shares with = shares(before), without = shares(after);
  sums_.left += with.standing;
  sums_.left += LoadWork{-without.standing.gravity, -without.standing.other};
  sums_.freed += with.standing.sum() - without.standing.sum();
  // What goes another way later, in the same change, is only what is left.
  if (const auto handed = handed_.find(panel); handed != handed_.end()) handed->second = after;
}

void ChangeFromRest::add_load(NodeId node, const Vec6& load) {
  const double present = load.dot(rest_.displacement(node));
  sums_.left.other -= present;
  sums_.freed -= present;
  came_.try_emplace(node, 0).first->second += present;
}

void ChangeFromRest::turn_gravity(const LoadWork& before, const LoadWork& now) {
  sums_.left.gravity += before.gravity - now.gravity;
  sums_.left.other += before.other - now.other;
  sums_.freed += before.sum() - now.sum();
}

void ChangeFromRest::write(MemberId member) {
  shape_at_rest(member);
  member_loads_.emplace(member, rest_.loads(member));
}

void ChangeFromRest::forget_lines() {
  for (Opening& opening : openings_) opening.line = -1;
}

void ChangeFromRest::add_share(MemberId member, const solver::BeamLoad& load, Shares& shares) {
  const LoadWork done = shape_at_rest(member).work({&load, 1}, now_.local_gravity(member));
  (now_.stands(member) ? shares.standing : shares.left) += done;
}

void ChangeFromRest::add_share(NodeId node, const Vec6& load, Shares& shares) const {
  const LoadWork done = work(load, rest_.displacement(node), now_.gravity);
  (now_.stands(node) ? shares.standing : shares.left) += done;
}

ChangeFromRest::Shares ChangeFromRest::shares(const TributaryLoads& handed) {
  Shares sum;
  for (const solver::BeamLoad& load : handed.beams) add_share(MemberId(static_cast<std::size_t>(load.beam)), load, sum);
  for (const solver::NodeLoad& load : handed.nodes)
    add_share(NodeId(static_cast<std::size_t>(load.node)), load.load, sum);
  return sum;
}

ChangeFromRest::Shares ChangeFromRest::shares(const PlacedLoad& placed) {
  Shares sum;
  for (const auto& [member, load] : placed.members) add_share(member, load, sum);
  for (const auto& [node, load] : placed.nodes) add_share(node, load, sum);
  return sum;
}

/// A panel that leaves keeps the work that its load has done. So does one that stays, where its lost bearings bore it:
/// its load comes to the others as they are bent now, and does not rise because they have sunk less.
void ChangeFromRest::settle_panels() {
  for (const auto& [panel, handed] : handed_) {
    const Shares own = shares(handed);
    sums_.left += own.standing;
    sums_.left += own.left;
    sums_.freed += own.standing.sum();
    if (!now_.stands(panel)) continue;
    const LoadWork now = shares(now_.loads.handed(panel)).standing;
    sums_.left += LoadWork{-now.gravity, -now.other};
    sums_.freed -= now.sum();
  }
}

/// The same for contact loads: those of parts that left are gone, with the work that they have done. What comes, goes
/// or changes in a sudden change does so at the displacements that were there, without doing work.
void ChangeFromRest::settle_contacts(int component) {
  const auto& contacts = now_.loads.contacts();
  const auto unchanged = [&](std::int64_t key, const PlacedLoad& placed, const auto& others) {
    const auto other = others.find(key);
    return other != others.end() && same_load(other->second, placed) && now_.stands(placed);
  };
  for (const auto& [key, placed] : rest_.contacts()) {
    if (now_.component(placed) != component || unchanged(key, placed, contacts)) continue;
    const Shares own = shares(placed);
    sums_.contact_left += own.standing.sum() + own.left.sum();
    sums_.freed += own.standing.sum();
  }
  for (const auto& [key, placed] : contacts) {
    if (now_.component(placed) != component || unchanged(key, placed, rest_.contacts())) continue;
    const double own = shares(placed).standing.sum();
    sums_.contact_left -= own;
    sums_.freed -= own;
  }
}

Vec6 ChangeFromRest::after(NodeId node) const {
  return now_.solved(node) ? now_.statics.displacement(node) : rest_.displacement(node);
}

/// 1/2 (F1 - F0).(u0 + u1) over what stands.
double ChangeFromRest::load_changes() const {
  double sum = 0;
  for (const auto& [member, loads] : member_loads_) {
    if (!now_.stands(member)) continue;
    const Vec3 down = now_.local_gravity(member);
    const SolvedMember &before = shapes_.at(member), now = now_.shape(member);
    const auto& loads_now = now_.applied[index_of(member)];
    sum += 0.5 * (before.work(loads_now, down).sum() + now.work(loads_now, down).sum() -
                  before.work(loads, down).sum() - now.work(loads, down).sum());
  }
  for (const auto& [node, load] : node_loads_)
    if (now_.solved(node))
      sum += 0.5 * (now_.loads.on(node) - load).dot(rest_.displacement(node) + now_.statics.displacement(node));
  return sum;
}

/// 1/2 (1/k1 - 1/k0) s0.s1 over what became softer, s the internal forces before and after.
double ChangeFromRest::softening() const {
  double sum = 0;
  std::vector<MemberId> members = softened_;
  std::sort(members.begin(), members.end());
  members.erase(std::unique(members.begin(), members.end()), members.end());
  for (MemberId member : members) {
    if (!now_.stands(member)) continue;
    const double softer = rest_.stiffness(member) / now_.statics.stiffness(member);
    sum += (softer - 1) * shapes_.at(member).mutual_energy(now_.shape(member));
  }
  return sum;
}

/// 1/2 (M0 + M1).(rotation1 - rotation0) over the joints that hold: elastic deformation is what plastic rotations leave
/// of the whole.
double ChangeFromRest::yielding(int component) const {
  double sum = 0;
  for (MemberId member : now_.statics.members(component)) {
    if (!now_.stands(member)) continue;
    const solver::Vec12 turned = now_.statics.plastic_rotations(member) - rest_.plastic_rotations(member);
    if (turned.isZero(0)) continue;
    for (int end = 0; end < 2; ++end)
      if (now_.segments.holds(now_.building.joint(member, end)))
        sum += 0.5 * turned.segment<6>(6 * end).dot(rest_.end_forces(member).segment<6>(6 * end) +
                                                    now_.statics.end_forces(member).segment<6>(6 * end));
  }
  return sum;
}

/// Work that the joint's force could have done while its gap opened; a side that left stays where it was.
double ChangeFromRest::opened(const Opening& opening) const {
  const Joint& own = now_.building[opening.joint];
  const NodeId node = now_.building[own.member].nodes[static_cast<std::size_t>(own.end)];
  const Vec6 turned = rest_.plastic_rotations(own.member).segment<6>(6 * own.end);
  const Vec6 end = now_.stands(own.member) ? now_.shape(own.member).end(own.end) : Vec6(opening.rigid_end - turned);
  const Vec6 rigid_end =
      now_.solved(node) ? Vec6(now_.rigid_ends(own.member).segment<6>(6 * own.end)) : opening.rigid_end;
  return -0.5 * opening.force.dot(end - rigid_end + turned);
}

void ChangeFromRest::settle_losses() {
  for (const SupportLoss& loss : supports_) sums_.freed -= 0.5 * loss.reaction.dot(after(loss.node));
  for (const MembraneLoss& loss : membranes_) {
    const std::vector<NodeId> nodes = now_.building[loss.panel].all_nodes();
    for (std::size_t n = 0; n < nodes.size(); ++n) sums_.freed += 0.5 * loss.forces[n].dot(after(nodes[n]));
  }
}

void ChangeFromRest::settle_openings(std::vector<JointBreak>& breaks) {
  int told = 0;
  double own = 0;
  for (const Opening& opening : openings_) {
    const double energy = opened(opening);
    if (opening.line < 0) {
      sums_.freed += energy;
      continue;
    }
    breaks[static_cast<std::size_t>(opening.line)].energy = energy;
    own += energy;
    ++told;
  }
  for (const Opening& opening : openings_)
    if (opening.line >= 0) breaks[static_cast<std::size_t>(opening.line)].energy += sums_.freed / told;
  sums_.freed += own;
}

ChangeFromRest::Sums ChangeFromRest::finish(int component, bool slow, std::vector<JointBreak>& breaks) {
  const double loads_changed = load_changes();
  sums_.freed += softening();
  if (slow) {
    sums_.contact_left -= loads_changed;
  } else {
    settle_panels();
    settle_contacts(component);
    sums_.freed += loads_changed + yielding(component) - sums_.dissipated;
    settle_losses();
    settle_openings(breaks);
  }
  return sums_;
}

void ChangeFromRest::commit_to(StateOfRest& rest) const {
  for (const Opening& opening : openings_) rest.lose_joint(opening.joint);
  for (const auto& [member, loads] : member_loads_) rest.record_loads(member);
  for (const auto& [node, load] : node_loads_) rest.record_loads(node);
}

}  // namespace topple::structure
