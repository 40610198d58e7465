// Random buildings under random tools, saved at random moments.
#include <algorithm>
#include <catch2/catch.hpp>

#include "goes_on_alike.h"
#include "structure/random_collapse.h"
#include "topple/structure/error.h"

using namespace topple::structure;
using topple::test::goes_on_alike;
using topple::test::random_collapse;
using topple::test::RandomNumbers;

namespace {

void random_run_goes_on_alike(std::uint64_t number, StandingRule standing) {
  const auto make = [&] {
    auto [building, scenario] = random_collapse(number);
    scenario.standing = standing;
    scenario.duration = 6;
    scenario.until_rest = false;
    // The distance to the anchor may be rounded up beyond the cable.
    for (Event& event : scenario.events)
      if (auto* ball = std::get_if<WreckingBall>(&event.tool))
        ball->cable = std::max(ball->cable, (ball->from - ball->anchor).norm());
    return Simulation(std::move(building), std::move(scenario));
  };
  try {
    (void)make();
  } catch (const UnstableModel&) {
    return;  // it does not stand at the start
  }
  RandomNumbers random(number + 1);
  std::vector<double> moments;
  for (int i = 0; i < 3; ++i) moments.push_back(random.from(0, 5.5));
  std::sort(moments.begin(), moments.end());
  CAPTURE(number, moments);
  goes_on_alike({make, moments});
}

}  // namespace

TEST_CASE("states of random collapses at random moments go on alike, where what stands is at rest") {
  for (std::uint64_t number = 200; number < 216; ++number) random_run_goes_on_alike(number, StandingRule::statics);
}

TEST_CASE("states of random collapses at random moments go on alike, where what stands moves") {
  for (std::uint64_t number = 300; number < 316; ++number) random_run_goes_on_alike(number, StandingRule::dynamics);
}
