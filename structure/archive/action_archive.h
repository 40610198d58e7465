#pragma once
// What a host or a scenario does to a simulation, as bytes (solver/archive/state_archive.h).
#include <cstdint>

#include "archive/frame_archive.h"
#include "topple/collision/world_archive.h"
#include "topple/structure/host_contact.h"
#include "topple/structure/snapshot.h"

namespace topple::structure {

template <class Archive>
void serialize(Archive& archive, Projectile& projectile) {
  auto& [from, velocity, mass, radius] = projectile;
  archive(from, velocity, mass, radius);
}
template <class Archive>
void serialize(Archive& archive, WreckingBall& ball) {
  auto& [anchor, from, cable, mass, radius] = ball;
  archive(anchor, from, cable, mass, radius);
}
template <class Archive>
void serialize(Archive& archive, CutTool& cut) {
  auto& [joints] = cut;
  archive(joints);
}
template <class Archive>
void serialize(Archive& archive, RemoveTool& remove) {
  auto& [members, panels, supports] = remove;
  archive(members, panels, supports);
}
template <class Archive>
void serialize(Archive& archive, ChargeTool& charge) {
  auto& [centre, radius, strength_at_centre, strength_at_radius] = charge;
  archive(centre, radius, strength_at_centre, strength_at_radius);
}
template <class Archive>
void serialize(Archive& archive, WeakenTool& weaken) {
  auto& [joints, members, strength, stiffness, over, stages] = weaken;
  archive(joints, members, strength, stiffness, over, stages);
}
template <class Archive>
void serialize(Archive& archive, GravityTool& tool) {
  auto& [gravity] = tool;
  archive(gravity);
}
/// The loads one by one: NodeLoad's member `load` passes for cereal's function of that name.
template <class Archive>
void serialize(Archive& archive, LoadTool& tool) {
  auto& [nodes] = tool;
  std::uint64_t count = nodes.size();
  archive(count);
  nodes.resize(count);
  for (auto& [node, force] : nodes) archive(node, force);
}

template <class Archive>
void serialize(Archive& archive, HostContact& contact) {
  auto& [key, member, panel, body, point, normal, mass, inertia, centre, velocity, angular_velocity] = contact;
  archive(key, member, panel, body, point, normal, mass, inertia, centre, velocity, angular_velocity);
}
template <class Archive>
void serialize(Archive& archive, HostImpulse& felt) {
  auto& [key, impulse, speed_in, speed_out, through] = felt;
  archive(key, impulse, speed_in, speed_out, through);
}
template <class Archive>
void serialize(Archive& archive, CapacityChange& change) {
  auto& [joints] = change;
  archive(joints);
}
template <class Archive>
void serialize(Archive& archive, Snapshot::Action& action) {
  auto& [step, what] = action;
  archive(step, what);
}

}  // namespace topple::structure
