#include "simulation/fracture/landing_impulses.h"

#include <algorithm>
#include <cmath>

#include "simulation/impact/impact_settings.h"

namespace topple::structure {

std::vector<ContactRecord> LandingImpulses::read(std::span<const ContactRecord> contacts, double dt) {
  const double time = impact_settings.landing_time, stays = std::exp(-dt / time);
  std::vector<ContactRecord> read(contacts.begin(), contacts.end());
  for (ContactRecord& contact : read) {
    Landing& own = landings_[key_of(contact)];
    own.touches = true;
    contact.persistent = own.lasted >= time;
    if (contact.persistent)  // the exact course under a mean force: two short steps are one long one
      own.impulse = stays * own.impulse + (1 - stays) * time / dt * contact.impulse;
    else  // one that is new may have begun at any time of the step
      own.impulse += (own.lasted == apart ? 1 : std::min(1.0, (time - own.lasted) / dt)) * contact.impulse;
    contact.impulse = own.impulse;
  }
  for (auto entry = landings_.begin(); entry != landings_.end();) {
    Landing& own = entry->second;
    const bool gone = !own.touches;
    own.lasted = own.lasted == apart ? 0 : own.lasted + dt;
    own.touches = false;
    entry = gone ? landings_.erase(entry) : std::next(entry);
  }
  return read;
}

void LandingImpulses::spend(collision::BodyId body, std::int64_t part) {
  constexpr auto of_body = static_cast<std::int64_t>(collision::Touched::Kind::body);
  for (auto& [key, own] : landings_)
    if ((key.body == body.value && key.part == part) ||
        (key.other_kind == of_body && key.other == body.value && key.other_part == part))
      own.impulse.setZero();
}

}  // namespace topple::structure
