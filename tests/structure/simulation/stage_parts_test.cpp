// The parts that a step goes through, from what bodies will touch to bodies made of what fell, each by itself.
#include <catch2/catch.hpp>

#include "simulation/debris/parting.h"
#include "simulation/stage_parts.h"
#include "structure/frame_builder.h"
#include "topple/structure/error.h"

namespace {

using namespace topple::test;
namespace collision = topple::collision;

constexpr double rounding = 1e-9;  // relative, of a few operations
constexpr double height = 4, weight = 1000;

/// A post, and on it an arm that hangs on one joint.
FrameBuilder post_and_arm() {
  FrameBuilder f;
  const NodeId foot = f.node("F", 0, 0, 0), head = f.node("H", 0, 0, height), tip = f.node("T", 2, 0, height);
  f.member("P", MemberKind::post, foot, head);
  f.member("A", MemberKind::beam, head, tip, same_capacity(1e12));
  f.support(foot);
  for (std::size_t m = 0; m < 2; ++m) f.load(MemberId(m), -weight);
  return f;
}

Scenario at_rest() {
  Scenario scenario;
  scenario.standing = StandingRule::statics;
  scenario.until_rest = false;
  scenario.duration = 1;
  return scenario;
}

struct Parts : StageParts {
  explicit Parts(const FrameBuilder& f, const Scenario& scenario = at_rest()) : StageParts(f.building, scenario, {}) {}

  collision::BodyId ball(const Vec3& at, double mass, const Vec3& velocity) {
    Body one;
    one.name = "ball";
    one.radius = 0.2;
    one.rest = sphere_mass(at, mass, one.radius);
    one.bounds.add(Vec3::Constant(-one.radius));
    one.bounds.add(Vec3::Constant(one.radius));
    return debris.add(std::move(one), velocity, Vec3::Zero(), Vec3::Zero());
  }
};

}  // namespace

TEST_CASE("the sweep makes shapes of what a body may reach in the step, and finds when and how fast it touches") {
  const FrameBuilder f = post_and_arm();
  Parts all(f);
  CHECK(all.sweep.contacts(all.scene.scenario.step, nullptr).empty());  // nothing is awake
  const double speed = 30, gap = 0.1, radius = 0.2;
  all.ball(Vec3(0, 50, 2), 10, Vec3(0, -speed, 0));
  CHECK(all.sweep.contacts(all.scene.scenario.step, nullptr).empty());
  CHECK(all.debris.obstacles.obstacle_of(Part(MemberId(0u))).value == -1);
  const double face = all.debris.shapes.bounds(Part(MemberId(0u))).high.y();
  const collision::BodyId near = all.ball(Vec3(0, face + radius + gap, 2), 10, Vec3(0, -speed, 0));
  const std::vector<collision::Contact> found = all.sweep.contacts(all.scene.scenario.step, nullptr);
  REQUIRE(found.size() == 1);
  CHECK(found[0].body.value == near.value);
  CHECK(all.debris.obstacles.part_of(found[0].other.obstacle) == Part(MemberId(0u)));
  CHECK(found[0].approach_speed == Approx(speed).epsilon(1e-3));            // gravity bends its way a little
  CHECK(all.debris.obstacles.obstacle_of(Part(MemberId(1u))).value == -1);  // the arm is out of reach
}

TEST_CASE("a host's body that pushes debris leaves it by Newton's law of impact, told once") {
  const FrameBuilder f = post_and_arm();
  Parts all(f);
  const double light = 10, heavy = 40, speed = 3, e = all.scene.scenario.impact.restitution;
  HostContact contact;
  contact.key = 7;
  contact.body = all.ball(Vec3(5, 0, 3), light, Vec3::Zero());
  contact.normal = Vec3::UnitX();
  contact.point = Vec3(4.8, 0, 3);
  contact.centre = Vec3(4, 0, 3);
  contact.mass = heavy;
  contact.inertia = Mat3::Identity();
  contact.velocity = Vec3(speed, 0, 0);
  all.hosts.add(contact);
  REQUIRE(all.hosts.waiting());
  all.hosts.strike_all();
  CHECK_FALSE(all.hosts.waiting());
  REQUIRE(all.hosts.impulses().size() == 1);
  const HostImpulse& felt = all.hosts.impulses()[0];
  // The ball's velocity is read half a step of gravity ahead, which is across the normal.
  const double reduced = light * heavy / (light + heavy);
  CHECK(felt.key == 7);
  CHECK(felt.impulse.x() == Approx(-(1 + e) * reduced * speed).epsilon(rounding));
  CHECK(felt.speed_out == Approx(speed - (1 + e) * reduced * speed / heavy).epsilon(rounding));
  CHECK(all.scene.world->state(contact.body).velocity.x() ==
        Approx((1 + e) * reduced * speed / light).epsilon(rounding));
  CHECK(all.sums.ledger.lost_in_impacts == Approx(reduced * speed * speed * (1 - e * e) / 2).epsilon(rounding));
  all.hosts.start_step();
  CHECK(all.hosts.impulses().empty());
}

