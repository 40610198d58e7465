// Floors that fall on floors, where what stands moves: each landing shares momentum without rebound, and between two of
// them all falls freely (the recursion of Z. P. Bazant and Y. Zhou, J. Engng Mech. 128 (2002), with weak supports).
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "structure/frame_builder.h"
#include "structure/simulation_run.h"
#include "topple/collision/small_steps.h"
#include "topple/structure/simulation.h"

namespace {

using namespace topple::test;

constexpr int floors = 8;
constexpr double storey = 3, span = 6, depth = 0.2, density = 5000;

/// One beam above the other, each on two supports that bear ten times its weight.
FrameBuilder stack_of_floors() {
  FrameBuilder frame;
  frame.self_weight(density);
  JointCapacity joint = same_capacity(unlimited);
  for (std::size_t sense = 0; sense < 4; ++sense) joint.value[sense] = 10 * density * 0.04 * span * 10 / 2;
  for (int k = floors; k >= 1; --k) {
    const std::string name = std::to_string(k);
    const NodeId first = frame.node("A" + name, 0, 0, k * storey), second = frame.node("B" + name, span, 0, k * storey);
    frame.support(first);
    frame.support(second);
    (void)frame.member("F" + name, MemberKind::beam, first, second, joint, joint);
  }
  return frame;
}

/// s. n floors come down on the next: v^2 grows by 2 g times the clear height, and becomes n/(n + 1) of itself.
std::vector<double> recursion() {
  std::vector<double> landings;
  double time = 0, speed = 0;
  for (int n = 1; n < floors; ++n) {
    const double lands = std::sqrt(speed * speed + 2 * 10 * (storey - depth));
    time += (lands - speed) / 10;
    landings.push_back(time);
    speed = lands * n / (n + 1);
  }
  return landings;
}

}  // namespace

TEST_CASE("Floors that fall on floors land when the recursion has it") {
  const std::vector<double> expected = recursion();
  for (const double step : {1.0 / 60, 1.0 / 120}) {
    const FrameBuilder frame = stack_of_floors();
    Scenario scenario;
    scenario.combination = CombinationId(0u);
    scenario.standing = StandingRule::dynamics;
    scenario.step = step;
    scenario.duration = 3.2;
    scenario.ground = -100.0;
    scenario.failure.bracing = BracingRule::none;
    scenario.impact.restitution = scenario.debris.restitution = 0;
    CutTool cut;
    cut.joints = {JointId(0u), JointId(1u)};
    scenario.events = {{0, cut}};
    Simulation simulation(frame.building, scenario, {1, [] { return topple::collision::make_small_steps_world(); }});
    run(simulation);
    std::vector<double> landings;
    for (int k = floors - 1; k >= 1; --k)
      for (const SimulationEvent& event : of_kind(simulation, SimulationEvent::Kind::impact))
        if (event.name == "F" + std::to_string(k)) {
          landings.push_back(event.time);
          break;
        }
    REQUIRE(landings.size() == expected.size());
    for (std::size_t n = 0; n < expected.size(); ++n) {
      INFO("step 1/" << 1 / step << ", landing " << n + 1 << ": " << landings[n] << " s; recursion " << expected[n]
                     << " s");
      // An event is told at the end of its step. A stack of several shares its momentum over some steps, and one joint
      // of a floor breaks before the other, so that it turns (which is why the speed of the place that touches first is
      // not looked at): 2.1 % of the time as measured.
      CHECK(landings[n] > expected[n] * 0.98);
      CHECK(landings[n] - step < expected[n] * 1.025);
    }
    CHECK(simulation.ledger().momentum_error < 1e-10);
    CHECK(std::abs(simulation.ledger().residual()) < 5e-3);
  }
}
