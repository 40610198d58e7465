// What budgets leave out stays in the account: weights that lie, work that waits. And charges in their order.
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

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

TEST_CASE("above the limit of bodies sleeping ones are dropped until it is kept") {
  FrameBuilder f = cantilevers();
  CutTool cut;
  for (std::size_t m = 0; m < 8; ++m) cut.joints.push_back(f.building.joint(MemberId(m), 0));
  Scenario scenario = scenario_with({{0.1, cut}}, 60);
  scenario.debris.limit = 3;
  Simulation simulation(f.building, std::move(scenario));
  run(simulation);
  CHECK(of_kind(simulation, SimulationEvent::Kind::detached).size() == 8);
  CHECK(simulation.bodies().size() == 3);
  CHECK(of_kind(simulation, SimulationEvent::Kind::limited).size() == 5);
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

TEST_CASE("a budget of operations spreads a collapse over steps and comes to the same damage") {
  const auto collapse = [](std::optional<double> budget) {
    FrameBuilder f = grid_building(4, 2, 3, 5, 3, same_capacity(4e5), same_capacity(6e4));
    for (std::size_t m = 0; m < f.building.members.size(); ++m) f.load(MemberId(m), -4000);
    RemoveTool corner;
    corner.members = {MemberId(0u)};
    Scenario scenario = scenario_with({{0.5, corner}}, 3);
    scenario.operations_budget = budget;
    Simulation simulation(f.building, std::move(scenario));
    while (simulation.time() < 0.45) simulation.step();
    const double before = simulation.frame().counters().operations;
    while (simulation.time() < 0.9) simulation.step();  // before debris lands on anything
    const double spent = simulation.frame().counters().operations - before;
    std::set<std::string> names;
    std::int64_t first = 0, last = 0;
    for (const SimulationEvent& event : of_kind(simulation, SimulationEvent::Kind::joint_broke)) {
      names.insert(event.name);
      if (first == 0) first = event.step;
      last = event.step;
    }
    return std::tuple(names, last - first, simulation.hash(), spent);
  };
  const auto [free_names, free_span, free_hash, work] = collapse(std::nullopt);
  REQUIRE(free_names.size() > 4);
  const double tight = work / 8;  // the work of the whole collapse in eight steps, and the waiting of solves that owe
  const auto [tight_names, tight_span, tight_hash, tight_work] = collapse(tight);
  CHECK(tight_span > free_span);
  CHECK(tight_names == free_names);
  const auto [again, again_span, again_hash, again_work] = collapse(tight);
  CHECK(again_hash == tight_hash);
  const auto [ample_names, ample_span, ample_hash, ample_work] = collapse(1e15);
  CHECK(ample_hash == free_hash);
}

TEST_CASE("a blow that a budget cuts in two waits where it touches and goes on with the speed that it has left") {
  const auto fall = [](std::optional<double> budget) {
    FrameBuilder f;
    const NodeId a = f.node("A", 0, 0, 5), b = f.node("B", 6, 0, 5), c = f.node("C", 0, 0, 0), d = f.node("D", 6, 0, 0);
    f.member("CA", MemberKind::post, c, a);
    f.member("DB", MemberKind::post, d, b);
    f.member("AB", MemberKind::beam, a, b, same_capacity(2e4), same_capacity(2e4));
    f.support(c);
    f.support(d);
    for (std::size_t m = 0; m < 3; ++m) f.load(MemberId(m), -10);
    Projectile ball;
    ball.radius = 0.25;
    ball.mass = 300;
    ball.from = Vec3(2, 0, 7);  // nearer to one end: its joint breaks first
    ball.velocity = Vec3(0, 0, -6);
    Scenario scenario = scenario_with({{0.1, ball}}, 5);
    scenario.operations_budget = budget;
    return std::make_unique<Simulation>(f.building, std::move(scenario));
  };
  const auto until = [](Simulation& simulation, SimulationEvent::Kind kind, std::size_t count) {
    while (!simulation.finished() && of_kind(simulation, kind).size() < count) simulation.step();
    REQUIRE(of_kind(simulation, kind).size() >= count);
  };
  const auto free = fall(std::nullopt);
  until(*free, SimulationEvent::Kind::impact, 1);
  // What the blow took in all, in six steps or more.
  const auto tight = fall(free->frame().counters().operations / 6);
  until(*tight, SimulationEvent::Kind::joint_broke, 1);
  CHECK(of_kind(*free, SimulationEvent::Kind::joint_broke).size() == 2);
  CHECK(of_kind(*tight, SimulationEvent::Kind::joint_broke).size() == 1);

  // Where it touched, with the speed of its event; the joint that is left breaks in a later step.
  const SimulationEvent impact = of_kind(*tight, SimulationEvent::Kind::impact).front();
  CHECK(impact.speed_out > 0);
  const auto height = [](const Simulation& simulation) {
    for (const BodyView& view : simulation.bodies())
      if (view.members.empty()) return view.pose.position.z();
    FAIL("no ball");
    return 0.0;
  };
  const double touched = height(*tight);
  const double kinetic = 300 * impact.speed_out * impact.speed_out / 2;
  CHECK(tight->ledger().kinetic_translation == Approx(kinetic).epsilon(1e-12));
  tight->step();  // in which the solve is paid
  CHECK(height(*tight) == Approx(touched).margin(1e-9));
  CHECK(tight->ledger().kinetic_translation == Approx(kinetic).epsilon(1e-12));
  until(*tight, SimulationEvent::Kind::joint_broke, 2);
  CHECK(of_kind(*tight, SimulationEvent::Kind::impact).back().speed_in == Approx(impact.speed_out).epsilon(1e-9));

  for (Simulation* simulation : {free.get(), tight.get()}) {
    until(*simulation, SimulationEvent::Kind::detached, 1);
    CHECK(simulation->ledger().momentum_error < 1e-10);
    CHECK(std::abs(simulation->ledger().residual()) < 1e-2);
  }
}

TEST_CASE("no step takes more than its budget by more than one answer, debris that breaks up included") {
  struct Spent {
    double most = 0, sum = 0;
    std::size_t broken = 0, splits = 0;
  };
  const auto collapse = [](std::optional<double> budget) {
    FrameBuilder f = grid_building(4, 3, 3, 5, 3, same_capacity(4e5), same_capacity(6e4));
    for (std::size_t m = 0; m < f.building.members.size(); ++m) f.load(MemberId(m), -4000);
    RemoveTool corner;
    corner.members = {MemberId(0u), MemberId(1u), MemberId(4u)};
    Scenario scenario = scenario_with({{0.5, corner}}, 6);
    scenario.operations_budget = budget;
    Simulation simulation(f.building, std::move(scenario));
    simulation.step();
    Spent spent;
    double before = simulation.counters().operations, owed = 0;
    while (!simulation.finished()) {
      simulation.step();
      const double now = simulation.counters().operations, step = now - before;
      before = now;
      spent.sum += step;
      spent.most = std::max(spent.most, step);
      if (!budget) continue;
      if (owed >= *budget) CHECK(step == 0);  // it pays for what was spent
      owed = std::max(0.0, owed + step - *budget);
    }
    spent.broken = of_kind(simulation, SimulationEvent::Kind::joint_broke).size();
    spent.splits = of_kind(simulation, SimulationEvent::Kind::split).size();
    CHECK(simulation.ledger().momentum_error < 1e-10);
    CHECK(std::abs(simulation.ledger().residual()) < 0.01);
    return spent;
  };
  const Spent free = collapse(std::nullopt);
  REQUIRE(free.broken > 20);
  REQUIRE(free.splits > 0);
  const Spent tight = collapse(free.most / 5);
  CHECK(tight.broken > free.broken / 2);
  CHECK(tight.splits > 0);
  CHECK(tight.most < free.most);
}

TEST_CASE("who looks at a collapse in parts changes nothing of it, nor does a second thread") {
  const auto collapse = [](bool looks, int threads) {
    FrameBuilder f = grid_building(4, 3, 3, 5, 3, same_capacity(4e5), same_capacity(6e4));
    for (std::size_t m = 0; m < f.building.members.size(); ++m) f.load(MemberId(m), -4000);
    RemoveTool corner;
    corner.members = {MemberId(0u), MemberId(1u), MemberId(4u)};
    Scenario scenario = scenario_with({{0.5, corner}}, 6);
    scenario.operations_budget = 3e6;
    Simulation simulation(f.building, std::move(scenario), {threads, {}});
    int in_between = 0;
    double looked_at = 0;
    while (!simulation.finished()) {
      simulation.step();
      in_between += simulation.frame().answering() ? 1 : 0;
      if (!looks) continue;
      looked_at += simulation.frame().utilisation(JointId(0u)).value + simulation.ledger().elastic;
      looked_at += simulation.frame().displacement(NodeId(20u)).norm();
      if (simulation.frame().stands(MemberId(9u)))
        looked_at += static_cast<double>(simulation.what_carries(MemberId(9u)).size());
    }
    CHECK((looked_at > 0) == looks);
    CHECK(in_between > 10);
    CHECK(of_kind(simulation, SimulationEvent::Kind::impact).size() > 3);
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
