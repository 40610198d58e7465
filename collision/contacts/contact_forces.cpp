#include "contacts/contact_forces.h"

namespace topple::collision {

void ContactForces::forget(Touched::Kind kind, std::int64_t id) {
  std::erase_if(pairs_, [&](const Pair& pair) {
    return (pair.who.kind == kind && pair.who.other == id) || (kind == Touched::Kind::body && pair.who.body == id);
  });
}

}  // namespace topple::collision
