#pragma once
// First touches (first_touch.h) as contacts.
#include "contacts/contact_order.h"
#include "contacts/first_touch.h"

namespace topple::collision {

/// Of parts with the tags `tag` and `other_tag` (-1: the ground).
[[nodiscard]] Contact contact_of(const Solid& body, std::int64_t tag, const Solid& other, std::int64_t other_tag,
                                 const Touch& touch);
/// The body with the lower id comes first: turns the contact round when that is the other one.
void put_lower_first(Contact& contact);

}  // namespace topple::collision
