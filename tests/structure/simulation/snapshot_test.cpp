// Snapshots: what is saved and resumed goes on to the same bits as what was never interrupted.
#include <algorithm>
#include <catch2/catch.hpp>

#include "frame_builder.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/simulation.h"

using namespace topple::structure;
using topple::test::FrameBuilder;
using topple::test::grid_building;
using topple::test::same_capacity;

namespace {

Simulation seed_hit(double duration = 4, int threads = 1) {
  auto [building, scenario] = read_scenario(find_scenario("seed_hit"));
  scenario.duration = duration;
  return Simulation(std::move(building), std::move(scenario), {threads, {}});
}

void run_to(Simulation& simulation, double time) {
  while (!simulation.finished() && simulation.time() < time) {
    simulation.skip_idle();
    simulation.step();
  }
}

}  // namespace

TEST_CASE("a collapse saved in its middle and resumed ends like one that ran through, and so do their events") {
  Simulation through = seed_hit();
  run_to(through, 4);

  Simulation saved = seed_hit();
  run_to(saved, 2.1);  // debris in the air and on the floors, contacts warm, loads laid
  REQUIRE(!saved.bodies().empty());
  const Snapshot snapshot = saved.save();
  run_to(saved, 4);
  CHECK(saved.hash() == through.hash());  // saving changes nothing

  Simulation resumed = seed_hit();
  resumed.restore(parse_snapshot(snapshot_bytes(snapshot), "snapshot"));
  CHECK(resumed.steps() == snapshot.step);
  CHECK(resumed.hash() == snapshot.hash);
  run_to(resumed, 4);
  CHECK(resumed.hash() == through.hash());
  CHECK(resumed.events().size() == through.events().size());
  CHECK(resumed.ledger().residual() == through.ledger().residual());
}

TEST_CASE("plastic hinges and debris that broke further come back with a snapshot") {
  const auto ductile = [] {
    auto [building, scenario] = read_scenario(find_scenario("seed_hit"));
    for (Joint& joint : building.joints)
      if (joint.member.valid() && building[joint.member].kind == MemberKind::beam && joint.capacity.breakable)
        for (const std::size_t sense : {5u, 6u}) joint.capacity.ductility[sense] = 0.03;
    scenario.duration = 4;
    return Simulation(std::move(building), std::move(scenario), {1, {}});
  };
  const auto count = [](const Simulation& one, SimulationEvent::Kind kind) {
    return std::count_if(one.events().begin(), one.events().end(),
                         [&](const SimulationEvent& event) { return event.kind == kind; });
  };
  Simulation through = ductile();
  run_to(through, 2.5);
  const Snapshot snapshot = through.save();
  REQUIRE(count(through, SimulationEvent::Kind::joint_yielded) > 0);
  REQUIRE(count(through, SimulationEvent::Kind::split) > 0);
  Simulation resumed = ductile();
  resumed.restore(parse_snapshot(snapshot_bytes(snapshot), "snapshot"));
  run_to(through, 4);
  run_to(resumed, 4);
  CHECK(resumed.hash() == through.hash());
  CHECK(resumed.ledger().dissipated_in_joints == through.ledger().dissipated_in_joints);
}

TEST_CASE("a panel that is broken in part comes back with a snapshot, and breaks on in the same way") {
  const auto panels = [] {
    auto [building, scenario] = read_scenario(find_scenario("seed_hit_fracture"));
    scenario.duration = 3;
    return Simulation(std::move(building), std::move(scenario), {1, {}});
  };
  const auto shoot = [](Simulation& one, double x) {
    Projectile ball;
    ball.from = Vec3(x, 9, 40);
    ball.velocity = Vec3(0, 0, -70);
    one.apply(ball);
  };
  const auto broken = [](const Simulation& one) {
    std::size_t standing = 0;
    for (std::size_t p = 0; p < one.building().panels.size(); ++p)
      standing += one.frame().stands(PanelId(p)) && one.broken_panel(PanelId(p)) != nullptr;
    return standing;
  };
  Simulation through = panels(), resumed = panels();
  shoot(through, 15);
  run_to(through, 1);
  const Snapshot snapshot = through.save();
  REQUIRE(broken(through) > 0);
  resumed.restore(parse_snapshot(snapshot_bytes(snapshot), "snapshot"));
  CHECK(broken(resumed) == broken(through));
  for (Simulation* one : {&through, &resumed}) {
    shoot(*one, 14.3);  // beside the first hole
    run_to(*one, 3);
  }
  CHECK(resumed.hash() == through.hash());
  CHECK(resumed.bodies().size() == through.bodies().size());
}

TEST_CASE("what a person did is in the snapshot, and going back undoes it") {
  Simulation one = seed_hit(6);
  run_to(one, 0.5);
  const Snapshot before = one.save();
  RemoveTool remove;
  remove.members = {*NameIndex(one.building()).member("P-4-5-1")};
  one.apply(remove);
  Projectile ball;
  ball.from = Vec3(-20, 12, 2);
  ball.velocity = Vec3(50, 0, 0);
  one.apply(ball);
  run_to(one, 2);
  const Snapshot after = one.save();
  REQUIRE(after.actions.size() == 2);
  CHECK(after.hash != before.hash);
  one.restore(before);
  CHECK(one.frame().stands(remove.members[0]));
  CHECK(one.hash() == before.hash);
  CHECK(one.save().actions.empty());
  one.restore(after);
  CHECK(one.hash() == after.hash);
  CHECK(!one.frame().stands(remove.members[0]));
}

