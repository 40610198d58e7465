#include "simulation/impact/pressing_forces.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulation/debris/part.h"
#include "simulation/impact/impact_settings.h"

namespace topple::structure {

namespace {
/// N: below it a contact that is gone is forgotten.
constexpr double nothing = 1e-3;
}  // namespace

void PressingForces::gather(const ContactKey& key, const BodyPlace& place, const Vec3& force, const Vec3& point) {
  const Mat3 back = place.pose.orientation.toRotationMatrix().transpose();
  Pressing& own = pressing_[key];
  own.touches = true;
  if (own.lasted < impact_settings.landing_time) return;
  const double weight = force.norm();
  own.seen_force += back * force;
  own.seen_point += weight * (place.rest_centre + back * (point - place.pose.position));
  own.seen_weight += weight;
}

void PressingForces::read(std::span<const ContactRecord> contacts, double dt,
                          const std::function<std::optional<BodyPlace>(collision::BodyId)>& place_of) {
  for (const ContactRecord& contact : contacts) {
    const bool two = contact.other.kind == collision::Touched::Kind::body;
    const ContactKey key = key_of(contact);
    if (contact.part_tag >= 0)
      if (const auto place = place_of(contact.body)) gather(key, *place, -contact.impulse / dt, contact.point);
    if (two && contact.other.part_tag >= 0)
      if (const auto place = place_of(contact.other.body))
        gather({key.other, key.other_part, key.other_kind, key.body, key.part}, *place, contact.impulse / dt,
               contact.point);
  }
  // The exact decay over dt of an average with this time constant: two short steps are one long one.
  const double share = 1 - std::exp(-dt / impact_settings.pressing_time);
  for (auto entry = pressing_.begin(); entry != pressing_.end();) {
    Pressing& own = entry->second;
    const bool first = own.force.isZero(0);
    own.force += share * (own.seen_force - own.force);
    if (own.seen_weight > 0) {
      const Vec3 at = own.seen_point / own.seen_weight;
      own.point = first ? at : Vec3(own.point + share * (at - own.point));
    }
    // One that is new may have begun at any time of the step.
    own.lasted = !own.touches ? apart : own.lasted == apart ? 0 : own.lasted + dt;
    const bool gone = (!own.touches && own.force.norm() < nothing) || !place_of({entry->first.body});
    own.touches = false;
    own.seen_force.setZero();
    own.seen_point.setZero();
    own.seen_weight = 0;
    entry = gone ? pressing_.erase(entry) : std::next(entry);
  }
}

std::vector<FreePush> PressingForces::on(collision::BodyId body, const Building& building) const {
  std::vector<FreePush> pushes;
  const std::int64_t least = std::numeric_limits<std::int64_t>::min();
  for (auto entry = pressing_.lower_bound({body.value, least, least, least, least});
       entry != pressing_.end() && entry->first.body == body.value; ++entry) {
    const Part part = part_of_number(building, entry->first.part);
    pushes.push_back({part.member, part.panel, entry->second.point, entry->second.force});
  }
  return pushes;
}

double PressingForces::size(collision::BodyId body) const {
  double sum = 0;
  const std::int64_t least = std::numeric_limits<std::int64_t>::min();
  for (auto entry = pressing_.lower_bound({body.value, least, least, least, least});
       entry != pressing_.end() && entry->first.body == body.value; ++entry)
    sum += entry->second.force.norm();
  return sum;
}

}  // namespace topple::structure
