// What stands and has moved is met where it is.
#include <catch2/catch.hpp>
#include <cmath>

#include "structure/frame_builder.h"
#include "structure/simulation_run.h"
#include "topple/structure/simulation.h"

namespace {

using namespace topple::test;

constexpr double spring = 1e6;  // N/m, along each axis, under either end

/// A beam of 6 m and 0.2 m by 0.2 m along x, on springs at both ends, which turn nowhere.
FrameBuilder beam_on_springs() {
  FrameBuilder frame;
  const NodeId a = frame.node("A", 0, 0, 4), b = frame.node("B", 6, 0, 4);
  frame.member("beam", MemberKind::beam, a, b, same_capacity(unlimited), same_capacity(unlimited));
  for (const NodeId node : {a, b}) {
    frame.support(node);
    frame.building.supports.back().stiffness.head<3>().setConstant(spring);
  }
  frame.self_weight(7850);
  return frame;
}

/// The ends go by this way, m, after 0.05 s; a ball of 0.15 m begins there, at that speed, a second later.
Scenario moved_and_met(const Vec3& way, const Vec3& from, const Vec3& velocity, double step) {
  Scenario scenario;
  scenario.combination = CombinationId(0u);
  scenario.standing = StandingRule::dynamics;
  scenario.step = step;
  scenario.duration = 20;
  scenario.ground = 0;
  scenario.failure.bracing = BracingRule::none;
  LoadTool push;
  Vec6 load = Vec6::Zero();
  load.head<3>() = spring * way;
  push.nodes = {{NodeId(0u), load}, {NodeId(1u), load}};
  Projectile ball;
  ball.radius = 0.15;
  ball.mass = 20;
  ball.from = from;
  ball.velocity = velocity;
  scenario.events = {{0.05, push}, {8, ball}};
  return scenario;
}

}  // namespace

TEST_CASE("A ball comes to lie on a beam that has sunk, where the beam is") {
  for (const double step : {1.0 / 30, 1.0 / 120}) {
    const Scenario scenario = moved_and_met(Vec3(0, 0, -0.12), Vec3(3, 0, 4.3), Vec3(0, 0, -0.1), step);
    Simulation simulation(beam_on_springs().building, scenario);
    run(simulation);
    REQUIRE(simulation.bodies().size() == 1);
    CHECK(simulation.at_rest());
    const double sunk = -simulation.frame().displacement(NodeId(0u)).z();
    CHECK(sunk > 0.12);
    // Within 0.01 m, by which it may be off before its shape follows, and what contacts give.
    CHECK(simulation.bodies()[0].pose.position.z() == Approx(4 - sunk + 0.1 + 0.15).margin(0.012));
  }
}

TEST_CASE("A beam that has moved aside is missed where it was and hit where it is") {
  for (const auto& [y, hit] : {std::pair(0.0, false), std::pair(0.5, true)}) {
    const Scenario scenario = moved_and_met(Vec3(0, 0.5, 0), Vec3(3, y, 6), Vec3(0, 0, -8), 1.0 / 60);
    Simulation simulation(beam_on_springs().building, scenario);
    while (!simulation.finished() && simulation.time() < 8.4) simulation.step();
    INFO("at " << y);
    CHECK(of_kind(simulation, SimulationEvent::Kind::impact).empty() != hit);
    REQUIRE(simulation.bodies().size() == 1);
    CHECK((simulation.bodies()[0].pose.position.z() > 3.5) == hit);
  }
}

TEST_CASE("A weight laid on a beam on springs sways with it as one mass, at every step, and the ledger balances") {
  const double weight = 2000, stiffness = 2 * spring;
  for (const double step : {1.0 / 30, 1.0 / 60, 1.0 / 240}) {
    INFO("step " << step);
    const double own = 7850 * 0.04 * 6, sunk = 10 * own / stiffness;
    Scenario scenario = moved_and_met(Vec3::Zero(), Vec3(3, 0, 4.2501 - sunk), Vec3::Zero(), step);
    Projectile& ball = std::get<Projectile>(scenario.events[1].tool);
    ball.mass = weight;
    scenario.events = {{0.0, ball}};
    scenario.duration = 1;
    Simulation simulation(beam_on_springs().building, scenario);
    const double start = simulation.frame().displacement(NodeId(0u)).z();
    double lowest = 0, at = 0, apart = 0;
    while (!simulation.finished()) {
      simulation.step();
      const double down = simulation.frame().displacement(NodeId(0u)).z() - start;
      if (down < lowest) {
        lowest = down;
        at = simulation.time();
      }
      const double lies = simulation.bodies()[0].pose.position.z() - 4.25;
      if (simulation.time() > 0.1) apart = std::max(apart, std::abs(lies - start - down));
    }
    const double sag = weight * 10 / stiffness, period = 2 * M_PI * std::sqrt((weight + own) / stiffness);
    // 2 % of damping leave 1.94 of the 2; the load needs a substep to be there, and the step may pass over the lowest.
    CHECK(lowest == Approx(-1.94 * sag).epsilon(0.03));
    CHECK(at == Approx(period / 2).margin(0.6 * step + 0.01));
    CHECK(apart < 0.004);
    CHECK(std::abs(simulation.ledger().residual()) < 1e-6);
  }
}
