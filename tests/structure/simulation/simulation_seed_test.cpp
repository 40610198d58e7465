// The shipped seed building: it stands exactly while nobody touches it, and falls where it is hit.
#include <catch2/catch.hpp>
#include <cmath>

#include "structure/simulation_run.h"
#include "topple/structure/collapse_report.h"
#include "topple/structure/formats/files.h"

using namespace topple::structure;

namespace {

Simulation shipped(const char* name, double duration, StandingRule standing = StandingRule::dynamics,
                   double strength = 1) {
  auto [building, scenario] = read_scenario(find_scenario(name));
  scenario.standing = standing;
  scenario.duration = duration;
  for (Joint& joint : building.joints)
    for (double& value : joint.capacity.value) value *= strength;
  return Simulation(std::move(building), std::move(scenario));
}

}  // namespace

TEST_CASE("the seed building stands for a minute without a solve, a segmentation or a collision step") {
  Simulation simulation = shipped("seed_idle", 60);
  simulation.step();
  const SimulationCounters first = simulation.counters();
  const std::uint64_t hash = simulation.hash();
  while (!simulation.finished()) simulation.step();
  const SimulationCounters last = simulation.counters();
  CHECK(simulation.steps() == 3600);
  CHECK(collapse_counts(simulation).joints_broken == 0);
  CHECK(last.solves == first.solves);
  CHECK(last.segmentations == first.segmentations);
  CHECK(last.collision_steps == 0);
  CHECK(last.steps_idle == 3599);
  CHECK(simulation.hash() == hash);
  const double sag = simulation.frame().roof_sag();
  CHECK(sag > 1e-3);  // millimetres, where sequential impulses give 0.8 m
  CHECK(sag < 2e-2);
}

TEST_CASE("strong joints sag to the bit like weak ones") {
  Simulation weak = shipped("seed_idle", 1), strong = shipped("seed_idle", 1, StandingRule::dynamics, 1e6);
  for (Simulation* simulation : {&weak, &strong}) simulation->step();
  CHECK(weak.hash() == strong.hash());
}

TEST_CASE("a hit on the corner post brings down what it carried, the same in every run", "[collapse]") {
  const StandingRule standing = GENERATE(StandingRule::statics, StandingRule::dynamics);
  const bool at_rest = standing == StandingRule::statics;
  std::uint64_t hashes[2];
  for (std::uint64_t& hash : hashes) {
    Simulation simulation = shipped("seed_hit", at_rest ? 6 : 4, standing);
    double freed = 0;
    const auto run_until = [&](double time) {
      while (!simulation.finished() && simulation.time() < time) {
        simulation.skip_idle();
        simulation.step();
        // A structure that is let go of at rest never takes energy up, whatever came to lie on it, or left it, on the
        // way. In motion what pushes it does work until the joint fails.
        const double now = simulation.frame().energy().freed;
        if (at_rest) CHECK(now > freed - 1e-6);
        freed = now;
      }
    };
    run_until(2);  // the shot at 1 s took the corner and what stands behind it
    const CollapseCounts first = collapse_counts(simulation);
    CHECK(first.members_down >= 6);
    // In motion 89 to 213 of 306 in 36 runs whose shot was moved by up to 0.1 m.
    CHECK(first.members_down < (at_rest ? 40 : 250));
    // In motion a post may be left to stand by itself, in some runs and not in others.
    CHECK(first.standing_segments >= 1);
    CHECK(first.standing_segments <= (at_rest ? 1 : 4));
    run_until(simulation.scenario().duration);
    hash = simulation.hash();
    CHECK(collapse_counts(simulation).members_down > first.members_down);  // slabs of 26 t sweep the posts beside them
    for (const BodyView& body : simulation.bodies()) {
      CHECK(body.pose.position.allFinite());
      CHECK(body.pose.position.z() > -0.5);  // nothing sinks into the ground: no part is thicker than a metre
    }
    const Ledger& ledger = simulation.ledger();
    CHECK(std::abs(ledger.residual()) < (at_rest ? 0.01 : 1e-6));  // what the default step may leave open
    CHECK(ledger.momentum_error < 1e-10);
  }
  CHECK(hashes[0] == hashes[1]);
}

// Beams, slabs and posts of the lowest floor lie at heights of their own: at 8 m/s they land within one step of 1/60 s,
// and in three of 1/240 s. What lands on the pieces of what broke before must be judged alike.
TEST_CASE("a tower that drops by a storey breaks up alike whether its parts land within one step or in several") {
  const auto broken_at = [](double step, double until) {
    auto [building, scenario] = read_scenario(find_scenario("tower_charges"));
    RemoveTool charges;
    for (std::uint32_t k = 0; k < building.members.size(); ++k)
      if (const MemberId member{k}; building[member].name.starts_with("P-") && building[member].name.ends_with("-1"))
        charges.members.push_back(member);
    CHECK(charges.members.size() == 9);
    scenario.events = {{0, charges}};
    scenario.step = step;
    scenario.duration = until;
    Simulation simulation(std::move(building), std::move(scenario));
    topple::test::run(simulation);
    return collapse_counts(simulation).joints_broken;
  };
  // The lowest beams hang 3.335 m above the ground.
  const double lands = std::sqrt(2 * 3.335 / 9.81);
  CHECK(broken_at(1.0 / 60, lands - 0.02) == 0);
  const auto coarse = broken_at(1.0 / 60, lands + 0.02), fine = broken_at(1.0 / 240, lands + 0.02);
  CHECK(coarse > 100);  // its beams are sheared off at every floor, not at the lowest alone
  CHECK(coarse == fine);
}
