// A mass strikes bars whose joints yield, against the closed form of an elastic-plastic spring and integrations written
// out here: joints that yield hold their capacity, dissipate it times their turn, and break when they have turned too
// far.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "structure/ballistic_world.h"
#include "structure/frame_builder.h"
#include "structure/simulation_run.h"
#include "structure/struck_post.h"
#include "topple/structure/simulation.h"

namespace {

using namespace topple::test;

constexpr double height = 3, E = 200e9, I = 2e-4, A = 0.04, density = 7850, mass = 300, capacity = 4e5;
const double squeeze = std::sqrt(A) / (E * A);  // m/N, of the section itself
/// Where the ends of a post that is built in come to their capacity under a push at mid-height.
constexpr double yields_at = 8 * capacity / height;
const double elastic = height * height * height / (192 * E * I) + squeeze;
const double hinged = height * height * height / (48 * E * I) + squeeze;

JointCapacity joint_of(double limit, double moment = capacity) {
  JointCapacity joint = same_capacity(unlimited);
  joint.value[5] = moment;
  joint.ductility[5] = limit;
  return joint;
}

/// A post built in at both ends, and a stub at its head: something must be able to move.
FrameBuilder built_in(const JointCapacity& joint) {
  FrameBuilder frame;
  const NodeId foot = frame.node("F", 0, 0, 0), head = frame.node("H", 0, 0, height),
               free = frame.node("S", 0, 2, height);
  frame.member("post", MemberKind::post, foot, head, joint, joint);
  frame.member("stub", MemberKind::beam, head, free, same_capacity(unlimited), same_capacity(unlimited));
  frame.support(foot);
  frame.support(head);
  frame.self_weight(density);
  return frame;
}

Simulation strike(const Building& building, double speed, double restitution = 0, double step = 1.0 / 60,
                  double duration = 0.1) {
  Scenario scenario = struck_post(height / 2, speed, mass, step, duration);
  scenario.impact.restitution = restitution;
  return {building, scenario, {1, [] { return std::make_unique<BallisticWorld>(); }}};
}

/// The push against two springs in turn, by energy.
struct ClosedForm {
  double peak = 0, turn = 0;  ///< N, rad of each end
};
ClosedForm closed_form(double speed) {
  const double energy = mass * speed * speed / 2, at_yield = yields_at * yields_at * elastic / 2;
  if (energy <= at_yield) return {std::sqrt(2 * energy / elastic), 0};
  // yields_at d + d^2/(2 hinged) = energy - at_yield
  const double d = hinged * (std::sqrt(yields_at * yields_at + 2 * (energy - at_yield) / hinged) - yields_at);
  const double peak = yields_at + d / hinged;
  return {peak, (peak - yields_at) * height * height / (16 * E * I)};
}

}  // namespace

TEST_CASE("A mass that strikes a post with ductile ends: peak, plastic rotations and work of the closed form") {
  for (const double speed : {3.0, 5.0, 8.0}) {
    for (const double step : {1.0 / 30, 1.0 / 240}) {
      Simulation simulation = strike(built_in(joint_of(0.1)).building, speed, 0, step);
      run(simulation);
      const ClosedForm exact = closed_form(speed);
      const auto impacts = of_kind(simulation, SimulationEvent::Kind::impact);
      REQUIRE(impacts.size() == 1);
      INFO("speed " << speed << ": peak " << impacts[0].peak_force << " against " << exact.peak << ", turn "
                    << exact.turn);
      CHECK(impacts[0].peak_force == Approx(exact.peak).epsilon(1e-4));
      CHECK(of_kind(simulation, SimulationEvent::Kind::joint_broke).empty());
      const auto turned = simulation.frame().plastic_rotations();
      REQUIRE(turned.size() == (exact.turn > 0 ? 2 : 0));
      double sum = 0;
      for (const PlasticRotation& one : turned) {
        CHECK(std::abs(one.turned) == Approx(exact.turn).epsilon(1e-4));
        sum += capacity * std::abs(one.turned);
      }
      CHECK(simulation.ledger().dissipated_in_joints == Approx(sum).epsilon(1e-8));
      CHECK(simulation.ledger().lost_in_impacts >= 0);
      CHECK(std::abs(simulation.ledger().residual()) < 1e-9);
      CHECK(of_kind(simulation, SimulationEvent::Kind::joint_yielded).size() == turned.size());
    }
  }
}

