// Whatever a host hands on: a call is carried out, or throws with what was wrong and leaves no trace.
#include <catch2/catch.hpp>
#include <cstdint>
#include <functional>
#include <limits>
#include <stdexcept>

#include "frame_builder.h"
#include "simulation_run.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/simulation.h"

using namespace topple::structure;
using topple::test::FrameBuilder;
using topple::test::same_capacity;

namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

template <class Id>
Id with_index(std::int32_t index) {
  Id id;
  id.index = index;
  return id;
}

Simulation portal() {
  FrameBuilder f;
  const NodeId a = f.node("A", 0, 0, 0), b = f.node("B", 0, 0, 4), c = f.node("C", 5, 0, 4), d = f.node("D", 5, 0, 0);
  f.member("AB", MemberKind::post, a, b, same_capacity(1e6), same_capacity(1e6));
  f.member("BC", MemberKind::beam, b, c, same_capacity(1e6), same_capacity(1e6));
  f.member("DC", MemberKind::post, d, c, same_capacity(1e6), same_capacity(1e6));
  f.support(a);
  f.support(d);
  f.self_weight(7850);
  Scenario scenario;
  scenario.standing = StandingRule::statics;
  scenario.combination = CombinationId(0u);
  scenario.duration = 1;
  scenario.ground = 0;
  return {f.building, scenario};
}

/// The same call at the beginning, in the middle of a collapse, and at its end; nothing of it stays.
void leaves_no_trace(const std::function<void(Simulation&)>& call) {
  Simulation simulation = portal();
  const auto tried = [&] {
    const Snapshot before = simulation.save();
    CHECK_THROWS(call(simulation));
    const Snapshot after = simulation.save();
    CHECK(after.hash == before.hash);
    CHECK(after.actions.size() == before.actions.size());
  };
  tried();
  RemoveTool remove;
  remove.members = {MemberId(0u)};
  simulation.apply(remove);
  for (int i = 0; i < 20; ++i) simulation.step();
  tried();
  topple::test::run(simulation);
  tried();
  Simulation again = portal();
  CHECK_NOTHROW(again.restore(simulation.save()));
}

HostContact sound_contact() {
  HostContact contact;
  contact.member = MemberId(1u);
  contact.mass = 100;
  contact.inertia = Mat3::Identity();
  contact.point = contact.centre = Vec3(2, 0, 4);
  contact.velocity = Vec3(1, 0, 0);
  return contact;
}

const std::vector<double> no_numbers{no_number, unlimited, -unlimited, 1e300, -1e300};

}  // namespace

TEST_CASE("ids that the building does not have are told by every call, in every state") {
  constexpr std::int32_t largest = std::numeric_limits<std::int32_t>::max(),
                         least = std::numeric_limits<std::int32_t>::min();
  for (const std::int32_t index : {-1, -2, 3, 6, 1000, largest, least}) {
    const auto member = with_index<MemberId>(index);
    const auto panel = with_index<PanelId>(index == 3 ? 0 : index);
    const auto joint = with_index<JointId>(index == 3 ? 6 : index);
    const auto node = with_index<NodeId>(index == 3 ? 4 : index);
    leaves_no_trace([&](Simulation& s) { (void)s.body_of(member); });
    leaves_no_trace([&](Simulation& s) { (void)s.body_of(panel); });
    leaves_no_trace([&](Simulation& s) { (void)s.broken_panel(panel); });
    leaves_no_trace([&](Simulation& s) { (void)s.what_carries(member); });
    leaves_no_trace([&](Simulation& s) { (void)s.what_carries(panel); });
    leaves_no_trace([&](Simulation& s) {
      const std::pair<JointId, JointCapacity> change{joint, {}};
      s.set_capacities({&change, 1});
    });
    leaves_no_trace([&](Simulation& s) { s.apply(CutTool{{JointId(0u), joint}}); });
    leaves_no_trace([&](Simulation& s) { s.apply(RemoveTool{{member}, {}, {}}); });
    leaves_no_trace([&](Simulation& s) { s.apply(RemoveTool{{}, {panel}, {}}); });
    leaves_no_trace([&](Simulation& s) { s.apply(RemoveTool{{}, {}, {node}}); });
    leaves_no_trace([&](Simulation& s) { s.apply(WeakenTool{{joint}, {}, 0.5, 1, 0, 1}); });
    leaves_no_trace([&](Simulation& s) { s.apply(WeakenTool{{}, {member}, 0.5, 0.5, 0, 1}); });
    leaves_no_trace([&](Simulation& s) { s.apply(LoadTool{{{node, Vec6::Ones()}}}); });
    leaves_no_trace([&](Simulation& s) {
      HostContact contact = sound_contact();
      contact.member = member;
      s.touch(contact);
    });
  }
  Simulation simulation = portal();
  CHECK_THROWS_WITH(simulation.body_of(MemberId(3u)), "body_of: there is no member with index 3 (there are 3)");
  CHECK_THROWS_AS(simulation.what_carries(PanelId()), std::out_of_range);
}

