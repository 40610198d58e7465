#include "standing/energy_account.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "model/index_of.h"

namespace topple::structure {

EnergyAccount::EnergyAccount(const Sources& sources)
    : from_(sources),
      rest_displacement_(sources.building.nodes.size(), Vec6::Zero()),
      rest_end_forces_(sources.building.members.size(), solver::Vec12::Zero()),
      rest_loads_(sources.building.members.size()),
      rest_own_(sources.building.members.size(), 0),
      rest_node_loads_(sources.building.nodes.size(), Vec6::Zero()),
      rest_event_loads_(sources.building.nodes.size(), Vec6::Zero()),
      rest_member_stands_(sources.building.members.size(), 0),
      rest_node_stands_(sources.building.nodes.size(), 0),
      rest_springs_(static_cast<std::size_t>(sources.statics.components())),
      rest_holds_(sources.building.joints.size(), 1),
      rest_stiffness_(sources.building.members.size(), 1.0),
      rests_(static_cast<std::size_t>(sources.statics.components())),
      changes_(rests_.size()) {}

void EnergyAccount::start() {
  started_ = true;
  for (int c = 0; c < from_.statics.components(); ++c) {
    for (MemberId member : from_.statics.members(c)) remember_loads(member);
    for (NodeId node : from_.statics.nodes(c)) remember_loads(node);
    remember(c);
    elastic_at_start_ += rest(c).elastic;
    start_ += rest(c).work;
  }
}

/// The component's state as solved is the one in which it rests. Loads are written down where they change.
void EnergyAccount::remember(int number) {
  for (NodeId node : from_.statics.nodes(number)) {
    rest_node_stands_[index(node)] = from_.node_solved[index(node)];
    if (from_.node_solved[index(node)]) rest_displacement_[index(node)] = from_.statics.displacement(node);
  }
  for (MemberId member : from_.statics.members(number)) {
    const bool stands = from_.segments.label(member) >= 0;
    rest_member_stands_[index(member)] = stands;
    if (!stands) continue;
    rest_end_forces_[index(member)] = from_.statics.end_forces(member);
    if (const solver::Vec12 plastic_rotations = from_.statics.plastic_rotations(member); !plastic_rotations.isZero(0))
      rest_plastic_rotations_[member] = plastic_rotations;
    else
      rest_plastic_rotations_.erase(member);
    rest_stiffness_[index(member)] = from_.statics.stiffness(member);
  }
  std::vector<Spring>& springs = rest_springs_[static_cast<std::size_t>(number)];
  springs.clear();
  for (const solver::Support& support : from_.statics.supports(number))
    if ((support.stiffness.array() > 0 && support.stiffness.array() < unlimited).any())
      springs.push_back({from_.statics.nodes(number)[static_cast<std::size_t>(support.node)], support.stiffness});
  rests_[static_cast<std::size_t>(number)].known = false;
  remember_contacts(number);
}

void EnergyAccount::remember_loads(MemberId member) {
  rest_loads_[index(member)] = from_.applied[index(member)];
  rest_own_[index(member)] = from_.loads.own_and_handed(member).size();
}

void EnergyAccount::remember_loads(NodeId node) {
  rest_node_loads_[index(node)] = from_.loads.own_and_handed(node);
  rest_event_loads_[index(node)] = from_.loads.event_load(node);
}

void EnergyAccount::remember_contacts(int number) {
  const auto& contacts = from_.loads.contacts();
  std::erase_if(rest_contacts_, [&](const auto& contact) {
    return component(contact.second) == number && !contacts.contains(contact.first);
  });
  for (const auto& [key, placed] : contacts) {
    if (component(placed) != number) continue;
    const auto [at_rest, made] = rest_contacts_.try_emplace(key, placed);
    if (!made && !same_load(at_rest->second, placed)) at_rest->second = placed;
  }
}

const EnergyAccount::Rest& EnergyAccount::rest(int component) const {
  Rest& sums = rests_[static_cast<std::size_t>(component)];
  if (!sums.known) sums = {true, rest_load_work(component), rest_contact_work(component), rest_elastic(component)};
  return sums;
}

EnergyAccount::Change& EnergyAccount::begin(int component) {
  Change& change = changes_[static_cast<std::size_t>(component)];
  change.open = true;
  return change;
}

Vec3 EnergyAccount::local_gravity(MemberId member) const { return from_.building[member].axes * gravity_; }

solver::Vec12 EnergyAccount::rigid_ends(MemberId member, const Vec6& first, const Vec6& second) const {
  const Member& own = from_.building[member];
  solver::Vec12 local;
  local << own.axes * (first.head<3>() + first.tail<3>().cross(own.offsets[0])), own.axes * first.tail<3>(),
      own.axes * (second.head<3>() + second.tail<3>().cross(own.offsets[1])), own.axes * second.tail<3>();
  return local;
}

Vec6 EnergyAccount::rigid_end_now(MemberId member, int end) const {
  const auto& nodes = from_.building[member].nodes;
  return rigid_ends(member, from_.statics.displacement(nodes[0]), from_.statics.displacement(nodes[1]))
      .segment<6>(6 * end);
}

MemberShape EnergyAccount::shape_now(MemberId member) const {
  const auto& nodes = from_.building[member].nodes;
  return {from_.statics.beam(member), from_.statics.end_forces(member),
          rigid_ends(member, from_.statics.displacement(nodes[0]), from_.statics.displacement(nodes[1])) -
              from_.statics.plastic_rotations(member),
          from_.applied[index(member)]};
}

const MemberShape& EnergyAccount::shape_at_rest(MemberId member) {
  auto& shapes = begin(member).before;
  if (const auto found = shapes.find(member); found != shapes.end()) return found->second;
  return shapes.emplace(member, rest_shape(member)).first->second;
}

MemberShape EnergyAccount::rest_shape(MemberId member) const {
  solver::Beam beam = from_.statics.beam(member);
  const double stiffer = rest_stiffness_[index(member)] / from_.statics.stiffness(member);
  beam.youngs_modulus *= stiffer;
  beam.shear_modulus *= stiffer;
  for (int end = 0; end < 2; ++end) {
    const JointId joint = from_.building.joint(member, end);
    beam.end_stiffness[static_cast<std::size_t>(end)] =
        rest_holds_[index(joint)] ? from_.building[joint].stiffness : Vec6(Vec6::Zero());
  }
  const auto& nodes = from_.building[member].nodes;
  const solver::Vec12 at =
      rigid_ends(member, displacement(nodes[0]), displacement(nodes[1])) - rest_plastic_rotations(member);
  return {beam, rest_end_forces_[index(member)], at, rest_loads_[index(member)]};
}

/// FrameLoads::on() has the contacts last.
std::span<const solver::BeamLoad> EnergyAccount::rest_own_loads(MemberId member) const {
  return std::span(rest_loads_[index(member)]).first(rest_own_[index(member)]);
}

/// A change of stiffness is told before it is made, so that the first one finds the stiffness that the panel had at
/// rest.
EnergyAccount::Plate& EnergyAccount::plate_at_rest(PanelId panel) {
  auto& plates = begin(from_.building[panel].nodes[0]).plates;
  if (const auto found = plates.find(panel); found != plates.end()) return found->second;
  return plates.emplace(panel, rest_plate(panel)).first->second;
}

EnergyAccount::Plate EnergyAccount::rest_plate(PanelId panel) const {
  const std::vector<NodeId> nodes = from_.building[panel].all_nodes();
  std::vector<Vec6> at_rest;
  for (NodeId node : nodes) at_rest.push_back(displacement(node));
  Plate plate;
  plate.forces = from_.statics.node_forces(panel, at_rest);
  for (std::size_t n = 0; n < nodes.size(); ++n) plate.energy += 0.5 * plate.forces[n].dot(at_rest[n]);
  return plate;
}

void EnergyAccount::lose_joint(JointId joint, int told) {
  const Joint& own = from_.building[joint];
  const MemberShape& shape = shape_at_rest(own.member);
  begin(own.member)
      .openings.push_back({joint, told, rest_end_forces_[index(own.member)].segment<6>(6 * own.end),
                           shape.rigid_end(own.end) + rest_plastic_rotations(own.member).segment<6>(6 * own.end)});
}

void EnergyAccount::dissipate(MemberId member, double work) { begin(member).dissipated += work; }

solver::Vec12 EnergyAccount::rest_plastic_rotations(MemberId member) const {
  const auto found = rest_plastic_rotations_.find(member);
  return found == rest_plastic_rotations_.end() ? solver::Vec12::Zero() : found->second;
}

/// 1/2 (M0 + M1).(rotation1 - rotation0) over the joints that hold: elastic deformation is what plastic rotations leave
/// of the whole.
double EnergyAccount::turned(int component) const {
  double sum = 0;
  for (MemberId member : from_.statics.members(component)) {
    if (from_.segments.label(member) < 0) continue;
    const solver::Vec12 slipped = from_.statics.plastic_rotations(member) - rest_plastic_rotations(member);
    if (slipped.isZero(0)) continue;
    for (int end = 0; end < 2; ++end)
      if (from_.segments.holds(from_.building.joint(member, end)))
        sum += 0.5 * slipped.segment<6>(6 * end).dot(rest_end_forces_[index(member)].segment<6>(6 * end) +
                                                     from_.statics.end_forces(member).segment<6>(6 * end));
  }
  return sum;
}

void EnergyAccount::lose_membrane(PanelId panel) {
  const Plate& plate = plate_at_rest(panel);
  begin(from_.building[panel].nodes[0]).membranes.push_back({panel, plate.forces});
}

void EnergyAccount::soften(PanelId panel, const Eigen::MatrixXd& lost) {
  const std::vector<NodeId> nodes = from_.building[panel].all_nodes();
  Eigen::VectorXd at_rest(lost.rows());
  for (std::size_t n = 0; n < nodes.size(); ++n)
    at_rest.segment<6>(static_cast<Eigen::Index>(6 * n)) = displacement(nodes[n]);
  const Eigen::VectorXd force = lost * at_rest;
  std::vector<Vec6> forces(nodes.size());
  for (std::size_t n = 0; n < nodes.size(); ++n) forces[n] = force.segment<6>(static_cast<Eigen::Index>(6 * n));
  // What is lost later, in the same change, is what is left of it now.
  Plate& plate = plate_at_rest(panel);
  for (std::size_t n = 0; n < nodes.size(); ++n) plate.forces[n] -= forces[n];
  begin(nodes[0]).membranes.push_back({panel, std::move(forces)});
}

void EnergyAccount::soften(MemberId member) {
  shape_at_rest(member);
  begin(member).softened.push_back(member);
}

void EnergyAccount::lose_support(NodeId node, const Vec6& reaction) {
  begin(node).supports.push_back({node, reaction});
}

void EnergyAccount::drop(NodeId node) {
  // A rigid end that springs back on its support: nothing else hangs on it any more.
  Change& change = begin(node);
  for (const NodeSupport& support : from_.building.supports)
    for (int c = 0; c < 6; ++c)
      if (support.node == node && std::isfinite(support.stiffness(c)))
        change.freed += 0.5 * support.stiffness(c) * std::pow(displacement(node)(c), 2);
}

void EnergyAccount::leave(MemberId member) {
  const MemberShape& shape = shape_at_rest(member);
  Change& change = begin(member);
  change.left += shape.work(from_.loads.own(member), local_gravity(member));
  change.freed += shape.strain_energy();
}

void EnergyAccount::leave(NodeId node) {
  Change& change = begin(node);
  change.left += work(from_.loads.own(node), displacement(node), gravity_);
  change.left.other += from_.loads.event_load(node).dot(displacement(node));
}

void EnergyAccount::add_share(MemberId member, const solver::BeamLoad& load, Shares& shares) {
  const LoadWork done = shape_at_rest(member).work({&load, 1}, local_gravity(member));
  (from_.segments.label(member) >= 0 ? shares.standing : shares.left) += done;
}

void EnergyAccount::add_share(NodeId node, const Vec6& load, Shares& shares) {
  const LoadWork done = work(load, displacement(node), gravity_);
  (from_.segments.label(node) >= 0 ? shares.standing : shares.left) += done;
}

void EnergyAccount::hand_on(PanelId panel) {
  // What counts is how it was at rest, however often it changes on the way.
  begin(from_.building[panel].nodes[0]).handed.emplace(panel, from_.loads.handed(panel));
}

EnergyAccount::Shares EnergyAccount::shares(const TributaryLoads& handed) {
  Shares sum;
  for (const solver::BeamLoad& load : handed.beams) add_share(MemberId(static_cast<std::size_t>(load.beam)), load, sum);
  for (const solver::NodeLoad& load : handed.nodes)
    add_share(NodeId(static_cast<std::size_t>(load.node)), load.load, sum);
  return sum;
}

/// The part that left keeps the work that its load has done, as a panel that leaves does (settle_panels).
void EnergyAccount::lightened(PanelId panel, const TributaryLoads& before, const TributaryLoads& after) {
  Change& change = begin(from_.building[panel].nodes[0]);
  const Shares with = shares(before), without = shares(after);
  change.left += with.standing;
  change.left += LoadWork{-without.standing.gravity, -without.standing.other};
  change.freed += with.standing.sum() - without.standing.sum();
  // What goes another way later, in the same change, is only what is left.
  if (const auto at_rest = change.handed.find(panel); at_rest != change.handed.end()) at_rest->second = after;
}

/// A panel that leaves keeps the work that its load has done. So does one that stays, where its lost bearings bore it:
/// its load comes to the others as they are bent now, and does not rise because they have sunk less.
void EnergyAccount::settle_panels(Change& change) {
  for (const auto& [panel, handed] : change.handed) {
    const Shares own = shares(handed);
    change.left += own.standing;
    change.left += own.left;
    change.freed += own.standing.sum();
    if (!(from_.bearings.serves(panel) ? from_.bearings.stands(panel) : from_.segments.label(panel) >= 0)) continue;
    const LoadWork now = shares(from_.loads.handed(panel)).standing;
    change.left += LoadWork{-now.gravity, -now.other};
    change.freed -= now.sum();
  }
}

int EnergyAccount::component(const PlacedLoad& placed) const {
  if (placed.panel.valid()) return from_.statics.component(from_.building[placed.panel].nodes[0]);
  if (placed.members.empty()) return from_.statics.component(placed.nodes.front().first);
  return from_.statics.component(placed.members.front().first);
}

/// All that bears it stands.
bool EnergyAccount::stays(const PlacedLoad& placed) const {
  const auto stands = [&](const auto& bearing) { return from_.segments.label(bearing.first) >= 0; };
  return std::all_of(placed.members.begin(), placed.members.end(), stands) &&
         std::all_of(placed.nodes.begin(), placed.nodes.end(), stands);
}

EnergyAccount::Shares EnergyAccount::shares(const PlacedLoad& placed) {
  Shares sum;
  for (const auto& [member, load] : placed.members) add_share(member, load, sum);
  for (const auto& [node, load] : placed.nodes) add_share(node, load, sum);
  return sum;
}

/// The same for contact loads: those of parts that left are gone, with the work that they have done. What comes, goes
/// or changes in a sudden change does so at the displacements that were there, without doing work.
void EnergyAccount::settle_contacts(int number, Change& change) {
  const auto& contacts = from_.loads.contacts();
  const auto unchanged = [&](std::int64_t key, const PlacedLoad& placed, const auto& others) {
    const auto other = others.find(key);
    return other != others.end() && same_load(other->second, placed) && stays(placed);
  };
  for (const auto& [key, placed] : rest_contacts_) {
    if (component(placed) != number || unchanged(key, placed, contacts)) continue;
    const Shares own = shares(placed);
    change.contact_left += own.standing.sum() + own.left.sum();
    change.freed += own.standing.sum();
  }
  for (const auto& [key, placed] : contacts) {
    if (component(placed) != number || unchanged(key, placed, rest_contacts_)) continue;
    const double own = shares(placed).standing.sum();
    change.contact_left -= own;
    change.freed -= own;
  }
}

void EnergyAccount::add_load(NodeId node, const Vec6& load) {
  if (!from_.node_solved[index(node)]) return;
  Change& change = begin(node);
  const double present = load.dot(displacement(node));
  change.left.other -= present;
  change.freed -= present;
}

void EnergyAccount::turn_gravity() {
  for (int c = 0; c < from_.statics.components(); ++c) {
    (void)rest(c);  // by the direction that gravity has had so far
    begin(c);
  }
}

void EnergyAccount::gravity_turned(const Vec3& gravity) {
  if (gravity.norm() > 0) gravity_ = gravity.normalized();
  for (int c = 0; c < from_.statics.components(); ++c) {
    Change& change = begin(c);
    if (!change.before.empty() || !change.openings.empty()) continue;  // moving already: within what is freed
    const LoadWork before = rests_[static_cast<std::size_t>(c)].work, now = load_work(c);
    change.left.gravity += before.gravity - now.gravity;
    change.left.other += before.other - now.other;
    change.freed += before.sum() - now.sum();
  }
}

void EnergyAccount::write(MemberId member) {
  if (!started_) return;
  shape_at_rest(member);
  begin(member).member_loads.emplace(member, rest_loads_[index(member)]);
}

void EnergyAccount::write(NodeId node, const Vec6& before) {
  if (!started_) return;
  begin(node).node_loads.emplace(node, before);
}

Vec6 EnergyAccount::after(NodeId node) const {
  return from_.node_solved[index(node)] ? from_.statics.displacement(node) : displacement(node);
}

/// 1/2 (F1 - F0).(u0 + u1) over what stands.
double EnergyAccount::load_changes(const Change& change) const {
  double sum = 0;
  for (const auto& [member, loads] : change.member_loads) {
    if (from_.segments.label(member) < 0) continue;
    const Vec3 down = local_gravity(member);
    const MemberShape &before = change.before.at(member), now = shape_now(member);
    const auto& loads_now = from_.applied[index(member)];
    sum += 0.5 * (before.work(loads_now, down).sum() + now.work(loads_now, down).sum() -
                  before.work(loads, down).sum() - now.work(loads, down).sum());
  }
  for (const auto& [node, load] : change.node_loads)
    if (from_.node_solved[index(node)])
      sum += 0.5 * (from_.loads.on(node) - load).dot(displacement(node) + from_.statics.displacement(node));
  return sum;
}

/// 1/2 (1/k1 - 1/k0) s0.s1 over what became softer, s the internal forces before and after.
double EnergyAccount::softening(const Change& change) const {
  double sum = 0;
  std::vector<MemberId> members = change.softened;
  std::sort(members.begin(), members.end());
  members.erase(std::unique(members.begin(), members.end()), members.end());
  for (MemberId member : members) {
    if (from_.segments.label(member) < 0) continue;
    const double softer = rest_stiffness_[index(member)] / from_.statics.stiffness(member);
    sum += (softer - 1) * change.before.at(member).mutual_energy(shape_now(member));
  }
  return sum;
}

/// Work that the joint's force could have done while its gap opened; a side that left stays where it was.
double EnergyAccount::opened(const Opening& opening) const {
  const Joint& own = from_.building[opening.joint];
  const NodeId node = from_.building[own.member].nodes[static_cast<std::size_t>(own.end)];
  const Vec6 slipped = rest_plastic_rotations(own.member).segment<6>(6 * own.end);
  const Vec6 end =
      from_.segments.label(own.member) >= 0 ? shape_now(own.member).end(own.end) : Vec6(opening.rigid_end - slipped);
  const Vec6 rigid_end = from_.node_solved[index(node)] ? rigid_end_now(own.member, own.end) : opening.rigid_end;
  return -0.5 * opening.force.dot(end - rigid_end + slipped);
}

void EnergyAccount::finish(int number, bool slow, std::vector<JointBreak>& breaks) {
  Change& change = changes_[static_cast<std::size_t>(number)];
  if (!change.open) return;
  const double loads_changed = load_changes(change);
  change.freed += softening(change);
  if (slow) {
    change.contact_left -= loads_changed;
  } else {
    settle_panels(change);
    settle_contacts(number, change);
    change.freed += loads_changed + turned(number) - change.dissipated;
    for (const SupportLoss& loss : change.supports) change.freed -= 0.5 * loss.reaction.dot(after(loss.node));
    for (const MembraneLoss& loss : change.membranes) {
      const std::vector<NodeId> nodes = from_.building[loss.panel].all_nodes();
      for (std::size_t n = 0; n < nodes.size(); ++n) change.freed += 0.5 * loss.forces[n].dot(after(nodes[n]));
    }
    int told = 0;
    double own = 0;
    for (const Opening& opening : change.openings) {
      const double energy = opened(opening);
      if (opening.told < 0) {
        change.freed += energy;
        continue;
      }
      breaks[static_cast<std::size_t>(opening.told)].energy = energy;
      own += energy;
      ++told;
    }
    for (const Opening& opening : change.openings)
      if (opening.told >= 0) breaks[static_cast<std::size_t>(opening.told)].energy += change.freed / told;
    change.freed += own;
  }
  for (const Opening& opening : change.openings) rest_holds_[index(opening.joint)] = 0;
  left_ += change.left;
  contact_left_ += change.contact_left;
  freed_ += change.freed;
  dissipated_ += change.dissipated;
  for (const auto& [member, loads] : change.member_loads) remember_loads(member);
  for (const auto& [node, load] : change.node_loads) remember_loads(node);
  change = {};
  remember(number);
}

void EnergyAccount::lines_are_out() {
  for (Change& change : changes_)
    for (Opening& opening : change.openings) opening.told = -1;
}

LoadWork EnergyAccount::load_work(int component) const {
  LoadWork sum;
  for (MemberId member : from_.statics.members(component)) {
    if (from_.segments.label(member) < 0) continue;
    const auto loads = from_.loads.own_and_handed(member);
    if (!loads.empty()) sum += shape_now(member).work(loads, local_gravity(member));
  }
  for (NodeId node : from_.statics.nodes(component)) {
    if (!from_.node_solved[index(node)]) continue;
    const Vec6& u = from_.statics.displacement(node);
    sum += work(from_.loads.own_and_handed(node), u, gravity_);
    sum.other += from_.loads.event_load(node).dot(u);
  }
  return sum;
}

LoadWork EnergyAccount::rest_load_work(int component) const {
  LoadWork sum;
  for (MemberId member : from_.statics.members(component)) {
    if (rest_member_stands_[index(member)] == 0) continue;
    if (const auto loads = rest_own_loads(member); !loads.empty())
      sum += rest_shape(member).work(loads, local_gravity(member));
  }
  for (NodeId node : from_.statics.nodes(component)) {
    if (rest_node_stands_[index(node)] == 0) continue;
    sum += work(rest_node_loads_[index(node)], displacement(node), gravity_);
    sum.other += rest_event_loads_[index(node)].dot(displacement(node));
  }
  return sum;
}

double EnergyAccount::rest_contact_work(int number) const {
  double sum = 0;
  for (const auto& [key, placed] : rest_contacts_) {
    if (component(placed) != number) continue;
    for (const auto& [member, load] : placed.members)
      if (rest_member_stands_[index(member)] != 0)
        sum += rest_shape(member).work({&load, 1}, local_gravity(member)).sum();
    for (const auto& [node, load] : placed.nodes)
      if (rest_node_stands_[index(node)] != 0) sum += load.dot(displacement(node));
  }
  return sum;
}

/// From internal forces.
double EnergyAccount::rest_elastic(int component) const {
  double sum = 0;
  for (MemberId member : from_.statics.members(component))
    if (rest_member_stands_[index(member)] != 0) sum += rest_shape(member).strain_energy();
  const std::map<PanelId, Plate>& changed = changes_[static_cast<std::size_t>(component)].plates;
  for (const auto& [panel, plate] : changed) sum += plate.energy;
  for (PanelId panel : from_.statics.plates(component))
    if (from_.statics.stiff(panel) && !changed.contains(panel)) sum += rest_plate(panel).energy;
  for (const Spring& spring : rest_springs_[static_cast<std::size_t>(component)])
    for (int c = 0; c < 6; ++c)
      if (std::isfinite(spring.stiffness(c)))
        sum += 0.5 * spring.stiffness(c) * std::pow(displacement(spring.node)(c), 2);
  return sum;
}

FrameEnergy EnergyAccount::energy() const {
  FrameEnergy energy;
  energy.elastic_at_start = elastic_at_start_;
  energy.gravity_work = left_.gravity - start_.gravity;
  energy.other_work = left_.other - start_.other;
  energy.contact_work = contact_left_;
  energy.freed = freed_;
  energy.dissipated = dissipated_;
  for (int c = 0; c < from_.statics.components(); ++c) {
    const Rest& sums = rest(c);
    energy.elastic += sums.elastic;
    energy.gravity_work += sums.work.gravity;
    energy.other_work += sums.work.other;
    energy.contact_work += sums.contact;
  }
  return energy;
}

}  // namespace topple::structure
