#include "simulation/debris/standing_holds.h"

#include <algorithm>
#include <cmath>

#include "simulation/debris/debris_settings.h"
#include "simulation/debris/moved_pose.h"

namespace topple::structure {

namespace {

/// Of a place on a rigid arm from the node.
PartMotion rigid(const Vec6& node, const Vec3& arm) {
  return {node.head<3>() + Vec3(node.tail<3>()).cross(arm), node.tail<3>()};
}

}  // namespace

collision::ObstacleId StandingHolds::hold(const ContactPlace& place, NodeId fixed_to, const Vec3& point) {
  for (auto& [id, other] : holds_) other.found_at.reset();  // it may give way under this one as well
  Hold made;
  made.place = place;
  made.fixed_to = fixed_to;
  const PartMotion shift = displacement(made);
  made.origin = point - shift.moved;
  made.followed = shift.moved;
  collision::ObstacleDescription nothing_to_touch;
  nothing_to_touch.pose = moved_pose(made.origin, shift);
  const collision::ObstacleId id = scene_.world->add_obstacle(nothing_to_touch);
  holds_.emplace(id.value, made);
  return id;
}

void StandingHolds::let_go(collision::ObstacleId obstacle) {
  const auto found = holds_.find(obstacle.value);
  if (found == holds_.end()) return;
  scene_.world->remove_obstacle(obstacle);
  holds_.erase(found);
}

PartMotion StandingHolds::displacement(const Hold& hold) const {
  const StandingFrame& frame = *scene_.frame;
  if (!hold.place.node.valid()) return rigid_displacement(frame, Part(hold.place.member), hold.place.point);
  return rigid(frame.displacement(hold.place.node), hold.place.point - scene_.building[hold.place.node].position);
}

std::optional<PartMotion> StandingHolds::velocity(collision::ObstacleId obstacle) const {
  const auto found = holds_.find(obstacle.value);
  if (found == holds_.end() || !scene_.frame->moves(found->second.place)) return std::nullopt;
  const Hold& hold = found->second;
  if (!hold.place.node.valid()) return rigid_velocity(*scene_.frame, Part(hold.place.member), hold.place.point);
  return rigid(scene_.frame->velocity(hold.place.node), hold.place.point - scene_.building[hold.place.node].position);
}

PartMotion StandingHolds::foreseen_acceleration(collision::ObstacleId obstacle) const {
  const Hold& hold = holds_.at(obstacle.value);
  if (!hold.place.node.valid())
    return structure::foreseen_acceleration(*scene_.frame, Part(hold.place.member), hold.place.point);
  return rigid(scene_.frame->foreseen_acceleration(hold.place.node),
               hold.place.point - scene_.building[hold.place.node].position);
}

collision::ObstacleMotion StandingHolds::motion(collision::ObstacleId obstacle) {
  Hold& hold = holds_.at(obstacle.value);
  const std::uint64_t now = scene_.frame->mobility_changes();
  if (hold.found_at != now) find_mobility(hold);
  hold.found_at = now;
  const PartMotion shift = displacement(hold);
  hold.followed = shift.moved;
  collision::ObstacleMotion motion;
  motion.pose = moved_pose(hold.origin, shift);
  motion.mobility = hold.mobility;
  return motion;
}

/// As its node gives way at the first moment; where several hang at one, each may give way under all.
void StandingHolds::find_mobility(Hold& hold) const {
  // What gives way in no way does so a little all the same: shares of the others (1 m for a length), and 1/kg.
  constexpr double of_turns = 1e-3, of_other = 1e-6, least = 1e-12;
  const Vec3 arm = hold.place.point - scene_.building[hold.fixed_to].position;
  collision::Mat6 to_place = collision::Mat6::Identity();
  for (int k = 0; k < 3; ++k) to_place.block<3, 1>(0, 3 + k) = Vec3::Unit(k).cross(arm);
  hold.mobility = to_place * scene_.frame->substep_mobility(hold.fixed_to) * to_place.transpose();
  const double moves = hold.mobility.diagonal().head<3>().maxCoeff(),
               turns = hold.mobility.diagonal().tail<3>().maxCoeff();
  hold.mobility.diagonal().head<3>().array() += std::max({of_turns * moves, of_other * turns, least});
  hold.mobility.diagonal().tail<3>().array() += std::max({of_turns * turns, of_other * moves, least});
  hold.mobility *= static_cast<double>(std::count_if(
      holds_.begin(), holds_.end(), [&](const auto& one) { return one.second.fixed_to == hold.fixed_to; }));
}

void StandingHolds::follow() {
  for (auto& [id, hold] : holds_) {
    const PartMotion now = displacement(hold);
    if (!((now.moved - hold.followed).norm() > debris_settings.follow)) continue;
    hold.followed = now.moved;
    scene_.world->move_obstacle({id}, moved_pose(hold.origin, now));
  }
}

}  // namespace topple::structure
