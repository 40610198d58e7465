// States in the middle of what tools and hosts do.
#include <catch2/catch.hpp>

#include "goes_on_alike.h"
#include "structure/frame_builder.h"
#include "topple/structure/formats/files.h"

using namespace topple::structure;
using topple::test::FrameBuilder;
using topple::test::goes_on_alike;
using topple::test::grid_building;
using topple::test::same_capacity;
using topple::test::SavedRun;

namespace {

/// A frame of two bays and three storeys; what a scenario does to it is up to the test.
std::function<Simulation()> frame(std::vector<Event> events, double duration,
                                  StandingRule standing = StandingRule::dynamics) {
  return [=] {
    FrameBuilder built = grid_building(3, 2, 3, 5, 3, same_capacity(4e5), same_capacity(1.5e5));
    for (std::size_t m = 0; m < built.building.members.size(); ++m) built.load(MemberId(m), -3000);
    Scenario scenario;
    scenario.combination = CombinationId(0u);
    scenario.standing = standing;
    scenario.duration = duration;
    scenario.until_rest = false;
    scenario.ground = 0;
    scenario.events = events;
    return Simulation(built.building, scenario);
  };
}

constexpr std::array both{StandingRule::statics, StandingRule::dynamics};

}  // namespace

TEST_CASE("a state within a fire goes on alike: stages to come, joints and members weakened so far") {
  WeakenTool fire, rot;
  for (std::size_t m = 0; m < 12; ++m)
    for (const int end : {0, 1}) fire.joints.push_back(JointId(2 * m + static_cast<std::size_t>(end)));
  fire.strength = 0.02;
  fire.over = 40;
  fire.stages = 8;
  rot.members = {MemberId(1u), MemberId(20u)};
  rot.stiffness = 0.3;
  rot.over = 30;
  rot.stages = 5;
  for (const StandingRule standing : both)
    goes_on_alike({frame({{1, fire}, {2, rot}}, 60, standing), {0.5, 7, 22, 38, 41, 44}});
}

TEST_CASE("a state between charges, cuts, loads and a turned gravity goes on alike") {
  ChargeTool charge;
  charge.centre = Vec3(0, 0, 1.5);
  charge.radius = 6;
  charge.strength_at_centre = 0.02;
  charge.strength_at_radius = 0.4;
  LoadTool push;
  push.nodes = {{NodeId(10u), (Vec6() << 4e4, 0, -2e4, 0, 0, 0).finished()}};
  RemoveTool remove;
  remove.members = {MemberId(4u)};
  const std::vector<Event> events{{0.2, charge},
                                  {1.0, push},
                                  {1.3, GravityTool{Vec3(2, 0, -8)}},
                                  {1.6, CutTool{{JointId(9u), JointId(30u)}}},
                                  {2.0, remove}};
  for (const StandingRule standing : both)
    goes_on_alike({frame(events, 4, standing), {0.1, 0.25, 0.8, 1.1, 1.4, 1.8, 2.5, 3.5}});
}

TEST_CASE("a state of a wrecking ball that swings goes on alike") {
  WreckingBall ball;
  ball.anchor = Vec3(-3, 2.5, 20);
  ball.cable = 14;
  ball.from = ball.anchor + 14 * Vec3(-std::sin(0.9), 0, -std::cos(0.9));
  for (const StandingRule standing : both) goes_on_alike({frame({{0.1, ball}}, 5, standing), {0.12, 1, 2, 2.6, 4}});
}

TEST_CASE("a state goes on alike while a host shoots, touches and tunes, with what it asked for and not yet had") {
  const auto host = [](Simulation& simulation) {
    const std::int64_t step = simulation.steps();
    if (step == 20) {
      Projectile ball;
      ball.from = Vec3(-6, 2, 4);
      ball.velocity = Vec3(40, 2, 1);
      ball.mass = 900;
      simulation.apply(ball);
    }
    if (step == 50) {
      WeakenTool weaken;
      weaken.joints = {JointId(14u), JointId(15u)};
      weaken.strength = 0.3;
      weaken.over = 0.5;
      weaken.stages = 4;
      simulation.apply(weaken);
    }
    if (step == 65) {
      JointCapacity less = same_capacity(2e4);
      const std::vector<std::pair<JointId, JointCapacity>> change{{JointId(40u), less}, {JointId(41u), less}};
      simulation.set_capacities(change);
    }
    HostContact contact;
    contact.key = step;
    contact.mass = 1200;
    contact.inertia = 400 * Mat3::Identity();
    contact.velocity = Vec3(7, 0, 0);
    if (step % 8 == 0) {
      contact.member = MemberId(0u);
      contact.point = contact.centre = Vec3(0, 0, 1.2);
      simulation.touch(contact);
    }
    if (step % 5 == 0 && !simulation.bodies().empty()) {
      const BodyView& body = simulation.bodies()[static_cast<std::size_t>(step) % simulation.bodies().size()];
      contact.key = 1000 + step;
      contact.member = {};
      contact.body = body.id;
      contact.point = body.pose.position;
      contact.centre = body.pose.position - Vec3(1, 0, 0);
      simulation.touch(contact);
    }
  };
  for (const StandingRule standing : both) {
    SavedRun run{frame({}, 4, standing), {}, host};
    for (const double step : {0, 20, 21, 40, 50, 60, 65, 66, 100, 180}) run.moments.push_back(step / 60 - 1e-6);
    goes_on_alike(run);
  }
}

TEST_CASE("a state of what was tuned has the capacities, and a snapshot of who loads it leads back to it") {
  const auto make = frame({}, 3);
  Simulation saved = make();
  const std::vector<std::pair<JointId, JointCapacity>> change{{JointId(3u), same_capacity(7e5)}};
  saved.set_capacities(change);
  RemoveTool remove;
  remove.members = {MemberId(0u)};
  saved.apply(remove);
  for (int i = 0; i < 30; ++i) saved.step();
  Simulation loaded = make();
  topple::test::load(loaded, topple::test::state_of(saved));
  CHECK(loaded.building()[JointId(3u)].capacity.value == saved.building()[JointId(3u)].capacity.value);
  const Snapshot snapshot = loaded.save();
  CHECK(snapshot_bytes(snapshot) == snapshot_bytes(saved.save()));
  Simulation replayed = make();
  replayed.restore(snapshot);
  CHECK(topple::test::seen_of(replayed) == topple::test::seen_of(loaded));
}