TEST_CASE(
    "what left the frame becomes a body with its mass, and sleeping bodies over the limit go, the smallest first") {
  const FrameBuilder f = post_and_arm();
  Scenario scenario = at_rest();
  scenario.debris.limit = 1;
  Parts all(f, scenario);
  all.scene.step = 1;
  all.scene.frame->break_joint(f.building.joint(MemberId(1u), 0), BreakCause::tool);
  (void)all.scene.frame->settle();
  all.release.release();
  REQUIRE(all.debris.bodies.size() == 1);
  const std::int64_t arm = all.debris.bodies.begin()->first;
  CHECK(all.debris.body_of(Part(MemberId(1u))) == arm);
  CHECK(all.debris.bodies.at(arm).rest.mass == Approx(2 * weight / f.building.gravity).epsilon(rounding));
  CHECK(all.debris.bodies.at(arm).rest.centre.x() == Approx(1).epsilon(rounding));
  CHECK(all.sums.ledger.momentum_error < 1e-12);

  const collision::BodyId ball = all.ball(Vec3(9, 9, 0.2), 1, Vec3::Zero());
  all.release.keep_limit();
  CHECK(all.debris.bodies.size() == 2);  // none sleeps
  for (const collision::BodyId id : {ball, collision::BodyId{arm}}) {
    collision::BodyState state = all.scene.world->state(id);
    state.velocity = Vec3::Zero();
    state.asleep = true;
    all.scene.world->set_state(id, state);
  }
  all.release.keep_limit();
  REQUIRE(all.debris.bodies.size() == 1);
  CHECK(all.debris.bodies.begin()->first == arm);
  CHECK(all.log.events().back().kind == SimulationEvent::Kind::limited);
}

TEST_CASE("what breaks off while it is pushed parts from the body by Newton's restitution, momentum kept") {
  const FrameBuilder f = post_and_arm();
  Parts all(f);
  all.scene.step = 1;
  const double ball_mass = 2000, arm_mass = 2 * weight / f.building.gravity, closing = 5, e = 0.3;
  const Vec3 down(0, 0, -1);
  // It came down on the arm's middle. Of free bodies 1 + e times this is the impulse.
  const double of_free = closing / (1 / ball_mass + 1 / arm_mass), times = GENERATE(20.0, 0.5);
  const double impulse = times * of_free;
  const collision::BodyId ball = all.ball(Vec3(1, 0, height + 0.3), ball_mass, (closing - impulse / ball_mass) * down);
  PartingContact pushed;
  pushed.part = Part(MemberId(1u));
  pushed.contact.body = ball;
  pushed.contact.point = Vec3(1, 0, height);
  pushed.contact.normal = down;
  pushed.contact.impulse = impulse * down;
  CHECK(limit_parting(all.debris, {&pushed, 1}, e) == 0);  // the arm is no body

  all.scene.frame->break_joint(f.building.joint(MemberId(1u), 0), BreakCause::tool);
  (void)all.scene.frame->settle();
  all.release.release();
  const collision::BodyId arm{all.debris.body_of(pushed.part)};
  all.scene.world->apply_impulse(arm, impulse * down, all.scene.world->state(arm).pose.position);
  const auto speed = [&](collision::BodyId id) {
    return all.scene.reading().true_velocity(all.scene.world->state(id).velocity).dot(down);
  };
  const auto kinetic = [&] { return (ball_mass * speed(ball) * speed(ball) + arm_mass * speed(arm) * speed(arm)) / 2; };
  const double had = kinetic(),
               start = speed(arm) - impulse / arm_mass;  // a sixtieth of a second's fall, read at mid-step
  const bool too_much = times > 1 + e;
  const double lost = limit_parting(all.debris, {&pushed, 1}, e);
  CHECK(ball_mass * speed(ball) + arm_mass * speed(arm) ==
        Approx(ball_mass * closing + arm_mass * start).epsilon(rounding));
  CHECK(lost == Approx(had - kinetic()).margin(rounding * had));
  if (too_much)
    CHECK(speed(arm) - speed(ball) == Approx(e * closing).epsilon(1e-4));  // the arm has sunk a little, and turns
  else
    CHECK(lost == 0);
}

