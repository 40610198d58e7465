#include "simulation/debris/obstacles.h"

namespace topple::structure {

Obstacles::Obstacles(const Building& building, const PartShapes& shapes, const PartGrid& grid, double friction,
                     double restitution)
    : building_(building),
      shapes_(shapes),
      grid_(grid),
      friction_(friction),
      restitution_(restitution),
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
    if (part.member.valid() ? frame.stands(part.member) : frame.stands(part.panel))
      obstacle_of_part_[number] = make(part, world);
    return true;
  });
}

collision::ObstacleId Obstacles::make(Part part, collision::World& world) {
  collision::ObstacleDescription description;
  const Bounds& bounds = shapes_.bounds(part);
  description.pose.position = (bounds.low + bounds.high) / 2;
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
}

void Obstacles::remove(Part part, collision::World& world) {
  collision::ObstacleId& obstacle = obstacle_of_part_[static_cast<std::size_t>(part_number(building_, part))];
  if (obstacle.value < 0) return;
  world.remove_obstacle(obstacle);
  part_of_obstacle_.erase(obstacle.value);
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
