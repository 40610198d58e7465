// What is refused, and what stays as it was.
#include <catch2/catch.hpp>
#include <sstream>

#include "goes_on_alike.h"
#include "structure/ballistic_world.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"

using namespace topple::structure;
using topple::test::load;
using topple::test::seen_of;
using topple::test::state_of;

namespace {

Simulation wall(double duration = 2, const SimulationOptions& options = {}) {
  auto [building, scenario] = read_scenario(find_scenario("wall_hit"));
  scenario.duration = duration;
  return {std::move(building), std::move(scenario), options};
}

void run_to(Simulation& simulation, double time) {
  while (simulation.time() < time) simulation.step();
}

}  // namespace

TEST_CASE("a state of another scene is refused, and the simulation stays as it was") {
  Simulation one = wall();
  run_to(one, 0.8);
  const std::string seen = seen_of(one);
  auto [building, scenario] = read_scenario(find_scenario("wall_hit"));
  building.materials.front().youngs_modulus *= 1.001;
  const Simulation other(building, scenario);
  CHECK_THROWS_AS(load(one, state_of(other)), InputError);
  CHECK_THROWS_WITH(load(one, state_of(other)), Catch::Contains("of another scene"));
  CHECK(seen_of(one) == seen);
}

TEST_CASE("a state that is cut off anywhere is told, and the simulation stays as it was") {
  Simulation one = wall();
  run_to(one, 0.8);
  const std::string seen = seen_of(one), state = state_of(one);
  run_to(one, 1);
  const std::string later = seen_of(one);
  for (std::size_t i = 0; i < 60; ++i)
    CHECK_THROWS_AS(load(one, state.substr(0, i * state.size() / 60)), std::runtime_error);
  CHECK_THROWS_AS(load(one, state.substr(0, state.size() - 1)), std::runtime_error);
  CHECK(seen_of(one) == later);
  load(one, state);
  CHECK(seen_of(one) == seen);
}

TEST_CASE("a simulation that has gone on, or come to its end, is taken back by a state, and does it all again") {
  Simulation one = wall();
  run_to(one, 0.6);
  const std::string state = state_of(one);
  run_to(one, 2);
  const std::string end = seen_of(one);
  load(one, state);
  CHECK(one.time() < 0.7);
  CHECK(one.bodies().size() == 1);
  run_to(one, 2);
  CHECK(seen_of(one) == end);
}

TEST_CASE("listeners stay with who loads, and hear what happens from then on") {
  Simulation saved = wall(), loaded = wall();
  std::size_t heard = 0, heard_by_saved = 0;
  saved.on_event([&](const SimulationEvent&) { ++heard_by_saved; });
  loaded.on_event([&](const SimulationEvent&) { ++heard; });
  run_to(saved, 0.8);
  load(loaded, state_of(saved));
  CHECK(heard == 0);
  const std::size_t told = loaded.events().size();
  REQUIRE(told == heard_by_saved);
  run_to(loaded, 2);
  CHECK(loaded.events().size() > told);
  CHECK(heard == loaded.events().size() - told);
  CHECK(heard_by_saved == told);
}

TEST_CASE("poses that a host holds stay what they are when a state is loaded") {
  Simulation one = wall();
  run_to(one, 0.6);
  const std::string state = state_of(one);
  run_to(one, 1);
  const auto held = one.held_poses();
  const std::vector<double> before = *held;
  load(one, state);
  CHECK(*held == before);
  CHECK(one.poses().size() < before.size());
}

TEST_CASE("a run may be taken up to go on longer, and by more threads") {
  Simulation through = wall(3), saved = wall(1);
  run_to(through, 3);
  run_to(saved, 0.9);
  Simulation longer = wall(3, {2, {}});
  load(longer, state_of(saved));
  CHECK(!longer.finished());
  run_to(longer, 3);
  CHECK(longer.hash() == through.hash());
}

TEST_CASE("a host's own world that writes no state is told") {
  auto [building, scenario] = read_scenario(find_scenario("wall_hit"));
  const Simulation one(building, scenario, {1, [] { return std::make_unique<topple::test::BallisticWorld>(); }});
  std::ostringstream bytes;
  CHECK_THROWS_AS(one.save_state(bytes), std::logic_error);
}
