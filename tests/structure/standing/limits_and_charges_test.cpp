// What limits leave out stays in the account. Who looks on changes nothing. And charges in their order.
#include <catch2/catch.hpp>
#include <cmath>

#include "frame_builder.h"
#include "simulation_run.h"
#include "topple/structure/simulation.h"

using namespace topple::structure;
using topple::test::FrameBuilder;
using topple::test::grid_building;
using topple::test::of_kind;
using topple::test::run;
using topple::test::same_capacity;

namespace {

constexpr double g = 10;

Scenario scenario_with(std::vector<Event> events, double duration = 60) {
  Scenario scenario;
  scenario.standing = StandingRule::statics;
  scenario.combination = CombinationId(0u);
  scenario.duration = duration;
  scenario.ground = 0;
  scenario.events = std::move(events);
  return scenario;
}

double weight_on_supports(const Simulation& simulation) {
  double sum = 0;
  for (const NodeSupport& support : simulation.building().supports) sum += simulation.frame().reaction(support.node)(2);
  return sum;
}

/// Eight cantilevers side by side, each on a support of its own.
FrameBuilder cantilevers() {
  FrameBuilder f;
  for (int i = 0; i < 8; ++i) {
    const NodeId a = f.node("A" + std::to_string(i), 0, 3 * i, 2), b = f.node("B" + std::to_string(i), 3, 3 * i, 2);
    f.member("M" + std::to_string(i), MemberKind::beam, a, b);
    f.support(a);
    f.load(MemberId(static_cast<std::size_t>(i)), -500);
  }
  return f;
}

/// A table on four posts, and a bracket above its middle from a mast beside it.
FrameBuilder table_and_bracket() {
  FrameBuilder f = grid_building(2, 2, 1, 4, 2, {}, {});
  const auto at = [](int i, int j) { return NodeId(static_cast<std::size_t>((2 + j) * 2 + i)); };
  const NodeId foot = f.node("foot", -2, 2, 0), head = f.node("head", -2, 2, 4), tip = f.node("tip", 3, 2, 4);
  f.member("mast", MemberKind::post, foot, head);
  f.member("bracket", MemberKind::beam, head, tip);
  f.support(foot);
  const PanelId slab = f.panel("S", PanelModel::membrane, {at(0, 0), at(1, 0), at(1, 1), at(0, 1)});
  f.load(slab, 2000);
  for (std::size_t m = 0; m < f.building.members.size(); ++m) f.load(MemberId(m), -500);
  return f;
}

}  // namespace

TEST_CASE("above the limit of bodies sleeping ones are dropped until it is kept, and without one none") {
  FrameBuilder f = cantilevers();
  CutTool cut;
  for (std::size_t m = 0; m < 8; ++m) cut.joints.push_back(f.building.joint(MemberId(m), 0));
  Scenario scenario = scenario_with({{0.1, cut}}, 60);
  const bool limited = GENERATE(true, false);
  if (limited) scenario.debris.limit = 3;
  Simulation simulation(f.building, std::move(scenario));
  run(simulation);
  CHECK(of_kind(simulation, SimulationEvent::Kind::detached).size() == 8);
  CHECK(simulation.bodies().size() == (limited ? 3U : 8U));
  CHECK(of_kind(simulation, SimulationEvent::Kind::limited).size() == (limited ? 5U : 0U));
  CHECK(std::abs(simulation.ledger().residual()) < 0.01);
}

TEST_CASE("a part too small to be a body weighs on what stands under it, and falls with that") {
  FrameBuilder f = table_and_bracket();
  const MemberId bracket(f.building.members.size() - 1);
  RemoveTool legs;
  for (std::size_t m = 0; m < f.building.members.size(); ++m)
    if (f.building.members[m].name.starts_with("P-")) legs.members.push_back(MemberId(m));
  REQUIRE(legs.members.size() == 4);
  Scenario scenario = scenario_with({{1, CutTool{{f.building.joint(bracket, 0)}}}, {2, legs}}, 20);
  scenario.debris.smallest_volume = 0.3;  // the bracket has 5 m x 0.04 m2; the table's slab 3.2 m3
  Simulation simulation(f.building, std::move(scenario));
  const double before = weight_on_supports(simulation), bracket_weight = 5 * 500;
  while (simulation.time() < 1.5) simulation.step();
  const auto dropped = of_kind(simulation, SimulationEvent::Kind::limited);
  REQUIRE(dropped.size() == 1);
  CHECK(dropped[0].mass == Approx(bracket_weight / g).epsilon(1e-12));
  CHECK(simulation.bodies().empty());
  CHECK(weight_on_supports(simulation) == Approx(before).epsilon(1e-9));  // nothing is lost
  run(simulation);
  double fallen = 0;
  for (const SimulationEvent& event : of_kind(simulation, SimulationEvent::Kind::detached)) fallen += event.mass;
  const double table = (4 * 4 * 2000 + 4 * 4 * 500) / g;  // slab and four beams
  CHECK(fallen == Approx(table + bracket_weight / g).epsilon(1e-9));
}

TEST_CASE("who looks at a collapse changes nothing of it, nor does a second thread") {
  const auto collapse = [](bool looks, int threads) {
    FrameBuilder f = grid_building(4, 3, 3, 5, 3, same_capacity(4e5), same_capacity(6e4));
    for (std::size_t m = 0; m < f.building.members.size(); ++m) f.load(MemberId(m), -4000);
    RemoveTool corner;
    corner.members = {MemberId(0u), MemberId(1u), MemberId(4u)};
    Scenario scenario = scenario_with({{0.5, corner}}, 6);
    Simulation simulation(f.building, std::move(scenario), {threads, {}});
    double looked_at = 0;
    while (!simulation.finished()) {
      simulation.step();
      if (!looks) continue;
      looked_at += simulation.frame().utilisation(JointId(0u)).value + simulation.ledger().elastic;
      looked_at += simulation.frame().displacement(NodeId(20u)).norm();
      if (simulation.frame().stands(MemberId(9u)))
        looked_at += static_cast<double>(simulation.what_carries(MemberId(9u)).size());
    }
    CHECK((looked_at > 0) == looks);
    CHECK(of_kind(simulation, SimulationEvent::Kind::impact).size() > 2);
    return std::pair(simulation.hash(), of_kind(simulation, SimulationEvent::Kind::joint_broke).size());
  };
  const auto unseen = collapse(false, 1);
  REQUIRE(unseen.second > 10);
  CHECK(collapse(true, 1) == unseen);
  CHECK(collapse(false, 2) == unseen);
}

TEST_CASE("charges go off in the order of their delays") {
  FrameBuilder f = cantilevers();
  for (Joint& joint : f.building.joints) joint.capacity = same_capacity(1e6);
  std::vector<Event> events;
  for (int i = 0; i < 8; ++i) {
    ChargeTool charge;
    charge.centre = Vec3(0, 3 * (7 - i), 2);
    charge.radius = 1;
    events.push_back({1 + 0.25 * i, charge});
  }
  Simulation simulation(f.building, scenario_with(std::move(events), 4));
  run(simulation);
  const auto broke = of_kind(simulation, SimulationEvent::Kind::joint_broke);
  REQUIRE(broke.size() == 8);
  for (int i = 0; i < 8; ++i) {
    const SimulationEvent& event = broke[static_cast<std::size_t>(i)];
    CHECK(event.name == "M" + std::to_string(7 - i) + ":1");
    CHECK(event.time == Approx(1 + 0.25 * i).epsilon(1e-12));
    CHECK(event.joint.cause == BreakCause::tool);
  }
}
