#pragma once
// What a standing frame is told and tells, as bytes (solver/archive/state_archive.h).
#include "archive/id_archive.h"
#include "topple/structure/standing_frame.h"

namespace topple::structure {

template <class Archive>
void serialize(Archive& archive, JointCapacity& capacity) {
  auto& [value, interaction, ductility, breakable] = capacity;
  archive(value, interaction, ductility, breakable);
}

template <class Archive>
void serialize(Archive& archive, Utilisation& utilisation) {
  auto& [value, sense, demand, capacity] = utilisation;
  archive(value, sense, demand, capacity);
}

template <class Archive>
void serialize(Archive& archive, JointBreak& line) {
  auto& [joint, cause, sense, demand, capacity, generation, energy, position, inside] = line;
  archive(joint, cause, sense, demand, capacity, generation, energy, position, inside);
}

template <class Archive>
void serialize(Archive& archive, Detached::Motion& motion) {
  auto& [momentum, angular, displacement, turned] = motion;
  archive(momentum, angular, displacement, turned);
}

template <class Archive>
void serialize(Archive& archive, Detached& part) {
  auto& [members, panels, nodes, mechanism, hinges, cut, motion] = part;
  bool moved = motion.has_value();
  archive(members, panels, nodes, mechanism, hinges, cut, moved);
  // By hand: cereal makes what it loads in place, of nothing, which clang refuses for a struct within the class.
  if (moved && !motion) motion = Detached::Motion();
  if (!moved) motion.reset();
  if (moved) archive(*motion);
}

template <class Archive>
void serialize(Archive& archive, ContactPlace& place) {
  auto& [member, panel, point, node] = place;
  archive(member, panel, point, node);
}

template <class Archive>
void serialize(Archive& archive, ContactLoad& load) {
  auto& [key, place, force, moment] = load;
  archive(key, place, force, moment);
}

}  // namespace topple::structure
