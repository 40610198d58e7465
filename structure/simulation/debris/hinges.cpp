#include "simulation/debris/hinges.h"

#include <algorithm>
#include <cmath>

#include "model/index_of.h"
#include "simulation/debris/debris_settings.h"
#include "simulation/impact/impact_settings.h"
#include "topple/structure/joint_check.h"

namespace topple::structure {

namespace {

template <class Id>
bool has(const std::vector<Id>& list, Id id) {
  return std::find(list.begin(), list.end(), id) != list.end();
}
}  // namespace

/// The other side of a joint whose member (or else its rigid end) hangs.
ContactPlace Hinges::hold_of(JointId joint, bool member_hangs) const {
  const Joint& own = scene_.building[joint];
  ContactPlace place;
  place.point = scene_.joint_position(joint);
  if (member_hangs)
    place.node = scene_.building[own.member].nodes[static_cast<std::size_t>(own.end)];
  else
    place.member = own.member;
  return place;
}

/// Hangs a body by a joint on what stands or on another body. False when there is nothing to hang it on.
bool Hinges::hang(JointId joint, collision::BodyId id) {
  const Body& one = debris_.bodies.at(id.value);
  const Member& member = scene_.building[scene_.building[joint].member];
  Hung hung;
  hung.joint = joint;
  hung.body = id;
  hung.member_hangs = has(one.members, scene_.building[joint].member) || one.end_joint == joint;
  const ContactPlace on = hold_of(joint, hung.member_hangs);
  const bool on_frame = on.member.valid() ? scene_.frame->stands(on.member) : scene_.frame->stands(on.node);
  if (!on_frame) hung.holder = debris_.body_with(on);
  if (!on_frame && (hung.holder.value < 0 || hung.holder == id)) return false;

  collision::HingeDescription description;
  description.body = id;
  if (!on_frame) description.other = hung.holder;
  description.point = scene_.world->state(id).pose * Vec3(scene_.joint_position(joint) - one.rest.centre);
  description.axes = member.axes * debris_.rotation(hung.member_hangs ? id : hung.holder).transpose();
  for (int c = 0; c < 6; ++c) description.held[static_cast<std::size_t>(c)] = scene_.building[joint].stiffness(c) != 0;
  if (std::find(description.held.begin(), description.held.end(), true) == description.held.end()) return false;
  if (on_frame && scene_.sways()) {
    const auto end = static_cast<std::size_t>(scene_.building[joint].end);
    description.holder = hung.place =
        holds_.hold(on, member.nodes[hung.member_hangs ? end : 1 - end], description.point);
  }
  hung.axes = description.axes * debris_.rotation(hung.holder);
  hung.hinge = scene_.world->add_hinge(description);
  hung.load_key = --last_load_;
  pass_what_holds(id, on.point, hung.holder);
  hinges_.emplace(hung.hinge.value, hung);
  return true;
}

/// A part that hangs on begins inside what it was joined to, and turns through it.
void Hinges::pass_what_holds(collision::BodyId id, const Vec3& point, collision::BodyId holder) {
  if (holder.value >= 0) return debris_.pass(id, holder);
  Bounds around;
  around.add(point - Vec3::Constant(debris_settings.joint_room));
  around.add(point + Vec3::Constant(debris_settings.joint_room));
  debris_.obstacles.approach(around, *scene_.frame, *scene_.world);
  collision::Touched touched;
  touched.kind = collision::Touched::Kind::obstacle;
  for (const Part part : debris_.grid.near(around)) {
    touched.obstacle = debris_.obstacles.obstacle_of(part);
    if (touched.obstacle.value >= 0) debris_.pass(id, touched);
  }
}

/// The joints by which a part that left hangs on; those that find nothing to hang on have lost their hold.
void Hinges::hang_on(const std::vector<JointId>& joints, collision::BodyId id) {
  for (const JointId joint : joints) {
    if (hang(joint, id)) continue;
    JointBreak lost;
    lost.joint = joint;
    lost.position = scene_.joint_position(joint);
    log_.record(lost);
  }
}

/// What held some of them has left: they hang on the body that it became.
void Hinges::hang_on_what_left() {
  std::vector<Hung> loose;
  for (const auto& [key, hung] : hinges_) {
    if (hung.holder.value >= 0) continue;
    const ContactPlace on = hold_of(hung.joint, hung.member_hangs);
    if (!(on.member.valid() ? scene_.frame->stands(on.member) : scene_.frame->stands(on.node))) loose.push_back(hung);
  }
  for (const Hung& hung : loose) {
    unhook(hung);
    hang_on({hung.joint}, hung.body);
  }
}

void Hinges::unhook(const Hung& hung) {
  if (moves_) sums_.ledger.lost_in_contacts += scene_.world->hinge_work_lost(hung.hinge);
  scene_.frame->remove_contact_load(hung.load_key);
  scene_.world->remove_hinge(hung.hinge);
  holds_.let_go(hung.place);
  hinges_.erase(hung.hinge.value);
}

/// The body is about to go: it hangs on nothing any more, and nothing on it. Returns the joints of both kinds.
std::vector<JointId> Hinges::unhook(collision::BodyId id) {
  std::vector<Hung> its;
  for (const auto& [key, hung] : hinges_)
    if (hung.body == id || hung.holder == id) its.push_back(hung);
  std::vector<JointId> joints;
  for (const Hung& hung : its) {
    joints.push_back(hung.joint);
    unhook(hung);
  }
  return joints;
}

/// After a body fell apart into others: what it hung by, and what hung on it, goes on with the piece that has its side.
void Hinges::hang_again(const std::vector<JointId>& joints) {
  for (const JointId joint : joints) {
    const auto piece = std::find_if(debris_.bodies.begin(), debris_.bodies.end(),
                                    [&](const auto& one) { return one.second.end_joint == joint; });
    const collision::BodyId of_member =
        piece != debris_.bodies.end() ? piece->second.id : debris_.body_with(hold_of(joint, false));
    const collision::BodyId of_rigid_end = debris_.body_with(hold_of(joint, true));
    const collision::BodyId hanging = of_member.value >= 0 ? of_member : of_rigid_end;
    if (hanging.value >= 0) hang_on({joint}, hanging);
  }
}

/// What is over sooner than an impact lets no joint feel its force: its mean by the exact decay over dt, so that two
/// short parts of a step are one long one.
void Hinges::feel(Hung& hung, const Vec3& force, const Vec3& moment, double dt) {
  const double share = 1 - std::exp(-dt / impact_settings.landing_time);
  hung.felt += share * (force - hung.felt);
  hung.moment_felt += share * (moment - hung.moment_felt);
  const Utilisation used = utilisation_of(hung);
  if (used.value > 1) over_.emplace_back(hung.hinge.value, used);
}

/// After the world has moved: what each hinge held with, whether it bears that, and what it does to what stands.
void Hinges::pull() {
  moves_ = false;
  for (auto& [key, hung] : hinges_) {
    if (scene_.world->state(hung.body).asleep) continue;
    pass_what_holds(hung.body, scene_.joint_position(hung.joint),
                    hung.holder);  // it may have turned clear of it and back
    sums_.ledger.lost_in_contacts += scene_.world->hinge_work_lost(hung.hinge);
    const Vec6 held = scene_.world->hinge_force(hung.hinge);  // of the body on its holder
    const Mat3 to_global = (hung.axes * debris_.rotation(hung.holder).transpose()).transpose();
    const Vec3 force = to_global * held.head<3>(), moment = to_global * held.tail<3>();
    smooth(hung, force, moment);
    if (std::exchange(hung.acted, false)) continue;
    feel(hung, force, moment, scene_.scenario.step);
    if (hung.holder.value < 0) load_by(hung);
  }
  break_over();
}

void Hinges::break_over() {
  for (const auto& [key, used] : std::exchange(over_, {})) {
    const auto found = hinges_.find(key);
    if (found == hinges_.end()) continue;  // what it held to has left meanwhile
    const Hung hung = found->second;
    JointBreak line;
    line.joint = hung.joint;
    line.sense = used.sense;
    line.demand = used.demand;
    line.capacity = used.capacity;
    const Body& one = debris_.bodies.at(hung.body.value);
    line.position = scene_.world->state(hung.body).pose * Vec3(scene_.joint_position(hung.joint) - one.rest.centre);
    log_.record(line);
    unhook(hung);
  }
}

/// By what the joint feels.
Utilisation Hinges::utilisation_of(const Hung& hung) const {
  const Joint& joint = scene_.building[hung.joint];
  const Mat3 axes =
      scene_.building[joint.member].axes * debris_.rotation(hung.member_hangs ? hung.body : hung.holder).transpose();
  // End forces are what the rigid end does to the member.
  const double sign = hung.member_hangs ? -1 : 1;
  Eigen::Matrix<double, 12, 1> end_forces = Eigen::Matrix<double, 12, 1>::Zero();
  end_forces.segment<3>(6 * joint.end) = sign * axes * hung.felt;
  end_forces.segment<3>(6 * joint.end + 3) = sign * axes * hung.moment_felt;
  return utilisation(joint.capacity, member_joint_demand(end_forces, joint.end),
                     scene_.strength_factors[index_of(hung.joint)]);
}

void Hinges::smooth(Hung& hung, const Vec3& force, const Vec3& moment) const {
  const double share = std::min(1.0, scene_.scenario.step / debris_settings.smoothing_time);
  hung.force += share * (force - hung.force);
  hung.moment += share * (moment - hung.moment);
}

/// The smoothed pull on what stands, told when it has changed beyond a band.
void Hinges::load_by(Hung& hung) {
  const double band =
      debris_settings.hinge_band * debris_.bodies.at(hung.body.value).rest.mass * scene_.building.gravity;
  const double arm = scene_.building[scene_.building[hung.joint].member].length;
  const double changed = (hung.force - hung.applied).norm() + (hung.moment - hung.moment_applied).norm() / arm;
  if (changed <= band) return;
  load(hung, hung.force, hung.moment);
}

void Hinges::load(Hung& hung, const Vec3& force, const Vec3& moment) {
  hung.applied = force;
  hung.moment_applied = moment;
  scene_.frame->set_contact_load({hung.load_key, hold_of(hung.joint, hung.member_hangs), force, moment});
}

std::vector<collision::HingePull> Hinges::act(std::span<const collision::HingePull> pulls, double dt) {
  std::vector<collision::HingePull> acted;
  for (const collision::HingePull& pull : pulls) {
    const auto found = hinges_.find(pull.hinge.value);
    if (found == hinges_.end()) continue;
    load(found->second, pull.impulse / dt, pull.moment / dt);
    feel(found->second, pull.impulse / dt, pull.moment / dt, dt);
    found->second.acted = true;
    acted.push_back(pull);
  }
  return acted;
}

}  // namespace topple::structure
