// Tools over time and inside members, against statics and mechanics done by hand.
#include <catch2/catch.hpp>
#include <cmath>

#include "frame_builder.h"
#include "simulation_run.h"
#include "topple/structure/divide_member.h"
#include "topple/structure/simulation.h"

using namespace topple::structure;
using topple::test::FrameBuilder;
using topple::test::of_kind;
using topple::test::run;
using topple::test::same_capacity;

namespace {

constexpr double g = 10, reach = 4, weight = 1000;  // a cantilever and its load per length

/// A cantilever along x, 6 m above the ground.
FrameBuilder cantilever(const JointCapacity& joint = {}) {
  FrameBuilder f;
  const NodeId a = f.node("A", 0, 0, 6), b = f.node("B", reach, 0, 6);
  f.member("AB", MemberKind::beam, a, b, joint, {});
  f.support(a);
  f.load(MemberId(0u), -weight);
  return f;
}

Scenario with(const Tool& tool, double at = 1, double duration = 20) {
  Scenario scenario;
  scenario.standing = StandingRule::statics;
  scenario.combination = CombinationId(0u);
  scenario.duration = duration;
  scenario.ground = 0;
  scenario.events = {{at, tool}};
  return scenario;
}

}  // namespace

TEST_CASE("a joint that weakens in stages breaks at the stage that falls below what it bears") {
  const double moment = weight * reach * reach / 2;
  FrameBuilder f = cantilever(same_capacity(moment / 0.55));  // utilisation 0.55: strength 0.5 is the first below
  WeakenTool fire;
  fire.joints = {JointId(0u)};
  fire.strength = 0;
  fire.over = 3600;
  fire.stages = 10;
  Simulation simulation(f.building, with(fire, 10, 5000));
  run(simulation);
  const auto breaks = of_kind(simulation, SimulationEvent::Kind::joint_broke);
  REQUIRE(breaks.size() == 1);
  CHECK(breaks[0].joint.cause == BreakCause::overload);
  CHECK(breaks[0].time == Approx(10 + 5 * 360).epsilon(1e-12));
  CHECK(breaks[0].joint.capacity == Approx(moment / 0.55 * 0.5).epsilon(1e-12));
  CHECK(of_kind(simulation, SimulationEvent::Kind::tool).size() == 10);  // the other stages pass over the debris
  // Ten stages, and what the beam needs to fall 6 m and come to rest; all other steps are passed over.
  CHECK(simulation.counters().steps_idle > 200000);
  CHECK(simulation.counters().collision_steps < 1200);
}

TEST_CASE("a member that loses stiffness slowly sags by as much more, and its joints feel no shock") {
  const double moment = weight * reach * reach / 2;
  FrameBuilder f = cantilever(same_capacity(moment / 0.95));  // sudden loads would break it
  WeakenTool rot;
  rot.members = {MemberId(0u)};
  rot.stiffness = 0.25;
  rot.over = 100;
  rot.stages = 5;
  Simulation simulation(f.building, with(rot, 1, 200));
  const double before = -simulation.frame().displacement(NodeId(1u))(2);
  const Ledger start = simulation.ledger();
  run(simulation);
  CHECK(of_kind(simulation, SimulationEvent::Kind::joint_broke).empty());
  CHECK(-simulation.frame().displacement(NodeId(1u))(2) == Approx(4 * before).epsilon(1e-9));
  const Ledger& end = simulation.ledger();
  CHECK(end.elastic == Approx(4 * start.elastic).epsilon(1e-9));
  // Gravity's work on the way down is twice the elastic energy gained; what the softening frees is the other half.
  CHECK(end.freed_by_breaks == Approx(3 * start.elastic).epsilon(1e-9));
  CHECK(std::abs(end.residual()) < 1e-9);
}

TEST_CASE("two weakenings of the same part act by their product") {
  FrameBuilder f = cantilever(same_capacity(1e9));
  WeakenTool half;
  half.joints = {JointId(0u)};
  half.members = {MemberId(0u)};
  half.strength = half.stiffness = 0.5;
  Scenario scenario = with(half);
  scenario.events.push_back({2, half});
  Simulation simulation(f.building, std::move(scenario));
  const double before = simulation.frame().displacement(NodeId(1u))(2);
  run(simulation);
  CHECK(simulation.frame().displacement(NodeId(1u))(2) == Approx(4 * before).epsilon(1e-9));
  CHECK(simulation.frame().utilisation(JointId(0u)).value ==
        Approx(weight * reach * reach / 2 / (0.25 * 1e9)).epsilon(1e-9));
}

