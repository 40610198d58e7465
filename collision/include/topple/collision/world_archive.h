#pragma once
// Archives of the plain structs of world.h, for the caller's own states: serialize() with the members of each, as
// archives in the manner of cereal call it. No header of theirs is needed here.
#include "topple/collision/world.h"

namespace topple::collision {

/// Members in order, all of them.
template <class Archive>
void serialize(Archive& archive, Pose& of) {
  auto& [position, orientation] = of;
  archive(position, orientation);
}
/// As Pose's.
template <class Archive>
void serialize(Archive& archive, BodyId& of) {
  auto& [value] = of;
  archive(value);
}
/// As Pose's.
template <class Archive>
void serialize(Archive& archive, ObstacleId& of) {
  auto& [value] = of;
  archive(value);
}
/// As Pose's.
template <class Archive>
void serialize(Archive& archive, HingeId& of) {
  auto& [value] = of;
  archive(value);
}
/// As Pose's.
template <class Archive>
void serialize(Archive& archive, CableId& of) {
  auto& [value] = of;
  archive(value);
}
/// As Pose's.
template <class Archive>
void serialize(Archive& archive, ConvexPart& of) {
  auto& [kind, pose, half_extents, points, tag] = of;
  archive(kind, pose, half_extents, points, tag);
}
/// As Pose's.
template <class Archive>
void serialize(Archive& archive, BodyDescription& of) {
  auto& [parts, mass, inertia, pose, velocity, angular_velocity, friction, restitution] = of;
  archive(parts, mass, inertia, pose, velocity, angular_velocity, friction, restitution);
}
/// As Pose's.
template <class Archive>
void serialize(Archive& archive, ObstacleDescription& of) {
  auto& [parts, pose, friction, restitution] = of;
  archive(parts, pose, friction, restitution);
}
/// As Pose's.
template <class Archive>
void serialize(Archive& archive, Touched& of) {
  auto& [kind, body, obstacle, part_tag] = of;
  archive(kind, body, obstacle, part_tag);
}
/// As Pose's.
template <class Archive>
void serialize(Archive& archive, Contact& of) {
  auto& [body, part_tag, other, point, normal, approach_speed, time, impulse, moment, work_lost, depth, thickness,
         persistent, corner_count, corners] = of;
  archive(body, part_tag, other, point, normal, approach_speed, time, impulse, moment, work_lost, depth, thickness,
          persistent, corner_count, corners);
}
/// As Pose's.
template <class Archive>
void serialize(Archive& archive, BodyState& of) {
  auto& [pose, velocity, angular_velocity, asleep] = of;
  archive(pose, velocity, angular_velocity, asleep);
}
/// As Pose's.
template <class Archive>
void serialize(Archive& archive, ObstacleMotion& of) {
  auto& [pose, velocity, angular_velocity, acceleration, angular_acceleration, last, angular_last, mass, inertia,
         mobility, held_anew] = of;
  archive(pose, velocity, angular_velocity, acceleration, angular_acceleration, last, angular_last, mass, inertia,
          mobility, held_anew);
}
/// As Pose's.
template <class Archive>
void serialize(Archive& archive, HingePull& of) {
  auto& [hinge, holder, point, impulse, moment] = of;
  archive(hinge, holder, point, impulse, moment);
}
/// As Pose's.
template <class Archive>
void serialize(Archive& archive, HingeDescription& of) {
  auto& [body, other, holder, point, held, axes] = of;
  archive(body, other, holder, point, held, axes);
}
/// As Pose's.
template <class Archive>
void serialize(Archive& archive, CableDescription& of) {
  auto& [body, anchor, length] = of;
  archive(body, anchor, length);
}
/// As Pose's.
template <class Archive>
void serialize(Archive& archive, CablePull& of) {
  auto& [tension, work_lost] = of;
  archive(tension, work_lost);
}

}  // namespace topple::collision
