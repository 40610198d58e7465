// Hinges: a part that moves as a mechanism hangs on by the joints that still hold it. They turn freely in what is
// released and hold in the rest; what they hold with loads what they hang on, and one that comes to its capacity
// breaks.
#include <algorithm>
#include <cmath>

#include "simulation/debris/debris_settings.h"
#include "simulation/simulation_state.h"
#include "topple/structure/joint_check.h"

namespace topple::structure {

namespace {

template <class Id>
bool has(const std::vector<Id>& list, Id id) {
  return std::find(list.begin(), list.end(), id) != list.end();
}
}  // namespace

/// The other side of a joint whose member (or else its rigid end) hangs.
ContactPlace Simulation::State::hold_of(JointId joint, bool member_hangs) const {
  const Joint& own = scene.building[joint];
  ContactPlace place;
  place.point = scene.joint_position(joint);
  if (member_hangs)
    place.node = scene.building[own.member].nodes[static_cast<std::size_t>(own.end)];
  else
    place.member = own.member;
  return place;
}

/// Hangs a body by a joint on what stands or on another body. False when there is nothing to hang it on.
bool Simulation::State::hang(JointId joint, collision::BodyId id) {
  const Body& one = debris.bodies.at(id.value);
  const Member& member = scene.building[scene.building[joint].member];
  Hung hung;
  hung.joint = joint;
  hung.body = id;
  hung.member_hangs = has(one.members, scene.building[joint].member) || one.end_joint == joint;
  const ContactPlace on = hold_of(joint, hung.member_hangs);
  const bool on_frame = on.member.valid() ? scene.frame->stands(on.member) : scene.frame->stands(on.node);
  if (!on_frame) hung.holder = debris.body_with(on);
  if (!on_frame && (hung.holder.value < 0 || hung.holder == id)) return false;

  collision::HingeDescription description;
  description.body = id;
  if (!on_frame) description.other = hung.holder;
  description.point = scene.world->state(id).pose * Vec3(scene.joint_position(joint) - one.rest.centre);
  description.axes = member.axes * debris.rotation(hung.member_hangs ? id : hung.holder).transpose();
  for (int c = 0; c < 6; ++c) description.held[static_cast<std::size_t>(c)] = scene.building[joint].stiffness(c) != 0;
  if (std::find(description.held.begin(), description.held.end(), true) == description.held.end()) return false;
  hung.axes = description.axes * debris.rotation(hung.holder);
  hung.hinge = scene.world->add_hinge(description);
  hung.load_key = --last_hinge_load;
  pass_what_holds(id, on.point, hung.holder);
  hinges.emplace(hung.hinge.value, hung);
  return true;
}

/// A part that hangs on begins inside what it was joined to, and turns through it.
void Simulation::State::pass_what_holds(collision::BodyId id, const Vec3& point, collision::BodyId holder) {
  if (holder.value >= 0) return debris.pass(id, holder);
  Bounds around;
  around.add(point - Vec3::Constant(debris_settings.joint_room));
  around.add(point + Vec3::Constant(debris_settings.joint_room));
  debris.obstacles.approach(around, *scene.frame, *scene.world);
  collision::Touched touched;
  touched.kind = collision::Touched::Kind::obstacle;
  for (const Part part : debris.grid.near(around)) {
    touched.obstacle = debris.obstacles.obstacle_of(part);
    if (touched.obstacle.value >= 0) debris.pass(id, touched);
  }
}

/// The joints by which a part that left hangs on; those that find nothing to hang on have lost their hold.
void Simulation::State::hang_on(const std::vector<JointId>& joints, collision::BodyId id) {
  for (const JointId joint : joints) {
    if (hang(joint, id)) continue;
    JointBreak lost;
    lost.joint = joint;
    lost.position = scene.joint_position(joint);
    log.record(lost);
  }
}

/// What held some of them has left: they hang on the body that it became.
void Simulation::State::hang_on_what_left() {
  std::vector<Hung> loose;
  for (const auto& [key, hung] : hinges) {
    if (hung.holder.value >= 0) continue;
    const ContactPlace on = hold_of(hung.joint, hung.member_hangs);
    if (!(on.member.valid() ? scene.frame->stands(on.member) : scene.frame->stands(on.node))) loose.push_back(hung);
  }
  for (const Hung& hung : loose) {
    take_off(hung);
    hang_on({hung.joint}, hung.body);
  }
}

void Simulation::State::take_off(const Hung& hung) {
  scene.frame->remove_contact_load(hung.load_key);
  scene.world->remove_hinge(hung.hinge);
  hinges.erase(hung.hinge.value);
}

/// The body is about to go: it hangs on nothing any more, and nothing on it. Returns the joints of both kinds.
std::vector<JointId> Simulation::State::take_off(collision::BodyId id) {
  std::vector<Hung> its;
  for (const auto& [key, hung] : hinges)
    if (hung.body == id || hung.holder == id) its.push_back(hung);
  std::vector<JointId> joints;
  for (const Hung& hung : its) {
    joints.push_back(hung.joint);
    take_off(hung);
  }
  return joints;
}

/// After a body fell apart into others: what it hung by, and what hung on it, goes on with the piece that has its side.
void Simulation::State::hang_again(const std::vector<JointId>& joints) {
  for (const JointId joint : joints) {
    const auto piece = std::find_if(debris.bodies.begin(), debris.bodies.end(),
                                    [&](const auto& one) { return one.second.end_joint == joint; });
    const collision::BodyId of_member =
        piece != debris.bodies.end() ? piece->second.id : debris.body_with(hold_of(joint, false));
    const collision::BodyId of_rigid_end = debris.body_with(hold_of(joint, true));
    const collision::BodyId hanging = of_member.value >= 0 ? of_member : of_rigid_end;
    if (hanging.value >= 0) hang_on({joint}, hanging);
  }
}

/// After the world has moved: what each hinge held with, whether it bears that, and what it does to what stands.
void Simulation::State::pull_hinges() {
  std::vector<std::pair<Hung, Utilisation>> over;
  for (auto& [key, hung] : hinges) {
    if (scene.world->state(hung.body).asleep) continue;
    pass_what_holds(hung.body, scene.joint_position(hung.joint),
                    hung.holder);  // it may have turned clear of it and back
    sums.ledger.lost_in_contacts += scene.world->hinge_work_lost(hung.hinge);
    const Vec6 held = scene.world->hinge_force(hung.hinge);  // of the body on its holder
    const Mat3 to_global = (hung.axes * debris.rotation(hung.holder).transpose()).transpose();
    const Vec3 force = to_global * held.head<3>(), moment = to_global * held.tail<3>();
    const Utilisation used = utilisation_of(hung, force, moment);
    if (used.value > 1)
      over.emplace_back(hung, used);
    else if (hung.holder.value < 0)
      load_by(hung, force, moment);
  }
  for (const auto& [hung, used] : over) {
    JointBreak line;
    line.joint = hung.joint;
    line.sense = used.sense;
    line.demand = used.demand;
    line.capacity = used.capacity;
    const Body& one = debris.bodies.at(hung.body.value);
    line.position = scene.world->state(hung.body).pose * Vec3(scene.joint_position(hung.joint) - one.rest.centre);
    log.record(line);
    take_off(hung);
  }
}

/// `force` and `moment` of the body on its holder, global axes.
Utilisation Simulation::State::utilisation_of(const Hung& hung, const Vec3& force, const Vec3& moment) const {
  const Joint& joint = scene.building[hung.joint];
  const Mat3 axes =
      scene.building[joint.member].axes * debris.rotation(hung.member_hangs ? hung.body : hung.holder).transpose();
  // End forces are what the rigid end does to the member.
  const double sign = hung.member_hangs ? -1 : 1;
  Eigen::Matrix<double, 12, 1> end_forces = Eigen::Matrix<double, 12, 1>::Zero();
  end_forces.segment<3>(6 * joint.end) = sign * axes * force;
  end_forces.segment<3>(6 * joint.end + 3) = sign * axes * moment;
  return utilisation(joint.capacity, member_joint_demand(end_forces, joint.end),
                     scene.strength_factors[static_cast<std::size_t>(hung.joint.index)]);
}

/// The smoothed pull on what stands, told when it has changed beyond a band.
void Simulation::State::load_by(Hung& hung, const Vec3& force, const Vec3& moment) {
  const double share = std::min(1.0, scene.scenario.step / debris_settings.smoothing_time);
  hung.force += share * (force - hung.force);
  hung.moment += share * (moment - hung.moment);
  const double band = debris_settings.hinge_band * debris.bodies.at(hung.body.value).rest.mass * scene.building.gravity;
  const double arm = scene.building[scene.building[hung.joint].member].length;
  const double changed = (hung.force - hung.applied).norm() + (hung.moment - hung.moment_applied).norm() / arm;
  if (changed <= band) return;
  hung.applied = hung.force;
  hung.moment_applied = hung.moment;
  scene.frame->set_contact_load({hung.load_key, hold_of(hung.joint, hung.member_hangs), hung.force, hung.moment});
}

}  // namespace topple::structure