TEST_CASE("a divided member stands and weighs as the whole did") {
  FrameBuilder whole = cantilever(), pieces = cantilever();
  const std::vector<JointId> cuts = divide_member(pieces.building, MemberId(0u), {0.3, 0.8});
  REQUIRE(cuts.size() == 2);
  CHECK(pieces.building[cuts[0]].name == "AB/cut-1:1");
  CHECK(pieces.building.members[1].name == "AB/2");
  const NameIndex names(pieces.building);
  CHECK(names.members_matching("AB/*").size() == 2);
  CHECK(pieces.building[*names.joint("AB:2")].member == MemberId(2u));
  const StandingFrame one(whole.building, CombinationId(0u), {}), three(pieces.building, CombinationId(0u), {});
  CHECK((one.displacement(NodeId(1u)) - three.displacement(NodeId(1u))).norm() <
        1e-12 * one.displacement(NodeId(1u)).norm() + 1e-15);
  CHECK(three.mass(MemberId(1u)) == Approx(0.5 * one.mass(MemberId(0u))).epsilon(1e-12));
  CHECK_THROWS_AS(divide_member(whole.building, MemberId(0u), {0.5, 0.5}), std::invalid_argument);
}

TEST_CASE("loads keep their places when their member is divided") {
  FrameBuilder whole = cantilever();
  MemberLoad slope;
  slope.member = MemberId(0u);
  slope.from = 0.5;
  slope.to = 3.5;
  slope.first(2) = -100;
  slope.last(2) = -1900;
  MemberLoad point;
  point.member = MemberId(0u);
  point.kind = MemberLoad::Kind::point;
  point.from = 0.25 * reach;  // right where it is cut
  point.first(1) = 700;
  for (const MemberLoad& load : {slope, point}) whole.load_case().members.push_back(load);
  FrameBuilder pieces = whole;
  (void)divide_member(pieces.building, MemberId(0u), {0.25, 0.6});
  const StandingFrame one(whole.building, CombinationId(0u), {}), three(pieces.building, CombinationId(0u), {});
  CHECK((one.displacement(NodeId(1u)) - three.displacement(NodeId(1u))).norm() <
        1e-11 * one.displacement(NodeId(1u)).norm());
}

TEST_CASE("a beam that is cut inside drops what lies beyond the cut") {
  FrameBuilder f = cantilever();
  (void)divide_member(f.building, MemberId(0u), {0.75});
  Simulation simulation(f.building, with(CutTool{{f.building.joint(MemberId(1u), 0)}}));  // the node stays with AB
  run(simulation);
  const auto detached = of_kind(simulation, SimulationEvent::Kind::detached);
  REQUIRE(detached.size() == 1);
  CHECK(detached[0].mass == Approx(0.25 * reach * weight / g).epsilon(1e-12));
  CHECK(detached[0].name == "AB/2");
  CHECK(simulation.frame().stands(MemberId(0u)));
  const double EI = f.building.materials[0].youngs_modulus * f.building.sections[0].Iy, left = 0.75 * reach;
  CHECK(-simulation.frame().displacement(NodeId(2u))(2) == Approx(weight * std::pow(left, 4) / (8 * EI)).epsilon(1e-9));
  const auto broke = of_kind(simulation, SimulationEvent::Kind::joint_broke);
  REQUIRE(broke.size() == 1);
  CHECK(broke[0].joint.cause == BreakCause::tool);
}

TEST_CASE("a wrecking ball swings down and hits with the speed that energy gives") {
  FrameBuilder f;
  const NodeId foot = f.node("A", 0, 0, 0), top = f.node("B", 0, 0, 6);
  f.member("AB", MemberKind::post, foot, top);
  f.support(foot);
  f.load(MemberId(0u), -weight);
  WreckingBall ball;
  ball.anchor = Vec3(-0.8, 0, 15);  // it hangs where it just touches the post, 4 m up
  ball.cable = 11;
  const double angle = 1.0;
  ball.from = ball.anchor + ball.cable * Vec3(-std::sin(angle), 0, -std::cos(angle));
  ball.mass = 500;
  ball.radius = 0.7;  // and the post is 0.2 m wide
  Simulation simulation(f.building, with(ball, 1, 4));
  while (!simulation.finished() && of_kind(simulation, SimulationEvent::Kind::impact).empty()) simulation.step();
  const auto impacts = of_kind(simulation, SimulationEvent::Kind::impact);
  REQUIRE(!impacts.empty());
  CHECK(impacts[0].body_name == "wrecking ball 1");
  CHECK(impacts[0].name == "AB");
  const double speed = std::sqrt(2 * g * ball.cable * (1 - std::cos(angle)));
  CHECK(impacts[0].speed_in == Approx(speed).epsilon(2e-3));  // the last part of a step is swept as a free flight
  CHECK(impacts[0].position.z() == Approx(4).epsilon(0.02));
  REQUIRE(simulation.bodies().size() == 1);
  CHECK(simulation.bodies()[0].cable_anchor->isApprox(ball.anchor));
  CHECK(std::abs(simulation.ledger().residual()) < 0.01);
}
