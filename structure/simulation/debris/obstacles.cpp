#include "simulation/debris/obstacles.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>

#include "model/point_inertia.h"
#include "simulation/debris/debris_settings.h"

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
    if (part.member.valid() ? frame.stands(part.member) : frame.stands(part.panel)) {
      obstacle_of_part_[number] = make(part, world);
      if (reach_ > debris_settings.follow) {
        shifted_[number] = shift_of(part, frame);
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

/// Of the rigid motions the one nearest to those of its nodes that stand.
Obstacles::Shift Obstacles::shift_of(Part part, const StandingFrame& frame) const {
  std::vector<NodeId> nodes;
  const auto take = [&](const auto& all) {
    for (const NodeId node : all)
      if (frame.stands(node)) nodes.push_back(node);
  };
  part.member.valid() ? take(building_[part.member].nodes) : take(building_[part.panel].nodes);
  Shift shift;
  if (nodes.empty()) return shift;
  const auto count = static_cast<double>(nodes.size());
  Vec3 centre = Vec3::Zero();
  for (const NodeId node : nodes) {
    const Vec6& u = frame.displacement(node);
    centre += building_[node].position / count;
    shift.moved += u.head<3>() / count;
    shift.turned += u.tail<3>() / count;
  }
  // Where its nodes' places tell of a turn, that counts; about a line of them their rotations do.
  Mat3 spread = Mat3::Zero();
  Vec3 turning = Vec3::Zero();
  for (const NodeId node : nodes) {
    const Vec3 r = building_[node].position - centre;
    spread += point_inertia(1, r);
    turning += r.cross(Vec3(frame.displacement(node).head<3>() - shift.moved));
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(spread);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    constexpr double on_a_line = 1e-6;
    if (!(axes.eigenvalues()(axis) > on_a_line * axes.eigenvalues()(2))) continue;
    const Vec3 along = axes.eigenvectors().col(axis);
    shift.turned += (along.dot(turning) / axes.eigenvalues()(axis) - along.dot(shift.turned)) * along;
  }
  shift.moved += shift.turned.cross(middle(part) - centre);
  return shift;
}

void Obstacles::put(std::size_t number, collision::World& world) const {
  const auto found = shifted_.find(number);
  if (found == shifted_.end()) return;
  collision::Pose pose;
  pose.position = middle(part_of_number(building_, static_cast<std::int64_t>(number))) + found->second.moved;
  const double angle = found->second.turned.norm();
  if (angle > 0) pose.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(angle, found->second.turned / angle));
  world.move_obstacle(obstacle_of_part_[number], pose);
}

void Obstacles::follow(const StandingFrame& frame, collision::World& world) {
  reach_ = 0;
  for (std::size_t n = 0; n < building_.nodes.size(); ++n)
    if (frame.stands(NodeId(n))) reach_ = std::max(reach_, frame.displacement(NodeId(n)).head<3>().norm());
  if (!(reach_ > debris_settings.follow) && shifted_.empty()) return;
  for (const auto& [id, part] : part_of_obstacle_) {
    const auto number = static_cast<std::size_t>(part_number(building_, part));
    if (obstacle_of_part_[number].value != id) continue;  // a shape that it had
    const Shift now = shift_of(part, frame);
    const auto found = shifted_.find(number);
    const Shift before = found == shifted_.end() ? Shift() : found->second;
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
