// What a host sees and does: its own bodies, its own collision world, what changed, what carries what.
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "ballistic_world.h"
#include "frame_builder.h"
#include "struck_beam.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/simulation.h"

using namespace topple::structure;
namespace collision = topple::collision;
using topple::test::BallisticWorld;
using topple::test::FrameBuilder;
using topple::test::same_capacity;

namespace {

constexpr double length = 6;

FrameBuilder beam_between_walls(const JointCapacity& joint = {}) {
  return topple::test::beam_between_walls(length, -1000, joint);
}

Scenario quiet(bool structure_mass = false) {
  Scenario scenario;
  scenario.standing = StandingRule::statics;
  scenario.combination = CombinationId(0u);
  scenario.duration = 100;
  scenario.until_rest = false;
  scenario.ground = 0;
  scenario.impact.structure_mass = structure_mass;
  return scenario;
}

HostContact into_the_middle(double speed) {
  HostContact contact;
  contact.key = 42;
  contact.member = MemberId(0u);
  contact.point = Vec3(length / 2, -0.1, 5);
  contact.normal = Vec3::UnitY();
  contact.mass = 1500;
  contact.inertia = 2000 * Mat3::Identity();
  contact.centre = Vec3(length / 2, -2, 5);
  contact.velocity = Vec3(0, speed, 0);
  return contact;
}

/// Counts what it was asked, and lets Bullet do it.
class RecordingWorld final : public BallisticWorld {
 public:
  explicit RecordingWorld(std::vector<std::string>& log) : log_(log) {}
  collision::BodyId add_body(const collision::BodyDescription& description) override {
    log_.push_back("add body of " + std::to_string(std::lround(description.mass)) + " kg");
    return BallisticWorld::add_body(description);
  }
  void remove_body(collision::BodyId id) override {
    log_.push_back("remove body");
    BallisticWorld::remove_body(id);
  }
  collision::ObstacleId add_obstacle(const collision::ObstacleDescription& description) override {
    log_.push_back("add obstacle");
    return BallisticWorld::add_obstacle(description);
  }
  void step(double dt) override {
    log_.push_back("step");
    BallisticWorld::step(dt);
  }

 private:
  std::vector<std::string>& log_;
};

}  // namespace

TEST_CASE("a host's body that strikes gets the impulse of the law of impact back") {
  Simulation simulation(beam_between_walls().building, quiet());
  simulation.step();
  simulation.touch(into_the_middle(8));
  simulation.step();
  REQUIRE(simulation.host_impulses().size() == 1);
  const HostImpulse& felt = simulation.host_impulses()[0];
  CHECK(felt.key == 42);
  CHECK(felt.speed_in == Approx(8));
  CHECK_FALSE(felt.through);
  // Horizontal and central: no weight, the whole mass. It comes back with the scenario's restitution.
  CHECK(felt.speed_out == Approx(-0.1 * 8).epsilon(1e-9));
  CHECK((felt.impulse - Vec3(0, -1500 * 8.8, 0)).norm() < 1e-6 * 1500 * 8.8);
  bool told = false;
  for (const SimulationEvent& event : simulation.events())
    if (event.kind == SimulationEvent::Kind::impact) {
      told = true;
      CHECK(event.body_name == "host 42");
      const double k = 192 * simulation.building().materials[0].youngs_modulus * simulation.building().sections[0].Iz /
                       std::pow(length, 3);
      CHECK(event.peak_force == Approx(8 * std::sqrt(1500 * k)).epsilon(1e-9));
    }
  CHECK(told);
  CHECK(simulation.bodies().empty());  // it was never the simulation's
  CHECK(std::abs(simulation.ledger().residual()) < 1e-9);
  simulation.step();
  CHECK(simulation.host_impulses().empty());
}

