#pragma once
// What a contact did in the last collision step, of those that somebody feels: parts that can break or be loaded.
// Pieces of panels among themselves and on the ground, most of a heap, are left out. Bodies may be gone since.
#include "topple/collision/world.h"
#include "topple/structure/building.h"

namespace topple::structure {

/// As in collision::Contact.
struct ContactRecord {
  collision::BodyId body;
  std::int64_t part_tag = -1;
  collision::Touched other;
  Vec3 point, normal, impulse;
  bool persistent = false;
};

[[nodiscard]] inline bool is_felt(const collision::Contact& contact) {
  const bool stands = contact.other.kind == collision::Touched::Kind::obstacle;
  const bool two = contact.other.kind == collision::Touched::Kind::body;
  return stands || contact.part_tag >= 0 || (two && contact.other.part_tag >= 0);
}

[[nodiscard]] inline ContactRecord felt(const collision::Contact& contact) {
  return {contact.body,   contact.part_tag, contact.other,     contact.point,
          contact.normal, contact.impulse,  contact.persistent};
}

}  // namespace topple::structure
