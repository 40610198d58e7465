// Impacts in the running simulation against closed forms: nothing of them depends on the time step.
#include <catch2/catch.hpp>
#include <cmath>

#include "ballistic_world.h"
#include "frame_builder.h"
#include "struck_beam.h"
#include "topple/structure/error.h"
#include "topple/structure/simulation.h"

using namespace topple::structure;
using topple::test::BallisticWorld;
using topple::test::FrameBuilder;
using topple::test::same_capacity;

namespace {

constexpr double g = 10, length = 6;

/// A beam between two fixed ends; its own weight is small against the bodies that hit it.
FrameBuilder beam_between_walls(const JointCapacity& joint = {}) {
  return topple::test::beam_between_walls(length, -10, joint);
}

Scenario dropping(double step, double height, double mass, bool structure_mass = false) {
  Scenario scenario;
  scenario.standing = StandingRule::statics;
  scenario.combination = CombinationId(0u);
  scenario.step = step;
  scenario.duration = 5;
  scenario.impact.structure_mass = structure_mass;
  scenario.impact.restitution = 0;
  Projectile ball;
  ball.radius = 0.25;
  ball.from = Vec3(length / 2, 0, 5 + 0.1 + ball.radius + height);
  ball.velocity = Vec3(0, 0, 0);
  ball.mass = mass;
  scenario.events = {{0.1, ball}};
  return scenario;
}

SimulationOptions ballistic() {
  return {1, [] { return std::make_unique<BallisticWorld>(); }};
}

const SimulationEvent* first(const Simulation& simulation, SimulationEvent::Kind kind) {
  for (const SimulationEvent& event : simulation.events())
    if (event.kind == kind) return &event;
  return nullptr;
}

const SimulationEvent& run_to_impact(Simulation& simulation) {
  while (!simulation.finished() && !first(simulation, SimulationEvent::Kind::impact)) simulation.step();
  const SimulationEvent* event = first(simulation, SimulationEvent::Kind::impact);
  REQUIRE(event != nullptr);
  return *event;
}

double stiffness(const Building& building) {
  return 192 * building.materials[0].youngs_modulus * building.sections[0].Iy / std::pow(length, 3);
}

}  // namespace

TEST_CASE("a weight dropped on a light elastic beam is felt alike at every step") {
  const double mass = 200, weight = mass * g;
  for (const double step : {1.0 / 60, 1.0 / 120, 1.0 / 240})
    for (const double height : {0.02, 0.5, 3.0}) {
      Simulation simulation(beam_between_walls().building, dropping(step, height, mass), ballistic());
      const SimulationEvent& impact = run_to_impact(simulation);
      const double d = weight / stiffness(simulation.building());
      // The touch is found to 1e-14 s and free flight is exact, so only rounding is left.
      CHECK(impact.peak_force == Approx(weight * (1 + std::sqrt(1 + 2 * height / d))).epsilon(1e-9));
      CHECK(impact.speed_in == Approx(std::sqrt(2 * g * height)).epsilon(1e-9));
      CHECK(impact.name == "AB");
    }
}

TEST_CASE("a body goes on through what it breaks with the speed that energy leaves") {
  const double limit = 5e4, mass = 500, height = 3;
  Simulation simulation(beam_between_walls(same_capacity(limit)).building, dropping(1.0 / 60, height, mass),
                        ballistic());
  const SimulationEvent impact = run_to_impact(simulation);
  // Both ends fail together, at the moment F L / 8 (the beam's own weight adds 10 N/m).
  const double force = (limit - 10 * length * length / 12) * 8 / length;
  const double squared =
      2 * g * height - (force * force - 2 * mass * g * force) / (stiffness(simulation.building()) * mass);
  CHECK(impact.speed_out == Approx(std::sqrt(squared)).epsilon(1e-6));
  CHECK(impact.peak_force == Approx(force).epsilon(1e-6));
  int broken = 0;
  for (const SimulationEvent& event : simulation.events()) {
    if (event.kind != SimulationEvent::Kind::joint_broke) continue;
    ++broken;
    CHECK(event.joint.cause == BreakCause::impact);
    CHECK(event.joint.sense == Sense::moment_y);
  }
  CHECK(broken == 2);
  CHECK(!simulation.frame().stands(MemberId(0u)));
  REQUIRE(simulation.bodies().size() == 2);
}