TEST_CASE("listeners hear what happens after a moment was restored, not what led to it") {
  Simulation one = seed_hit(3);
  run_to(one, 1.5);
  const Snapshot middle = one.save();
  const std::size_t told = one.events().size();
  REQUIRE(told > 5);
  Simulation other = seed_hit(3);
  std::size_t heard = 0;
  other.on_event([&](const SimulationEvent&) { ++heard; });
  other.restore(middle);
  CHECK(heard == 0);
  run_to(other, 3);
  CHECK(heard == other.events().size() - told);
}

TEST_CASE("a snapshot of another model or scenario is refused, and the simulation stays as it was") {
  Simulation one = seed_hit(3);
  run_to(one, 1.5);
  Snapshot wrong = one.save();
  const std::uint64_t hash = one.hash();
  wrong.hash ^= 1;
  CHECK_THROWS_AS(one.restore(wrong), InputError);
  CHECK(one.hash() == hash);
  wrong = one.save();
  wrong.scene ^= 1;
  CHECK_THROWS_WITH(one.restore(wrong), Catch::Contains("of another scene"));
  wrong = one.save();
  RemoveTool beyond;
  beyond.members = {MemberId(one.building().members.size())};
  wrong.actions.push_back({0, Tool(beyond)});
  CHECK_THROWS_WITH(one.restore(wrong), Catch::Contains("parts that the model does not have"));
  run_to(one, 2);
  CHECK(one.hash() != hash);
}

TEST_CASE(
    "each number of a model and a scenario tells its snapshots from another's, and a longer run is the same scene") {
  FrameBuilder frame = grid_building(2, 2, 1, 4, 3, same_capacity(1e6), same_capacity(1e6));
  frame.self_weight(7850);
  const auto scene = [](const Building& building, const Scenario& scenario) {
    return Simulation(building, scenario).save().scene;
  };
  Scenario scenario;
  scenario.standing = StandingRule::statics;
  scenario.combination = CombinationId(0u);
  const std::uint64_t own = scene(frame.building, scenario);
  const auto changed = [&](auto change) {
    Building building = frame.building;
    Scenario other = scenario;
    change(building, other);
    return scene(building, other) != own;
  };
  CHECK(changed([](Building& b, Scenario&) { b.nodes[5].position.z() += 1e-9; }));
  CHECK(changed([](Building& b, Scenario&) { b.joints[3].capacity.value[2] *= 2; }));
  CHECK(changed([](Building& b, Scenario&) { b.materials[0].youngs_modulus *= 1.001; }));
  CHECK(changed([](Building& b, Scenario&) { b.cases[0].self_weight.z() = -1.01; }));
  CHECK(changed([](Building&, Scenario& s) { s.step = 1.0 / 120; }));
  CHECK(changed([](Building&, Scenario& s) { s.debris.limit = 5; }));
  CHECK(changed([](Building&, Scenario& s) { s.events.push_back({50, GravityTool{Vec3(0, 0, -9)}}); }));
  CHECK_FALSE(changed([](Building&, Scenario& s) { s.duration = 100; }));
  CHECK_FALSE(changed([](Building& b, Scenario&) { b.title = "another title"; }));
}

TEST_CASE("snapshot files that are none, damaged or of another format are refused by their name") {
  const Simulation one = seed_hit(1);
  const std::string bytes = snapshot_bytes(one.save());
  CHECK_THROWS_WITH(parse_snapshot("hello, world", "a.topple"), Catch::Contains("a.topple: is no snapshot"));
  CHECK_THROWS_WITH(parse_snapshot(bytes.substr(0, bytes.size() - 3), "a.topple"), Catch::Contains("cut short"));
  CHECK_THROWS_WITH(parse_snapshot(bytes + "x", "a.topple"), Catch::Contains("goes on after its end"));
  std::string other = bytes;
  other[8] = 9;
  CHECK_THROWS_WITH(parse_snapshot(other, "a.topple"), Catch::Contains("is of format 9, this program reads 3"));
  CHECK_THROWS_WITH(read_snapshot("/nowhere/a.topple"), Catch::Contains("cannot be opened: No such file"));
  for (std::size_t cut = 0; cut < bytes.size(); ++cut)
    CHECK_THROWS_AS(parse_snapshot(bytes.substr(0, cut), "a.topple"), InputError);
}

TEST_CASE("every tool and host contact goes through a file unchanged") {
  Snapshot snapshot;
  snapshot.step = 12;
  WeakenTool weaken;
  weaken.joints = {JointId(3u)};
  weaken.members = {MemberId(1u)};
  weaken.strength = 0.1;
  weaken.over = 7;
  weaken.stages = 3;
  LoadTool load;
  load.nodes = {{NodeId(4u), Vec6::Constant(1.0 / 3)}};
  RemoveTool remove;
  remove.supports = {NodeId(9u)};
  HostContact host;
  host.key = 77;
  host.member = MemberId(5u);
  host.inertia(0, 2) = 0.7;
  for (const Tool& tool : std::vector<Tool>{Projectile(), WreckingBall(), CutTool{{JointId(1u), JointId(2u)}}, remove,
                                            ChargeTool(), weaken, GravityTool{Vec3(0, 0, -1.0 / 7)}, load})
    snapshot.actions.push_back({static_cast<std::int64_t>(snapshot.actions.size()), tool});
  snapshot.actions.push_back({11, host});
  const std::string bytes = snapshot_bytes(snapshot);
  const Snapshot read = parse_snapshot(bytes, "s");
  CHECK(snapshot_bytes(read) == bytes);
  CHECK(std::get<WeakenTool>(std::get<Tool>(read.actions[5].what)).stages == 3);
  CHECK(std::get<HostContact>(read.actions[8].what).inertia(0, 2) == 0.7);
}

TEST_CASE("one thread and two come to the same bits") {
  Simulation one = seed_hit(3), two = seed_hit(3, 2);
  run_to(one, 3);
  run_to(two, 3);
  CHECK(one.hash() == two.hash());
}
