#include "simulation/impact/asked_response.h"

#include <algorithm>

namespace topple::structure {

namespace {
bool same_touch(const collision::Contact& a, const collision::Contact& b) {
  return a.body == b.body && a.other.obstacle == b.other.obstacle;
}
}  // namespace

/// For who does not wait. Nobody has use for it any more.
void Simulation::State::finish_awaited() {
  if (!awaited) return;
  at_once([] {});
  awaited.reset();
}

/// The blow for which something was asked goes on where it stands, before all others.
void Simulation::State::take_up_awaited(std::vector<collision::Contact>& impacts) {
  if (!awaited || !frame->go_on()) return;
  for (const collision::Contact& one : awaited->contacts) {
    const auto found = std::find_if(impacts.begin(), impacts.end(),
                                    [&](const collision::Contact& other) { return same_touch(one, other); });
    if (found == impacts.end()) continue;
    found->point = one.point;
    found->normal = one.normal;
  }
  std::stable_partition(impacts.begin(), impacts.end(),
                        [&](const collision::Contact& one) { return one.body == awaited->contacts.front().body; });
}

/// Nothing: contact loads are being solved for.
Simulation::State::AskedResponse* Simulation::State::ask_for(const Asking& blow) {
  const bool same = awaited && std::equal(awaited->contacts.begin(), awaited->contacts.end(), blow.contacts.begin(),
                                          blow.contacts.end(), [](const auto& a, const auto* b) {
                                            return same_touch(a, *b) && a.point == b->point && a.normal == b->normal;
                                          });
  if (same) return awaited.get();
  awaited.reset();
  if (!frame->lay_loads()) return nullptr;
  awaited = std::make_unique<AskedResponse>();
  for (const collision::Contact* one : blow.contacts) awaited->contacts.push_back(*one);
  awaited->places.assign(blow.places.begin(), blow.places.end());
  awaited->normals.assign(blow.normals.begin(), blow.normals.end());
  return awaited.get();
}

/// Nothing: it is under way. So for the other.
const Simulation::State::AskedResponse* Simulation::State::near_response(const Asking& blow) {
  AskedResponse* known = ask_for(blow);
  if (known == nullptr || known->near) return known;
  const auto find = [this, known] {
    known->near = frame->respond_near(known->places, known->normals);
    known->critical_energy = unlimited;
    for (const ContactPlace& place : known->places)
      known->critical_energy = std::min(known->critical_energy, frame->critical_energy(place));
  };
  return frame->paced(find) ? known : nullptr;
}

const Simulation::State::AskedResponse* Simulation::State::full_response(const Asking& blow) {
  AskedResponse* known = ask_for(blow);
  if (known == nullptr || known->full) return known;
  return frame->paced([this, known] { known->full = frame->respond(known->places, known->normals); }) ? known : nullptr;
}

}  // namespace topple::structure