TEST_CASE("what an impact breaks off takes the momentum of the share that moved with the body") {
  const double limit = 5e4, mass = 500, height = 3;
  FrameBuilder f = beam_between_walls(same_capacity(limit));
  f.load(MemberId(0u), -400);  // 2460 N: 246 kg
  Simulation simulation(f.building, dropping(1.0 / 60, height, mass, true), ballistic());
  const SimulationEvent impact = run_to_impact(simulation);
  // The Rayleigh mass of a clamped beam under a force in its middle is 13/35 of its own (integral of the shape squared,
  // shape 12 s^2 - 16 s^3 on each half).
  const double beam_mass = 410 * length / g, share = 13.0 / 35 * beam_mass;
  const double speed = std::sqrt(2 * g * height) * mass / (mass + share);
  const double force = (limit - 410 * length * length / 12) * 8 / length;
  const double squared =
      speed * speed - (force * force - 2 * mass * g * force) / (stiffness(f.building) * (mass + share));
  CHECK(impact.speed_out == Approx(std::sqrt(squared)).epsilon(1e-6));
  const double fall = simulation.frame().displacement(NodeId(0u)).norm();
  CHECK(fall == 0);  // the supports stand
  for (const BodyView& body : simulation.bodies()) CHECK(body.mass > 0);
}

namespace {

/// Two beams side by side, and a ball that falls into the gap between them: it touches both at once, 0.8 sideways and
/// 0.6 down.
struct TwoBeams {
  explicit TwoBeams(const JointCapacity& joint) {
    frame.load_case();
    for (const double y : {-0.3, 0.3}) {
      const std::string name = y < 0 ? "L" : "R";
      const NodeId a = frame.node("A" + name, 0, y, 5), b = frame.node("B" + name, length, y, 5);
      frame.load(frame.member(name, MemberKind::beam, a, b, joint, joint), -10);
      frame.support(a);
      frame.support(b);
    }
    scenario = dropping(1.0 / 60, height, mass);
    std::get<Projectile>(scenario.events[0].tool).from = Vec3(length / 2, 0, 5.1 + 0.15 + height);
  }
  /// Along the normal, at mid-span.
  [[nodiscard]] double compliance() const {
    const Section& bar = frame.building.sections[0];
    return length * length * length / (192 * frame.building.materials[0].youngs_modulus) *
           (0.6 * 0.6 / bar.Iy + 0.8 * 0.8 / bar.Iz);
  }
  static constexpr double height = 2, mass = 400;
  FrameBuilder frame;
  Scenario scenario = [] {
    Scenario still;
    still.standing = StandingRule::statics;
    return still;
  }();
};

std::vector<SimulationEvent> impacts(const Simulation& simulation) {
  std::vector<SimulationEvent> found;
  for (const SimulationEvent& event : simulation.events())
    if (event.kind == SimulationEvent::Kind::impact) found.push_back(event);
  return found;
}

}  // namespace

TEST_CASE("a ball that falls between two beams pushes both at once") {
  const TwoBeams two({});
  Simulation simulation(two.frame.building, two.scenario, ballistic());
  run_to_impact(simulation);
  const std::vector<SimulationEvent> found = impacts(simulation);
  REQUIRE(found.size() == 2);
  CHECK(simulation.counters().impacts_together == 1);
  // The ball sinks by q, each beam gives way by 0.6 q: a weight on a spring of 2 x 0.36 / compliance.
  const double soft = two.compliance() / 0.72, weight = two.mass * g, speed = std::sqrt(2 * g * two.height);
  const double sinks = weight * soft + std::sqrt(weight * soft * weight * soft + two.mass * speed * speed * soft);
  for (const SimulationEvent& one : found) {
    CHECK(one.speed_in == Approx(0.6 * speed).epsilon(1e-9));
    CHECK(one.peak_force == Approx(0.6 * sinks / two.compliance()).epsilon(1e-9));
    CHECK(std::abs(one.speed_out) < 1e-6 * speed);  // where the energy is greatest, to the root of its rounding
  }
  CHECK(simulation.ledger().momentum_error < 1e-12);
  CHECK(simulation.ledger().lost_in_impacts == Approx(two.mass * speed * speed / 2).epsilon(1e-9));
}

TEST_CASE("a ball goes on between the two beams that it breaks with the speed that energy leaves") {
  const double limit = 5e4;
  const TwoBeams two(same_capacity(limit));
  Simulation simulation(two.frame.building, two.scenario, ballistic());
  run_to_impact(simulation);
  const std::vector<SimulationEvent> found = impacts(simulation);
  REQUIRE(found.size() == 2);
  // All four ends fail together, by the sideways moment 0.8 F L/8.
  const double force = limit * 8 / (0.8 * length), sunk = force * two.compliance() / 0.6;
  const double speed = std::sqrt(2 * g * two.height);
  const double left = std::sqrt(speed * speed + 2 * g * sunk - 2 * force * force * two.compliance() / two.mass);
  REQUIRE(left < speed);
  for (const SimulationEvent& one : found) {
    CHECK(one.peak_force == Approx(force).epsilon(1e-6));
    CHECK(one.speed_out == Approx(0.6 * left).epsilon(1e-6));
  }
  int broken = 0;
  for (const SimulationEvent& event : simulation.events())
    if (event.kind == SimulationEvent::Kind::joint_broke) ++broken;
  CHECK(broken == 4);
  while (simulation.time() < 1) simulation.step();
  CHECK(simulation.ledger().momentum_error < 1e-12);
  CHECK(std::abs(simulation.ledger().residual()) < 1e-9);
}

