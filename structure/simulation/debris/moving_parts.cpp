#include "simulation/debris/moving_parts.h"

#include <Eigen/Geometry>

#include "simulation/debris/debris_settings.h"

namespace topple::structure {

PartMotion MovingParts::velocity(Part part) const {
  return rigid_velocity(*debris_.scene.frame, part, debris_.obstacles.middle(part));
}

std::optional<collision::ObstacleMotion> MovingParts::motion(collision::ObstacleId id) {
  const Part part = debris_.obstacles.part_of(id);
  const StandingFrame& frame = *debris_.scene.frame;
  if (!part.valid() || !frame.moves({part.member, part.panel})) {
    known_.erase(id.value);
    return std::nullopt;
  }
  Known& known = known_[id.value];
  known.velocity = velocity(part);
  const MassProperties& own = part.member.valid() ? debris_.masses.of(part.member) : debris_.masses.of(part.panel);
  collision::ObstacleMotion motion;
  motion.pose = debris_.obstacles.carry(part, frame);
  motion.velocity = known.velocity.moved;
  motion.angular_velocity = known.velocity.turned;
  motion.acceleration = known.acceleration.moved;
  motion.angular_acceleration = known.acceleration.turned;
  motion.mass = debris_settings.share_of_part * own.mass;
  motion.inertia = debris_settings.share_of_part * own.inertia;
  motion.held_anew = known.held_anew;
  return motion;
}

/// Those that push what moves, with the part's velocity.
std::vector<PartingContact> MovingParts::may_part(std::span<const collision::Contact> contacts) const {
  std::vector<PartingContact> found;
  for (const collision::Contact& contact : contacts) {
    const auto known = known_.find(contact.other.obstacle.value);
    if (contact.other.kind != collision::Touched::Kind::obstacle || known == known_.end()) continue;
    const Part part = debris_.obstacles.part_of(contact.other.obstacle);
    const Vec3 arm = contact.point - debris_.obstacles.middle(part);
    found.push_back({contact, part, known->second.velocity.moved + known->second.velocity.turned.cross(arm)});
  }
  return found;
}

void MovingParts::advance(double dt, std::span<const collision::Contact> contacts,
                          std::span<const collision::HingePull> /*no hinge names a holder*/) {
  const StandingFrame& frame = *debris_.scene.frame;
  debris_.resting.act(contacts, debris_.obstacles, dt, *debris_.scene.frame, [&](collision::BodyId id) {
    return debris_.bodies.contains(id.value) && !debris_.scene.world->state(id).asleep;
  });
  const std::vector<PartingContact> may_part = this->may_part(contacts);
  const std::uint64_t changes = frame.counters().segmentations;
  substep_();
  const bool held_anew = frame.counters().segmentations != changes;
  sums_.ledger.lost_in_contacts += limit_parting(debris_, may_part, debris_.scene.scenario.debris.restitution);
  std::map<std::int64_t, Known> after;
  for (const auto& [id, known] : known_) {
    const Part part = debris_.obstacles.part_of({id});
    if (!part.valid() || !frame.moves({part.member, part.panel})) continue;
    Known now;
    now.velocity = velocity(part);
    now.acceleration.moved = (now.velocity.moved - known.velocity.moved) / dt;
    now.acceleration.turned = (now.velocity.turned - known.velocity.turned) / dt;
    now.held_anew = held_anew;
    after.emplace(id, now);
  }
  // What contacts did to what moved on: not lost, and no work of gravity.
  for (const PartingContact& one : may_part) {
    const auto now = after.find(one.contact.other.obstacle.value);
    if (now == after.end()) continue;
    const PartMotion& velocity = now->second.velocity;
    const Vec3 arm = one.contact.point - debris_.obstacles.middle(one.part);
    const double work = one.contact.impulse.dot(one.velocity) / 2 +
                        one.contact.impulse.dot(velocity.moved + velocity.turned.cross(arm)) / 2;
    sums_.passed_on += work;
    sums_.ledger.lost_in_contacts -= work;
  }
  known_ = std::move(after);
}

}  // namespace topple::structure