TEST_CASE("the account of bodies: gravity's work is what a body that falls freely gains") {
  const FrameBuilder f = post_and_arm();
  Parts all(f);
  const double mass = 10, dt = all.scene.scenario.step, g = f.building.gravity;
  all.ball(Vec3(5, 5, 20), mass, Vec3::Zero());
  all.scene.step = 1;
  for (int step = 0; step < 10; ++step) {
    all.bodies.start_step();
    all.bodies.start_motion();
    all.scene.world->step(dt);
    all.bodies.count_contacts();
    all.bodies.count_bodies();
  }
  CHECK(all.bodies.contacts().empty());
  const double fallen = g * (10 * dt) * (10 * dt) / 2;
  CHECK(all.sums.body_gravity_work == Approx(mass * g * fallen).epsilon(rounding));
  all.bodies.bring_ledger_up_to_date();
  CHECK(all.sums.ledger.kinetic_translation == Approx(mass * g * fallen).epsilon(rounding));
  CHECK(all.sums.ledger.lost_in_contacts == 0);
}

TEST_CASE("a run's progress: idle until an event is due, rest told whenever it begins, the end once") {
  const FrameBuilder f = post_and_arm();
  Scenario scenario = at_rest();
  CutTool cut;
  cut.joints = {f.building.joint(MemberId(1u), 0)};
  scenario.events = {{0.5, cut}};
  Parts all(f, scenario);
  CHECK_FALSE(all.progress.idle());  // the first step computes
  all.scene.step = 1;
  CHECK(all.progress.skip_idle_before(60) == 28);  // step 30 is at 0.5 s
  all.scene.step = 29;
  CHECK(all.progress.idle());
  CHECK_FALSE(all.progress.rests());  // something is to come
  all.scene.step = 30;
  CHECK_FALSE(all.progress.idle());
  all.tools.use();
  CHECK_FALSE(all.progress.rests());
  (void)all.scene.frame->settle();
  CHECK(all.progress.rests());
  all.progress.record();
  all.progress.record();
  CHECK(all.log.events().back().kind == SimulationEvent::Kind::at_rest);
  const std::size_t told = all.log.size();
  all.scene.step = 60;
  all.progress.record();
  all.progress.record();
  CHECK(all.log.size() == told + 1);
  CHECK(all.log.events().back().kind == SimulationEvent::Kind::done);
}

TEST_CASE("the record of actions keeps their steps, and the capacities that joints had at the start") {
  const FrameBuilder f = post_and_arm();
  Parts all(f);
  const JointId joint = f.building.joint(MemberId(1u), 0);
  all.scene.step = 4;
  all.actions.add(Tool(CutTool{{joint}}));
  const std::pair<JointId, JointCapacity> first{joint, same_capacity(5e6)}, second{joint, same_capacity(6e6)};
  all.actions.give({&first, 1});
  all.actions.give({&second, 1});
  REQUIRE(all.actions.all().size() == 3);
  CHECK(all.actions.all()[0].step == 4);
  CHECK(all.scene.building[joint].capacity.value[0] == 6e6);
  CHECK(all.actions.building_at_start()[joint].capacity.value[0] == 1e12);
  for (const Snapshot::Action& action : all.actions.all()) CHECK_NOTHROW(require_parts(f.building, action));
  CHECK_THROWS_AS(require_parts(f.building, {0, Tool(CutTool{{JointId(99u)}})}), InputError);
}
