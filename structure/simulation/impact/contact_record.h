#pragma once
// A contact of the last collision step that can break or load a part. Contacts of chunks of panels among themselves and
// with the ground, most of a heap, are left out. Its bodies may be gone since.
#include <compare>

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

/// Which part of a body touches what: the same from step to step.
struct ContactKey {
  std::int64_t body, part, other_kind, other, other_part;
  auto operator<=>(const ContactKey&) const = default;
};
template <class Archive>
void serialize(Archive& archive, ContactKey& key) {
  auto& [body, part, other_kind, other, other_part] = key;
  archive(body, part, other_kind, other, other_part);
}
[[nodiscard]] inline ContactKey key_of(const ContactRecord& contact) {
  const bool two = contact.other.kind == collision::Touched::Kind::body;
  return {contact.body.value, contact.part_tag, static_cast<std::int64_t>(contact.other.kind),
          two ? contact.other.body.value : contact.other.obstacle.value, contact.other.part_tag};
}

}  // namespace topple::structure