TEST_CASE("free flight is exact at every step") {
  for (const double step : {1.0 / 60, 1.0 / 7}) {
    Scenario scenario = dropping(step, 100, 50);
    Projectile ball = std::get<Projectile>(scenario.events[0].tool);
    ball.from = Vec3(-500, 100, 200);
    ball.velocity = Vec3(30, -4, 12);
    scenario.events[0].tool = ball;
    Simulation simulation(beam_between_walls().building, scenario, ballistic());
    while (!simulation.finished()) simulation.step();
    // It acts in the first step with k dt >= 0.1 s and flies from that step's start.
    const auto born = static_cast<double>(std::ceil(0.1 / step - 1e-6)) - 1;
    const double t = simulation.time() - born * step;
    REQUIRE(simulation.bodies().size() == 1);
    const Vec3 expected = ball.from + ball.velocity * t + Vec3(0, 0, -g) * t * t / 2;
    CHECK((simulation.bodies()[0].pose.position - expected).norm() < 1e-9);
    const Ledger& ledger = simulation.ledger();
    const Vec3 velocity = ball.velocity + Vec3(0, 0, -g) * t;
    CHECK(ledger.kinetic_translation == Approx(50 * velocity.squaredNorm() / 2).epsilon(1e-12));
    CHECK(std::abs(ledger.residual()) < 1e-12);
  }
}

TEST_CASE("energy and momentum are accounted for through an impact that breaks") {
  FrameBuilder f = beam_between_walls(same_capacity(5e4));
  f.load(MemberId(0u), -400);
  Simulation simulation(f.building, dropping(1.0 / 60, 3, 500, true), ballistic());
  while (simulation.time() < 2) simulation.step();
  REQUIRE(!simulation.frame().stands(MemberId(0u)));
  CHECK(std::abs(simulation.ledger().residual()) < 1e-9);
  CHECK(simulation.ledger().momentum_error < 1e-12);
  CHECK(simulation.ledger().lost_in_impacts > 0);
}

TEST_CASE("shapes are made only for what a body comes near") {
  const auto run = [](double x) {
    FrameBuilder f = beam_between_walls();
    const NodeId c = f.node("C", 200, 0, 5), d = f.node("D", 206, 0, 5);
    f.building.joints.clear();
    f.building.members.clear();
    f.member("AB", MemberKind::beam, NodeId(0u), NodeId(1u));
    f.member("CD", MemberKind::beam, c, d);
    f.support(c);
    f.support(d);
    f.load(MemberId(1u), -10);
    Scenario scenario = dropping(1.0 / 60, 3, 200);
    std::get<Projectile>(scenario.events[0].tool).from.x() = x;
    BallisticWorld* world = nullptr;
    Simulation simulation(f.building, scenario, {1, [&] {
                                                   auto made = std::make_unique<BallisticWorld>();
                                                   world = made.get();
                                                   return made;
                                                 }});
    for (int i = 0; i < 120; ++i) simulation.step();
    return std::pair(world->obstacle_count(), simulation.events().size());
  };
  CHECK(run(3).first == 1);
  CHECK(run(203).first == 1);
  CHECK(run(100).first == 0);
}

TEST_CASE("a part that weighs nothing is an error that names it") {
  FrameBuilder f = beam_between_walls();
  f.building.cases[0].members.clear();
  CHECK_THROWS_WITH(Simulation(f.building, dropping(1.0 / 60, 1, 1), ballistic()), Catch::Contains("members.AB"));
}

TEST_CASE("what nobody touches costs nothing") {
  Scenario scenario = dropping(1.0 / 60, 3, 200);
  scenario.events.clear();
  scenario.until_rest = false;
  Simulation simulation(beam_between_walls().building, scenario, ballistic());
  simulation.step();
  const SimulationCounters first_step = simulation.counters();
  const Vec6 before = simulation.frame().displacement(NodeId(1u));
  while (!simulation.finished()) simulation.step();
  CHECK(simulation.steps() == 300);
  CHECK(simulation.counters().steps_idle == 299);
  CHECK(simulation.counters().solves == first_step.solves);
  CHECK(simulation.counters().segmentations == first_step.segmentations);
  CHECK(simulation.counters().collision_steps == 0);
  CHECK((simulation.frame().displacement(NodeId(1u)).array() == before.array()).all());
}

TEST_CASE("steps passed over keep their numbers") {
  const auto run = [](bool skip) {
    Scenario scenario = dropping(1.0 / 60, 3, 200);
    scenario.events[0].at = 2;
    scenario.duration = 3;
    Simulation simulation(beam_between_walls().building, scenario, ballistic());
    while (!simulation.finished()) {
      if (skip) simulation.skip_idle();
      simulation.step();
    }
    return std::tuple(simulation.hash(), simulation.steps(), simulation.counters().steps_idle,
                      simulation.events().size());
  };
  CHECK(run(true) == run(false));
}
