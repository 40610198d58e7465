#pragma once
// A contact of the last collision step that can break or load a part. Contacts of chunks of panels among themselves and
// with the ground, most of a heap, are left out. Its bodies may be gone since.
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

[[nodiscard]] inline bool is_recorded(const collision::Contact& contact) {
  const bool stands = contact.other.kind == collision::Touched::Kind::obstacle;
  const bool two = contact.other.kind == collision::Touched::Kind::body;
  return stands || contact.part_tag >= 0 || (two && contact.other.part_tag >= 0);
}

[[nodiscard]] inline ContactRecord record_of(const collision::Contact& contact) {
  return {contact.body,   contact.part_tag, contact.other,     contact.point,
          contact.normal, contact.impulse,  contact.persistent};
}

}  // namespace topple::structure