TEST_CASE("numbers that physics has no use for are told by every tool, and not recorded") {
  for (const double bad : no_numbers) {
    const Vec3 place(0, bad, 0);
    leaves_no_trace([&](Simulation& s) { s.apply(Projectile{place, Vec3::UnitX(), 10, 0.2}); });
    leaves_no_trace([&](Simulation& s) { s.apply(Projectile{Vec3::Zero(), place, 10, 0.2}); });
    leaves_no_trace([&](Simulation& s) { s.apply(Projectile{Vec3::Zero(), Vec3::UnitX(), bad, 0.2}); });
    leaves_no_trace([&](Simulation& s) { s.apply(Projectile{Vec3::Zero(), Vec3::UnitX(), 10, bad}); });
    leaves_no_trace([&](Simulation& s) { s.apply(WreckingBall{place, Vec3::Zero(), 5, 100, 0.5}); });
    leaves_no_trace([&](Simulation& s) { s.apply(WreckingBall{Vec3::Zero(), Vec3::Zero(), bad, 100, 0.5}); });
    leaves_no_trace([&](Simulation& s) { s.apply(ChargeTool{place, 2, 0, 1}); });
    leaves_no_trace([&](Simulation& s) { s.apply(ChargeTool{Vec3::Zero(), bad, 0, 1}); });
    leaves_no_trace([&](Simulation& s) { s.apply(ChargeTool{Vec3::Zero(), 2, bad, 1}); });
    leaves_no_trace([&](Simulation& s) { s.apply(WeakenTool{{JointId(0u)}, {}, bad, 1, 0, 1}); });
    leaves_no_trace([&](Simulation& s) { s.apply(WeakenTool{{JointId(0u)}, {}, 1, bad, 0, 1}); });
    leaves_no_trace([&](Simulation& s) { s.apply(WeakenTool{{JointId(0u)}, {}, 1, 1, bad, 1}); });
    leaves_no_trace([&](Simulation& s) { s.apply(GravityTool{place}); });
    leaves_no_trace([&](Simulation& s) { s.apply(LoadTool{{{NodeId(1u), Vec6::Constant(bad)}}}); });
    for (const auto& spoil : std::vector<std::function<void(HostContact&)>>{
             [&](HostContact& c) { c.mass = bad; }, [&](HostContact& c) { c.inertia(1, 2) = bad; },
             [&](HostContact& c) { c.normal = place; }, [&](HostContact& c) { c.point = place; },
             [&](HostContact& c) { c.centre = place; }, [&](HostContact& c) { c.velocity = place; },
             [&](HostContact& c) { c.angular_velocity = place; }})
      leaves_no_trace([&](Simulation& s) {
        HostContact contact = sound_contact();
        spoil(contact);
        s.touch(contact);
      });
  }
  for (const double bad : {no_number, -1.0, -unlimited})
    leaves_no_trace([&](Simulation& s) {
      std::pair<JointId, JointCapacity> change{JointId(0u), same_capacity(1e6)};
      change.second.value[3] = bad;
      s.set_capacities({&change, 1});
    });
  for (const double bad : {no_number, -1.0, 1e-145, 1e-7, 101.0, unlimited})
    leaves_no_trace([&](Simulation& s) {
      std::pair<JointId, JointCapacity> change{JointId(0u), same_capacity(1e6)};
      change.second.ductility[5] = bad;
      s.set_capacities({&change, 1});
    });
  for (const int stages : {0, -1, std::numeric_limits<int>::max()})
    leaves_no_trace([&](Simulation& s) { s.apply(WeakenTool{{JointId(0u)}, {}, 0.5, 1, 1, stages}); });
}