TEST_CASE("Ductile ends break in an impact where they turn through their limit, brittle ones at their capacity") {
  const double speed = 8, turn = closed_form(speed).turn;
  const auto breaks = [&](const JointCapacity& joint) {
    Simulation simulation = strike(built_in(joint).building, speed);
    run(simulation);
    CHECK(std::abs(simulation.ledger().residual()) < 1e-9);
    return of_kind(simulation, SimulationEvent::Kind::joint_broke);
  };
  CHECK(breaks(joint_of(1.001 * turn)).empty());
  const auto turned_out = breaks(joint_of(0.999 * turn));
  REQUIRE(turned_out.size() >= 2);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(turned_out[i].joint.cause == BreakCause::impact);
    CHECK(turned_out[i].joint.sense == Sense::moment_y);
    CHECK(turned_out[i].joint.demand == Approx(capacity).epsilon(1e-6));
  }
  JointCapacity brittle = joint_of(0);
  CHECK(breaks(brittle).size() >= 2);
}

TEST_CASE("What hinges take in an impact does not come back") {
  // With restitution r it comes back with r2 of the energy that the joints left of its approach. Half of that bounds it
  // from below, for the strain that stays in the post.
  const double speed = 8, restitution = 0.9;
  Simulation simulation = strike(built_in(joint_of(0.1)).building, speed, restitution);
  run(simulation);
  const Ledger ledger = simulation.ledger();
  const auto impacts = of_kind(simulation, SimulationEvent::Kind::impact);
  REQUIRE(impacts.size() == 1);
  const double brought = mass * speed * speed / 2, left = mass * std::pow(impacts[0].speed_out, 2) / 2;
  CHECK(impacts[0].speed_out < 0);
  CHECK(ledger.dissipated_in_joints == Approx(2 * capacity * closed_form(speed).turn).epsilon(1e-4));
  CHECK(left < brought - ledger.dissipated_in_joints);
  CHECK(left > 0.5 * restitution * restitution * (brought - ledger.dissipated_in_joints));
  CHECK(ledger.lost_in_impacts >= 0);
  CHECK(std::abs(ledger.residual()) < 1e-9);
}

TEST_CASE("A post that is struck from one side and then from the other yields, unloads, and yields back") {
  const double first = 6, second = 7;
  const FrameBuilder frame = built_in(joint_of(0.1));
  Scenario scenario = struck_post(height / 2, first, mass, 1.0 / 60, 0.6);
  Scenario back = struck_post(height / 2, second, mass, 1.0 / 60, 0.6);
  auto ball = std::get<Projectile>(back.events[0].tool);
  ball.from.x() = -ball.from.x();
  ball.velocity.x() = -ball.velocity.x();
  scenario.events.push_back({0.3, ball});
  Simulation simulation(frame.building, scenario, {1, [] { return std::make_unique<BallisticWorld>(); }});
  run(simulation);
  const ClosedForm there = closed_form(first);
  REQUIRE(there.turn > 0);
  // The first left a moment of the other sign behind, so that the second yields earlier: from then on by energy.
  const double rest = capacity - there.peak * height / 8, again = 8 / height * (capacity + rest);
  const double at_yield = again * again * elastic / 2, energy = mass * second * second / 2;
  const double d = hinged * (std::sqrt(again * again + 2 * (energy - at_yield) / hinged) - again);
  const double turn = d / hinged * height * height / (16 * E * I);
  const auto impacts = of_kind(simulation, SimulationEvent::Kind::impact);
  REQUIRE(impacts.size() == 2);
  CHECK(impacts[1].peak_force == Approx(again + d / hinged).epsilon(1e-4));
  const auto turned = simulation.frame().plastic_rotations();
  REQUIRE(turned.size() == 2);
  for (const PlasticRotation& one : turned)
    CHECK(std::abs(one.turned) == Approx(std::abs(there.turn - turn)).epsilon(1e-3));
  CHECK(simulation.ledger().dissipated_in_joints == Approx(2 * capacity * (there.turn + turn)).epsilon(1e-4));
  CHECK(std::abs(simulation.ledger().residual()) < 1e-9);
}
