// What lies on debris presses on it by its average in time; what lands on it does not.
#include "simulation/impact/pressing_forces.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "simulation/impact/impact_settings.h"
#include "structure/landing_blow.h"

using namespace topple::structure;
using namespace topple::test;
namespace collision = topple::collision;

TEST_CASE("What lands presses on debris with its weight alone, at every step length") {
  for (const double rate : {30, 60, 120, 240, 480}) {
    const double dt = 1 / rate;
    PressingForces pressing;
    const collision::BodyId body{7};
    const auto here = [&](collision::BodyId) { return std::optional<BodyPlace>(BodyPlace{}); };
    double largest = 0;
    for (int step = 1; step <= std::lround(end * rate); ++step) {
      ContactRecord contact;
      contact.body = body;
      contact.part_tag = 0;
      contact.other.kind = collision::Touched::Kind::ground;
      contact.impulse = Vec3(0, 0, impulse_until(step * dt) - impulse_until((step - 1) * dt));
      const bool touches = step * dt > lands_at;
      pressing.read(std::span(&contact, touches ? 1 : 0), dt, here);
      largest = std::max(largest, pressing.size(body));
    }
    INFO("steps of 1/" << rate << " s");
    CHECK(largest < weight);  // the blow alone would be 4 times that, averaged
    // It counts from the first step that begins for sure so long after they met.
    const auto pressed_since = [](double time) {
      return weight * (1 - std::exp(-time / impact_settings.pressing_time));
    };
    const double counted = end - lands_at - impact_settings.landing_time;
    CHECK(pressing.size(body) <= Approx(pressed_since(counted)).epsilon(1e-12));
    CHECK(pressing.size(body) >= Approx(pressed_since(counted - 2 * dt)).epsilon(1e-12));
  }
}
