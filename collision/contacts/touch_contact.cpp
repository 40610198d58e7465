#include "contacts/touch_contact.h"

#include <utility>

namespace topple::collision {

Contact contact_of(const Solid& body, std::int64_t tag, const Solid& other, std::int64_t other_tag,
                   const Touch& touch) {
  Contact contact;
  contact.body.value = body.id;
  contact.part_tag = tag;
  contact.other = touched(other, other_tag);
  contact.point = from_bullet(touch.point);
  contact.normal = from_bullet(touch.normal);
  contact.approach_speed = touch.approach_speed;
  contact.time = touch.time;
  contact.corner_count = touch.corner_count;
  for (int i = 0; i < touch.corner_count; ++i)
    contact.corners[static_cast<std::size_t>(i)] = from_bullet(touch.corners[i]);
  return contact;
}

void put_lower_first(Contact& contact) {
  if (contact.other.kind != Touched::Kind::body || contact.body < contact.other.body) return;
  std::swap(contact.body, contact.other.body);
  std::swap(contact.part_tag, contact.other.part_tag);
  contact.normal = -contact.normal;
}

}  // namespace topple::collision
