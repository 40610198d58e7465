// Parts that a simulation is made of, each by itself.
#include <catch2/catch.hpp>

#include "simulation/accounts/event_log.h"
#include "simulation/accounts/running_sums.h"
#include "simulation/debris/release_impulses.h"
#include "structure/frame_builder.h"

namespace {

using namespace topple::test;

constexpr double rounding = 1e-12;  // relative, of a few operations

/// A slender bar along x about the origin.
Body bar(double mass, double length) {
  Body one;
  one.members = {MemberId(0u)};
  one.rest.mass = mass;
  one.rest.centre = Vec3::Zero();
  const double across = mass * length * length / 12;
  one.rest.inertia = Vec3(1e-3 * across, across, across).asDiagonal();
  return one;
}

}  // namespace

TEST_CASE("an impulse at a bar's end moves it as a free body, and no faster than what struck it") {
  const double mass = 100, length = 2, speed = 1;
  const Body one = bar(mass, length);
  const Vec3 tip(length / 2, 0, 0);
  const double hardest = mass / 4 * speed;  // a quarter of a bar's mass is felt at its end
  for (const double impulse : {0.8 * hardest, 2 * hardest}) {
    ReleaseImpulses impulses;
    impulses.add({Part(MemberId(0u)), Vec3(0, 0, impulse), tip, speed, {7}});
    const double given = std::min(impulse, hardest);
    Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();
    Ledger ledger;
    impulses.apply(one, velocity, spin, ledger);
    CHECK(velocity.z() == Approx(given / mass).epsilon(rounding));
    CHECK(spin.y() == Approx(-6 * given / (mass * length)).epsilon(rounding));
    CHECK(ledger.lost_in_impacts == Approx(-given * given / (mass / 2)).epsilon(rounding));  // J^2/(2 m/4)
    Momentum sum;
    impulses.add_to(sum, one, Vec3::Zero());
    CHECK(sum.linear.z() == Approx(given).epsilon(rounding));
    CHECK(sum.angular.y() == Approx(-given * length / 2).epsilon(rounding));
  }
}

TEST_CASE("an impulse is for what it broke off alone, and tells who goes on through it") {
  ReleaseImpulses impulses;
  impulses.add({Part(MemberId(1u)), Vec3(0, 0, 1), Vec3::Zero(), 1, {7}});
  Body other = bar(1, 1);
  CHECK(impulses.first_on(other) == nullptr);
  other.members = {MemberId(1u)};
  CHECK(impulses.first_on(other) != nullptr);
  Bodies bodies;
  CHECK(impulses.breakers_of(other, bodies).empty());  // it is no body any more
  bodies.add(7, Body());
  REQUIRE(impulses.breakers_of(other, bodies).size() == 1);
  CHECK(impulses.breakers_of(other, bodies)[0].value == 7);
  impulses.clear();
  CHECK(impulses.first_on(other) == nullptr);
}

TEST_CASE("events carry the time of their step, and each listener hears each of them once") {
  FrameBuilder f;
  const NodeId foot = f.node("F", 0, 0, 0), head = f.node("H", 0, 0, 3);
  f.member("P", MemberKind::post, foot, head);
  f.support(foot);
  f.load_case();
  Scene scene(f.building, Scenario(), {});
  EventLog log(scene);
  std::vector<std::string> heard;
  log.listen([&](const SimulationEvent& event) { heard.push_back(event.name); });
  scene.step = 3;
  log.record(SimulationEvent::Kind::tool, "cut").mass = 2;
  JointBreak broken;
  broken.joint = f.building.joint(MemberId(0u), 0);
  log.record(broken);
  log.call_listeners();
  log.call_listeners();
  REQUIRE(log.size() == 2);
  CHECK(log.events()[0].time == Approx(3 * scene.scenario.step).epsilon(rounding));
  CHECK(log.events()[0].mass == 2);
  CHECK(heard == std::vector<std::string>{"cut", f.building[broken.joint].name});
  EventLog again(scene);
  again.record(SimulationEvent::Kind::tool, "before");
  again.set_listeners(log.extract_listeners());
  again.record(SimulationEvent::Kind::tool, "after");
  again.call_listeners();
  CHECK(heard.back() == "after");
  CHECK(heard.size() == 3);
}

TEST_CASE("the ledger takes out of what breaks freed what the parts took along as motion") {
  RunningSums sums;
  sums.body_gravity_work = 5;
  sums.body_work_put_in = 3;
  sums.kinetic_released = 4;
  FrameEnergy frame;
  frame.elastic_at_start = 10;
  frame.elastic = 6;
  frame.freed = 9;
  frame.contact_work = 1;
  frame.other_work = 2;
  sums.bring_up_to_date(frame, 7, 2);
  CHECK(sums.ledger.freed_by_breaks == 5);
  CHECK(sums.ledger.gravity_work == 16);
  CHECK(sums.ledger.work_put_in == 5);
  CHECK(sums.ledger.kinetic_translation == 7);
  CHECK(sums.ledger.kinetic_rotation == 2);
}