TEST_CASE("a contact with a body that is gone, or never was, does nothing") {
  Simulation simulation = portal();
  for (const std::int64_t body : {std::int64_t{0}, std::int64_t{7}, std::numeric_limits<std::int64_t>::max()}) {
    HostContact contact = sound_contact();
    contact.member = MemberId();
    contact.body.value = body;
    CHECK_NOTHROW(simulation.touch(contact));
    CHECK_NOTHROW(simulation.step());
    CHECK(simulation.host_impulses().front().impulse.norm() == 0);
  }
}

TEST_CASE("a ray from nowhere to nowhere hits nothing") {
  const Simulation simulation = portal();
  for (const double bad : no_numbers) {
    CHECK_FALSE(simulation.ray_cast(Vec3(bad, 0, 2), Vec3(no_number, 0, 0)));
    CHECK_FALSE(simulation.ray_cast(Vec3(no_number, 0, 2), Vec3::UnitX()));
  }
  CHECK_FALSE(simulation.ray_cast(Vec3(0, 0, 2), Vec3::Zero()));
}

TEST_CASE("a scene whose rules mean nothing is refused before it begins") {
  const auto begin = [](const std::function<void(Scenario&)>& spoil) {
    Simulation sound = portal();
    Scenario scenario = sound.scenario();
    spoil(scenario);
    return Simulation(sound.building(), scenario);
  };
  for (const double bad : no_numbers) {
    CHECK_THROWS_AS(begin([&](Scenario& s) { s.step = bad; }), InputError);
    CHECK_THROWS_AS(begin([&](Scenario& s) { s.duration = bad; }), InputError);
    CHECK_THROWS_AS(begin([&](Scenario& s) { s.ground = bad; }), InputError);
    CHECK_THROWS_AS(begin([&](Scenario& s) { s.failure.sudden = bad; }), InputError);
    CHECK_THROWS_AS(begin([&](Scenario& s) { s.impact.restitution = bad; }), InputError);
    CHECK_THROWS_AS(begin([&](Scenario& s) { s.debris.friction = bad; }), InputError);
    CHECK_THROWS_AS(begin([&](Scenario& s) { s.events = {{bad, GravityTool{}}}; }), InputError);
    CHECK_THROWS_AS(begin([&](Scenario& s) { s.events = {{1, GravityTool{Vec3(0, 0, bad)}}}; }), InputError);
  }
  CHECK_THROWS_AS(begin([](Scenario& s) { s.combination = CombinationId(9u); }), std::out_of_range);
  CHECK_THROWS_AS(begin([](Scenario& s) { s.events = {{1, CutTool{{JointId(99u)}}}}; }), std::out_of_range);
}

TEST_CASE("a snapshot that is cut, changed in any byte, or of another scene is refused, and the run stays as it was") {
  Simulation simulation = portal();
  simulation.apply(CutTool{{JointId(1u)}});
  for (int i = 0; i < 5; ++i) simulation.step();
  const Snapshot saved = simulation.save();
  const std::string bytes = snapshot_bytes(saved);
  CHECK_NOTHROW(parse_snapshot(bytes, "whole"));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    CHECK_THROWS_AS(parse_snapshot(bytes.substr(0, i), "cut"), InputError);
    std::string changed = bytes;
    changed[i] = static_cast<char>(changed[i] ^ 0x10);
    CHECK_THROWS_AS(parse_snapshot(changed, "changed"), InputError);
  }
  CHECK_THROWS_AS(parse_snapshot(bytes + "x", "longer"), InputError);

  auto [building, scenario] =
      parse_scenario(R"({"topple": 1, "model": "seed_building", "combination": "collapse"})", "s", {});
  Simulation other(std::move(building), std::move(scenario));
  const std::uint64_t before = other.hash();
  CHECK_THROWS_AS(other.restore(saved), InputError);
  CHECK(other.hash() == before);
}
