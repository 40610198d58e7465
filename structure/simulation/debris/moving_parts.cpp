#include "simulation/debris/moving_parts.h"

#include <Eigen/Geometry>

#include "simulation/debris/debris_settings.h"

namespace topple::structure {

std::optional<PartMotion> MovingParts::velocity(collision::ObstacleId id) const {
  const Part part = debris_.obstacles.part_of(id);
  if (!part.valid()) return hinges_.holds().velocity(id);
  const StandingFrame& frame = *debris_.scene.frame;
  if (!frame.moves({part.member, part.panel})) return std::nullopt;
  return rigid_velocity(frame, part, debris_.obstacles.middle(part));
}

PartMotion MovingParts::foreseen_acceleration(collision::ObstacleId id) const {
  const Part part = debris_.obstacles.part_of(id);
  if (!part.valid()) return hinges_.holds().foreseen_acceleration(id);
  return structure::foreseen_acceleration(*debris_.scene.frame, part, debris_.obstacles.middle(part));
}

/// And its mass.
collision::ObstacleMotion MovingParts::pose_and_mass(collision::ObstacleId id) const {
  const Part part = debris_.obstacles.part_of(id);
  if (!part.valid()) return hinges_.holds().motion(id);
  const MassProperties& own = part.member.valid() ? debris_.masses.of(part.member) : debris_.masses.of(part.panel);
  collision::ObstacleMotion motion;
  motion.pose = debris_.obstacles.carry(part, *debris_.scene.frame);
  motion.mass = debris_settings.share_of_part * own.mass;
  motion.inertia = debris_settings.share_of_part * own.inertia;
  return motion;
}

std::optional<collision::ObstacleMotion> MovingParts::motion(collision::ObstacleId id) {
  const std::optional<PartMotion> now = velocity(id);
  if (!now) {
    known_.erase(id.value);
    return std::nullopt;
  }
  Known& known = known_[id.value];
  known.velocity = *now;
  collision::ObstacleMotion motion = pose_and_mass(id);
  motion.velocity = known.velocity.moved;
  motion.angular_velocity = known.velocity.turned;
  const PartMotion foreseen = foreseen_acceleration(id);
  motion.acceleration = foreseen.moved;
  motion.angular_acceleration = foreseen.turned;
  motion.last_acceleration = known.acceleration.moved;
  motion.last_angular_acceleration = known.acceleration.turned;
  motion.held_anew = known.held_anew;
  return motion;
}

std::optional<collision::ObstaclePath> MovingParts::path(collision::ObstacleId id) const {
  const Part part = debris_.obstacles.part_of(id);
  if (!part.valid()) return std::nullopt;  // a place that hinges hold to: nothing touches it
  const std::optional<PartMotion> now = velocity(id);
  if (!now) return std::nullopt;
  return collision::ObstaclePath{debris_.obstacles.pose(part, *debris_.scene.frame), now->moved, now->turned};
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
                          std::span<const collision::HingePull> pulls) {
  const StandingFrame& frame = *debris_.scene.frame;
  debris_.resting.act(contacts, debris_.obstacles, dt, *debris_.scene.frame, [&](collision::BodyId id) {
    return debris_.bodies.contains(id.value) && !debris_.scene.world->state(id).asleep;
  });
  const std::vector<collision::HingePull> pulled = hinges_.act(pulls, dt);
  const std::vector<PartingContact> may_part = this->may_part(contacts);
  const std::uint64_t changes = frame.mobility_changes();
  substep_.advance();
  const bool held_anew = frame.mobility_changes() != changes;
  sums_.ledger.lost_in_contacts += limit_parting(debris_, may_part, debris_.scene.scenario.debris.restitution);
  std::map<std::int64_t, Known> after;
  for (const auto& [id, known] : known_) {
    const std::optional<PartMotion> moves = velocity({id});
    if (!moves) continue;
    Known now;
    now.velocity = *moves;
    now.acceleration.moved = (now.velocity.moved - known.velocity.moved) / dt;
    now.acceleration.turned = (now.velocity.turned - known.velocity.turned) / dt;
    now.held_anew = held_anew;
    after.emplace(id, now);
  }
  // What contacts and hinges did to what moved on: not lost, and no work of gravity.
  const auto pass_on = [&](double work) {
    sums_.passed_on += work;
    sums_.ledger.lost_in_contacts -= work;
  };
  for (const PartingContact& one : may_part) {
    const auto now = after.find(one.contact.other.obstacle.value);
    if (now == after.end()) continue;
    const PartMotion& velocity = now->second.velocity;
    const Vec3 arm = one.contact.point - debris_.obstacles.middle(one.part);
    const double work = one.contact.impulse.dot(one.velocity) / 2 +
                        one.contact.impulse.dot(velocity.moved + velocity.turned.cross(arm)) / 2;
    pass_on(work);
  }
  for (const collision::HingePull& one : pulled) {
    const auto now = after.find(one.holder.value);
    if (now == after.end()) continue;
    const PartMotion &before = known_.at(one.holder.value).velocity, &then = now->second.velocity;
    pass_on(one.impulse.dot(before.moved + then.moved) / 2 + one.moment.dot(before.turned + then.turned) / 2);
  }
  known_ = std::move(after);
  hinges_.break_over();
  substep_.strike(dt);
}

}  // namespace topple::structure