TEST_CASE("a host's body that breaks what stands goes on with what is left") {
  Simulation simulation(beam_between_walls(same_capacity(3e4)).building, quiet());
  simulation.step();
  simulation.touch(into_the_middle(8));
  simulation.step();
  REQUIRE(simulation.host_impulses().size() == 1);
  CHECK(simulation.host_impulses()[0].through);
  CHECK(simulation.host_impulses()[0].speed_out > 7);
  CHECK(simulation.changes().made.size() == 1);
  CHECK(simulation.changes().made == simulation.changes().moved);
  REQUIRE(simulation.bodies().size() == 1);
  REQUIRE(simulation.poses().size() == 7);
  CHECK(simulation.poses()[1] == simulation.bodies()[0].pose.position.y());

  // And pushes the debris with Newton's law: equal and opposite, apart with the restitution.
  const BodyView& beam = simulation.bodies()[0];
  HostContact second = into_the_middle(20);
  second.member = MemberId();
  second.body = beam.id;
  second.point = beam.pose.position;
  second.centre = beam.pose.position - Vec3(0, 2, 0);
  simulation.touch(second);
  simulation.step();
  REQUIRE(simulation.host_impulses().size() == 1);
  const HostImpulse& push = simulation.host_impulses()[0];
  CHECK(push.impulse.y() < 0);
  CHECK(push.speed_out < 20);
}

TEST_CASE("contacts that are not sound are refused, and those with what fell do nothing") {
  Simulation simulation(beam_between_walls(same_capacity(3e4)).building, quiet());
  simulation.step();
  HostContact contact = into_the_middle(8);
  contact.mass = 0;
  CHECK_THROWS_WITH(simulation.touch(contact), Catch::Contains("host contact 42: its mass"));
  contact = into_the_middle(8);
  contact.normal = Vec3(0, 2, 0);
  CHECK_THROWS_AS(simulation.touch(contact), InputError);
  contact = into_the_middle(8);
  contact.body.value = 3;
  CHECK_THROWS_AS(simulation.touch(contact), InputError);
  for (int i = 0; i < 2; ++i) {
    simulation.touch(into_the_middle(8));
    simulation.step();
  }
  REQUIRE(simulation.host_impulses().size() == 1);  // the beam is gone: a miss
  CHECK(simulation.host_impulses()[0].impulse == Vec3(0, 0, 0));
  CHECK(simulation.host_impulses()[0].speed_out == 8);
}

TEST_CASE("a host's own collision world is asked in the order of the step, and idle steps ask nothing") {
  std::vector<std::string> log;
  SimulationOptions options;
  options.make_world = [&] { return std::make_unique<RecordingWorld>(log); };
  Simulation simulation(beam_between_walls(same_capacity(3e4)).building, quiet(), options);
  for (int i = 0; i < 10; ++i) simulation.step();
  CHECK(log.empty());
  simulation.touch(into_the_middle(8));
  simulation.step();
  const std::vector<std::string> expected{"add body of 1500 kg", "add obstacle", "remove body", "add body of 600 kg",
                                          "step"};
  CHECK(log == expected);
}

TEST_CASE("what carries a post's load is its foot and the post under it, and what is weakest would break next") {
  FrameBuilder f = topple::test::grid_building(2, 2, 2, 5, 3, same_capacity(1e6), same_capacity(5e5));
  for (std::size_t m = 0; m < f.building.members.size(); ++m) f.load(MemberId(m), -3000);
  Simulation simulation(f.building, quiet());
  const NameIndex names(simulation.building());
  const auto carriers = simulation.what_carries(*names.member("P-1-1-2"));
  REQUIRE(carriers.size() >= 2);
  std::set<std::string> most;
  for (std::size_t i = 0; i < 2; ++i) {
    most.insert(simulation.building()[carriers[i].joint].name);
    CHECK(carriers[i].share > 0.9);  // beams take the little that the post's shortening brings them
    CHECK(carriers[i].share <= 1 + 1e-9);
  }
  CHECK(most == std::set<std::string>{"P-1-1-1:1", "P-1-1-2:1"});

  const auto next = simulation.next_to_break(3);
  REQUIRE(next.size() == 3);
  CHECK(next[0].second.value >= next[1].second.value);
  double largest = 0;
  for (std::size_t j = 0; j < simulation.building().joints.size(); ++j)
    largest = std::max(largest, simulation.frame().utilisation(JointId(j)).value);
  CHECK(next[0].second.value == largest);
  CHECK(simulation.next_to_break(100000).size() <= simulation.building().joints.size());
}
