#include "simulation/debris/obstacles.h"

#include <algorithm>

#include "simulation/debris/debris_settings.h"
#include "simulation/debris/moved_pose.h"

namespace topple::structure {

Obstacles::Obstacles(const Building& building, const PartShapes& shapes, const PartGrid& grid, double friction,
                     double restitution, bool sways)
    : building_(building),
      shapes_(shapes),
      grid_(grid),
      friction_(friction),
      restitution_(restitution),
      sways_(sways),
      obstacle_of_part_(part_count(building)),
      settled_(part_count(building), 0) {}

void Obstacles::approach(const Bounds& box, const StandingFrame& frame, collision::World& world) {
  std::vector<Part> near = without_shape(box);
  approach(near, box, frame, world);
}

void Obstacles::approach(std::vector<Part>& near, const Bounds& box, const StandingFrame& frame,
                         collision::World& world) {
  std::erase_if(near, [&](Part part) {
    const auto number = static_cast<std::size_t>(part_number(building_, part));
    if (settled_[number] != 0) return true;
    if (!shapes_.bounds(part).meets(box)) return false;
    settled_[number] = 1;
    if (part.member.valid() ? frame.stands(part.member) : frame.stands(part.panel)) {
      obstacle_of_part_[number] = make(part, world);
      if (sways_) {
        shifted_[number] = rigid_displacement(frame, part, middle(part));
        put(number, world);
      }
    }
    return true;
  });
}

Vec3 Obstacles::middle(Part part) const {
  const Bounds& bounds = shapes_.bounds(part);
  return (bounds.low + bounds.high) / 2;
}

void Obstacles::put(std::size_t number, collision::World& world) const {
  const auto found = shifted_.find(number);
  if (found == shifted_.end()) return;
  const Part part = part_of_number(building_, static_cast<std::int64_t>(number));
  world.move_obstacle(obstacle_of_part_[number], pose_of(part, found->second));
}

collision::Pose Obstacles::pose_of(Part part, const PartMotion& shift) const { return moved_pose(middle(part), shift); }

collision::Pose Obstacles::pose(Part part, const StandingFrame& frame) const {
  return pose_of(part, rigid_displacement(frame, part, middle(part)));
}

collision::Pose Obstacles::carry(Part part, const StandingFrame& frame) {
  PartMotion& shift = shifted_[static_cast<std::size_t>(part_number(building_, part))];
  shift = rigid_displacement(frame, part, middle(part));
  return pose_of(part, shift);
}

void Obstacles::follow(const StandingFrame& frame, collision::World& world) {
  reach_ = 0;
  for (std::size_t n = 0; n < building_.nodes.size(); ++n)
    if (frame.stands(NodeId(n))) reach_ = std::max(reach_, frame.displacement(NodeId(n)).head<3>().norm());
  if (!(reach_ > debris_settings.follow) && shifted_.empty()) return;
  for (const auto& [id, part] : part_of_obstacle_) {
    const auto number = static_cast<std::size_t>(part_number(building_, part));
    if (obstacle_of_part_[number].value != id) continue;  // a shape that it had
    const PartMotion now = rigid_displacement(frame, part, middle(part));
    const auto found = shifted_.find(number);
    const PartMotion before = found == shifted_.end() ? PartMotion() : found->second;
    const Bounds& bounds = shapes_.bounds(part);
    const double off =
        (now.moved - before.moved).norm() + (now.turned - before.turned).norm() * (bounds.high - bounds.low).norm() / 2;
    if (!(off > debris_settings.follow)) continue;
    shifted_[number] = now;
    put(number, world);
  }
}

collision::ObstacleId Obstacles::make(Part part, collision::World& world) {
  collision::ObstacleDescription description;
  description.pose.position = middle(part);
  description.parts = shapes_.parts(part, description.pose.position);
  description.friction = friction_;
  description.restitution = restitution_;
  const collision::ObstacleId obstacle = world.add_obstacle(description);
  part_of_obstacle_.emplace(obstacle.value, part);
  return obstacle;
}

void Obstacles::renew(Part part, collision::World& world) {
  collision::ObstacleId& obstacle = obstacle_of_part_[static_cast<std::size_t>(part_number(building_, part))];
  if (obstacle.value < 0) return;
  world.remove_obstacle(obstacle);
  obstacle = make(part, world);
  put(static_cast<std::size_t>(part_number(building_, part)), world);
}

void Obstacles::remove(Part part, collision::World& world) {
  collision::ObstacleId& obstacle = obstacle_of_part_[static_cast<std::size_t>(part_number(building_, part))];
  if (obstacle.value < 0) return;
  world.remove_obstacle(obstacle);
  part_of_obstacle_.erase(obstacle.value);
  shifted_.erase(static_cast<std::size_t>(part_number(building_, part)));
  obstacle = {};
}

Part Obstacles::part_of(collision::ObstacleId obstacle) const {
  const auto found = part_of_obstacle_.find(obstacle.value);
  return found == part_of_obstacle_.end() ? Part() : found->second;
}

collision::ObstacleId Obstacles::obstacle_of(Part part) const {
  return obstacle_of_part_[static_cast<std::size_t>(part_number(building_, part))];
}

}  // namespace topple::structure
