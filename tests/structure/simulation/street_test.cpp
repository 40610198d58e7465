// A street of twenty houses, one of them hit, against that house alone.
#include <catch2/catch.hpp>

#include "simulation_run.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/simulation.h"

using namespace topple::structure;
using topple::test::of_kind;

namespace {

struct Effort {
  std::uint64_t solves = 0, low_rank = 0, refactorisations = 0, collision_steps = 0, segmentations = 0;
  std::uint64_t vertices_searched = 0;
  std::size_t broken = 0;
};

/// Of what follows the first step, in which everything is solved once.
Effort after_the_first_step(const char* name, double seconds) {
  auto [building, scenario] = read_scenario(find_scenario(name));
  scenario.duration = seconds;
  Simulation simulation(std::move(building), std::move(scenario));
  simulation.step();
  const SimulationCounters first = simulation.counters();
  const FrameCounters standing = simulation.frame().counters();
  topple::test::run(simulation);
  const SimulationCounters last = simulation.counters();
  Effort effort;
  effort.solves = last.solves - first.solves;
  effort.low_rank = last.low_rank - first.low_rank;
  effort.refactorisations = last.refactorisations - first.refactorisations;
  effort.collision_steps = last.collision_steps - first.collision_steps;
  effort.segmentations = last.segmentations - first.segmentations;
  effort.vertices_searched = simulation.frame().counters().vertices_searched - standing.vertices_searched;
  effort.broken = of_kind(simulation, SimulationEvent::Kind::joint_broke).size();
  return effort;
}

}  // namespace

TEST_CASE("of twenty houses only the one that is hit costs anything") {
  const double seconds = 2;  // before the ball comes to the next house
  const Effort street = after_the_first_step("street_hit", seconds), house = after_the_first_step("house_hit", seconds);
  REQUIRE(house.broken > 5);
  REQUIRE(house.solves > 0);
  // The same house, numbered otherwise: its collapse is the same but for rounding in the order of sums.
  CHECK(street.broken == house.broken);
  CHECK(street.solves <= house.solves + house.solves / 10);
  CHECK(street.segmentations <= house.segmentations + house.segmentations / 10);
  CHECK(street.vertices_searched <= house.vertices_searched + house.vertices_searched / 10);
  CHECK(street.collision_steps == house.collision_steps);
}
