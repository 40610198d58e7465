// What lands on debris does so by its whole impulse, at every step length; what lies there by its last moments.
#include "simulation/fracture/landing_impulses.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "simulation/impact/impact_settings.h"
#include "structure/landing_blow.h"

using namespace topple::structure;
using namespace topple::test;
namespace collision = topple::collision;

namespace {

ContactRecord on_ground(collision::BodyId body, std::int64_t part, double impulse) {
  ContactRecord contact;
  contact.body = body;
  contact.part_tag = part;
  contact.other.kind = collision::Touched::Kind::ground;
  contact.impulse = Vec3(0, 0, impulse);
  return contact;
}

}  // namespace

TEST_CASE("A panel that lands feels its whole blow, and what lies there as much as lasts, at every step length") {
  for (const double rate : {30, 60, 120, 240, 480, 1920}) {
    INFO("steps of 1/" << rate << " s");
    const double dt = 1 / rate, landing = impact_settings.landing_time;
    LandingImpulses impulses;
    double largest = 0, last = 0;
    bool lay = false;
    for (int step = 1; step <= std::lround(end * rate); ++step) {
      const ContactRecord contact = on_ground({7}, 0, impulse_until(step * dt) - impulse_until((step - 1) * dt));
      const bool touches = step * dt > lands_at;
      const std::vector<ContactRecord> read = impulses.read(std::span(&contact, touches ? 1 : 0), dt);
      REQUIRE(read.size() == (touches ? 1 : 0));
      if (!touches) continue;
      last = read.front().impulse.z();
      lay = lay || read.front().persistent;
      CHECK(read.front().persistent == lay);
      if (!lay) largest = std::max(largest, last);
    }
    // With what it weighs meanwhile.
    CHECK(largest >= blow * taken_within);
    CHECK(largest <= blow * taken_within + weight * (landing + dt));
    CHECK(lay);
    CHECK(last == Approx(weight * landing).epsilon(1e-6));
  }
}

TEST_CASE("A blow that broke something is spent, and parts are told apart") {
  const double dt = impact_settings.landing_time / 4;
  LandingImpulses impulses;
  const collision::BodyId body{7};
  const std::vector<ContactRecord> contacts = {on_ground(body, 0, 100), on_ground(body, 3, 50)};
  (void)impulses.read(contacts, dt);
  std::vector<ContactRecord> read = impulses.read(contacts, dt);
  CHECK(read[0].impulse.z() == Approx(200));
  CHECK(read[1].impulse.z() == Approx(100));
  impulses.spend(body, 0);
  read = impulses.read(contacts, dt);
  CHECK(read[0].impulse.z() == Approx(100));
  CHECK(read[1].impulse.z() == Approx(150));
  // Parted and met again: a new one.
  (void)impulses.read({}, dt);
  CHECK(impulses.read(contacts, dt)[1].impulse.z() == Approx(50));
}
