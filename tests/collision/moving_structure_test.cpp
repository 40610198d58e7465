// Bodies on what stands and moves: a platform of one mass on a spring, beside which the answers are known in closed
// form.
#include <catch2/catch.hpp>

#include <cmath>
#include <tuple>
#include <utility>

#include "world_builder.h"

using namespace collision_test;

namespace {

constexpr int kParts = 8;  // of a step
constexpr double kTop = 0.1;

/// A rigid platform that goes up and down on a spring, or along x as it is told.
class Platform final : public MovingStructure {
 public:
  double mass = 1000, stiffness = 0, height = 0, speed = 0;
  double force = 0, acceleration = 0;  ///< in the last part of a step
  double time = 0, along_amplitude = 0, along_frequency = 0;
  double work = 0, impulse = 0;  ///< of what lies on it
  double taken_lighter = 2;      ///< than it is, by the world
  bool moves = true;

  [[nodiscard]] std::optional<ObstacleMotion> motion(ObstacleId obstacle) override { return motion_of(obstacle); }
  [[nodiscard]] std::optional<ObstaclePath> path(ObstacleId obstacle) const override {
    const std::optional<ObstacleMotion> now = motion_of(obstacle);
    return now ? std::optional(now->path()) : std::nullopt;
  }
  [[nodiscard]] std::optional<ObstacleMotion> motion_of(ObstacleId obstacle) const {
    if (!moves || obstacle.value != 0) return std::nullopt;  // the first
    ObstacleMotion motion;
    const double w = along_frequency;
    motion.pose.position = Vec3(along_amplitude * (1 - std::cos(w * time)), 0, height);
    motion.velocity = Vec3(along_amplitude * w * std::sin(w * time), 0, speed);
    constexpr double part = kStep / kParts;
    const double foreseen = (after(part, force).second - speed) / part;
    motion.acceleration = Vec3(along_amplitude * w * w * std::cos(w * time), 0, foreseen);
    motion.last_acceleration = Vec3(along_amplitude * w * w * std::cos(w * (time - part)), 0, acceleration);
    motion.mass = mass / taken_lighter;
    motion.inertia = box_inertia(mass / taken_lighter, {2, 2, kTop});
    return motion;
  }

  /// Height and speed after so long under a force that lasts.
  [[nodiscard]] std::pair<double, double> after(double dt, double pushed) const {
    if (!(stiffness > 0)) return {height + (speed + pushed * dt / mass / 2) * dt, speed + pushed * dt / mass};
    const double w = std::sqrt(stiffness / mass), rest = pushed / stiffness, x = height - rest;
    return {rest + x * std::cos(w * dt) + speed / w * std::sin(w * dt),
            -x * w * std::sin(w * dt) + speed * std::cos(w * dt)};
  }

  /// Exactly, under the mean force of the part.
  void advance(double dt, std::span<const Contact> contacts, std::span<const HingePull> pulls) override {
    double pushed = 0;
    for (const Contact& contact : contacts) pushed += contact.impulse.z();
    for (const HingePull& pull : pulls) pushed += pull.impulse.z();
    impulse += pushed;
    const double before = height, was = speed;
    force = pushed / dt;
    std::tie(height, speed) = after(dt, force);
    work += force * (height - before);
    acceleration = (speed - was) / dt;
    time += dt;
  }
};

std::unique_ptr<World> world_with_platform() {
  auto world = world_with_gravity();
  ObstacleDescription platform;
  platform.parts = {box_part({2, 2, kTop})};
  platform.friction = 0.5;
  (void)world->add_obstacle(platform);
  return world;
}

BodyId add_box(World& world, double mass, double height) {
  BodyDescription box = box_body({0.5, 0.4, 0.2}, mass, {0, 0, height + kTop + 0.2});
  box.friction = 0.5;
  return world.add_body(box);
}

}  // namespace

TEST_CASE("a box laid on a platform on a spring sways with it as one mass", "[moving]") {
  const double mass = GENERATE(100.0, 1000.0, 10000.0);
  Platform platform;
  platform.taken_lighter = GENERATE(1.0, 2.0, 10.0);
  CAPTURE(mass, platform.taken_lighter);
  const double both = platform.mass + mass, frequency = 2;  // Hz
  platform.stiffness = both * std::pow(2 * M_PI * frequency, 2);
  const auto world = world_with_platform();
  const double sag = mass * kGravity / platform.stiffness;
  platform.height = -0.6 * sag;  // from there it goes on swinging by 0.4, and does not throw the box
  const BodyId box = add_box(*world, mass, platform.height);
  double lowest = 0, at = 0, apart = 0;
  for (int step = 0; step < 60; ++step) {
    world->step(kStep, kParts, platform);
    if (platform.height < lowest) {
      lowest = platform.height;
      at = platform.time;
    }
    apart = std::max(apart, std::abs(world->state(box).pose.position.z() - 0.2 - kTop - platform.height));
  }
  // Lowest half a period after the start, or an odd multiple of it.
  CHECK(lowest == Approx(-1.4 * sag).epsilon(0.03));
  CHECK(std::fmod(at * frequency, 1) == Approx(0.5).margin(0.04));
  CHECK(apart < 0.002);
}

TEST_CASE("a box that falls on a free platform shares its momentum with it", "[moving]") {
  const double mass = GENERATE(100.0, 1000.0, 10000.0);
  Platform platform;
  platform.taken_lighter = GENERATE(1.0, 2.0, 10.0);
  CAPTURE(mass, platform.taken_lighter);
  const auto world = world_with_platform();
  world->set_gravity(Vec3::Zero());
  const BodyId box = add_box(*world, mass, 0.01);
  BodyState state = world->state(box);
  state.velocity = Vec3(0, 0, -0.9);  // below where things bounce
  world->set_state(box, state);
  double lost = 0;
  for (int step = 0; step < 30; ++step) {
    world->step(kStep, kParts, platform);
    for (const Contact& contact : world->contacts()) lost += contact.work_lost;
  }
  const double both = -0.9 * mass / (mass + platform.mass);
  CHECK(mass * world->state(box).velocity.z() + platform.mass * platform.speed == Approx(-0.9 * mass).epsilon(1e-12));
  CHECK(platform.speed == Approx(both).epsilon(0.02));
  // What the box lost and the platform did not get is what plastic bodies lose.
  const double reduced = mass * platform.mass / (mass + platform.mass);
  CHECK(lost - platform.mass * platform.speed * platform.speed / 2 == Approx(reduced * 0.9 * 0.9 / 2).epsilon(0.02));
}

TEST_CASE("a platform that shakes along carries a box by friction, and slides under it beyond", "[moving]") {
  const auto world = world_with_platform();
  Platform platform;
  platform.mass = 1e9;
  platform.along_frequency = 2 * M_PI;
  const double held = 0.5 * kGravity / std::pow(platform.along_frequency, 2);  // amplitude at which it slides
  const BodyId box = add_box(*world, 500, 0);
  const auto shake = [&](double amplitude) {
    platform.along_amplitude = amplitude;
    platform.time = 0;
    double farthest = 0;
    const double start = world->state(box).pose.position.x();
    for (int step = 0; step < 60; ++step) {
      world->step(kStep, kParts, platform);
      const double own = world->state(box).pose.position.x() - start;
      farthest = std::max(farthest, std::abs(own - platform.motion({0})->pose.position.x()));
    }
    return farthest;
  };
  CHECK(shake(0.9 * held) < 0.01 * held);
  CHECK(shake(2 * held) > 0.3 * held);
}

TEST_CASE("what sleeps on a platform stays asleep while it stands, and goes along awake when it moves", "[moving]") {
  const auto world = world_with_platform();
  Platform platform;
  platform.moves = false;
  platform.mass = 1e9;
  const BodyId box = add_box(*world, 500, 0);
  for (int step = 0; step < 120; ++step) world->step(kStep, kParts, platform);
  REQUIRE(world->state(box).asleep);
  platform.moves = true;
  platform.speed = 0.005;  // slower than what carries
  for (int step = 0; step < 5; ++step) world->step(kStep, kParts, platform);
  CHECK(world->state(box).asleep);
  platform.speed = 0.5;
  for (int step = 0; step < 60; ++step) world->step(kStep, kParts, platform);
  CHECK_FALSE(world->state(box).asleep);
  CHECK(world->state(box).velocity.z() == Approx(0.5).margin(0.02 + kGravity * kStep / 2));
  CHECK(world->state(box).pose.position.z() == Approx(0.2 + kTop + platform.height).margin(0.005));
}

TEST_CASE("a box weighs on a platform that moves evenly as on one that stands", "[moving]") {
  const auto world = world_with_platform();
  Platform platform;
  platform.mass = 1e9;
  platform.speed = 0.5;
  (void)add_box(*world, 500, 0);
  for (int step = 0; step < 30; ++step) world->step(kStep, kParts, platform);
  platform.impulse = 0;
  for (int step = 0; step < 60; ++step) world->step(kStep, kParts, platform);
  CHECK(platform.impulse == Approx(-500 * kGravity).epsilon(1e-3));
}

namespace {

struct Laid {
  BodyId id;
  double mass = 0;
  Mat3 inertia = Mat3::Zero();  ///< body axes

  /// J; velocities are read at mid-step.
  [[nodiscard]] double kinetic(const BodyState& state) const {
    const Vec3 velocity = state.velocity - Vec3(0, 0, kGravity * kStep / 2);
    const Vec3 spin = state.pose.orientation.conjugate() * state.angular_velocity;
    return mass * velocity.squaredNorm() / 2 + spin.dot(inertia * spin) / 2;
  }
};

/// A plank from the platform to a shelf that stands still, and bricks over the plank's end and two others: bodies that
/// touch all along. The first is the plank.
std::vector<Laid> add_bridge_and_heap(World& world) {
  ObstacleDescription shelf;
  shelf.parts = {box_part({3.9, 2, kTop})};
  shelf.pose.position = Vec3(6, 0, 0);
  shelf.friction = 0.5;
  (void)world.add_obstacle(shelf);
  std::vector<Laid> laid;
  const auto add = [&](const Vec3& half, double x, double bottom) {
    BodyDescription box = box_body(half, 8 * 2000 * half.prod(), {x, 0, kTop + bottom + half.z()});
    box.friction = 0.5;
    laid.push_back({world.add_body(box), box.mass, box.inertia});
  };
  add({1.2, 1, 0.05}, 2.4, 0);
  add({0.6, 0.8, 0.2}, 3.65, 0.1);
  add({1, 1, 0.05}, 4.7, 0);
  add({1, 1, 0.05}, 6.8, 0);
  for (const double x : {4.9, 6.15, 7.4}) add({0.6, 0.8, 0.2}, x, 0.1);
  for (const double x : {5.52, 6.78}) add({0.6, 0.8, 0.2}, x, 0.5);
  return laid;
}

}  // namespace

TEST_CASE("a heap that leans on what sways sleeps but for what is near that, and its motion is in the account",
          "[moving]") {
  const auto world = world_with_platform();
  Platform platform;
  platform.mass = 1e9;
  platform.along_frequency = 2 * M_PI * GENERATE(1.0, 3.0);
  platform.along_amplitude = 0.02;
  const std::vector<Laid> laid = add_bridge_and_heap(*world);
  int slept = 0;
  double gained = 0, lost = 0, moved = 0;
  for (int step = 0; step < 480; ++step) {
    std::vector<BodyState> before;
    for (const Laid& one : laid) before.push_back(world->state(one.id));
    world->step(kStep, kParts, platform);
    for (const Contact& contact : world->contacts()) lost += contact.work_lost;
    for (std::size_t i = 0; i < laid.size(); ++i) {
      const Laid& one = laid[i];
      const BodyState after = world->state(one.id);
      const double had = before[i].asleep ? 0 : one.kinetic(before[i]), has = after.asleep ? 0 : one.kinetic(after);
      gained += has - had + one.mass * kGravity * (after.pose.position - before[i].pose.position).z();
      moved += had;
      // What falls asleep is at rest from then on, and is woken at rest.
      if (after.asleep) lost += had;
    }
    CHECK_FALSE(world->state(laid[0].id).asleep);
    if (step >= 120) slept += static_cast<int>(laid.size() - world->awake_count());
  }
  INFO("asleep in the mean " << slept / 360.0 << ", moved " << moved);
  CHECK(slept / 360.0 > 1);  // of eight that do not touch the platform
  CHECK(gained + lost == Approx(0).margin(1e-9 * moved));
}

TEST_CASE(
    "a sweep takes a platform along its path: it comes upon what flies before it, and runs away from what does not",
    "[moving]") {
  const auto world = world_with_platform();
  world->set_gravity(Vec3::Zero());
  Platform platform;
  platform.height = 0.02;  // the world has it at zero still
  const double gap = 0.01, part = kStep / kParts;
  const BodyId box = add_box(*world, 100, platform.height + gap);
  const auto fly = [&](double speed, double platform_speed) {
    BodyState state = world->state(box);
    state.velocity = Vec3(0, 0, speed);
    world->set_state(box, state);
    platform.speed = platform_speed;
    return world->sweep(part, {.structure = &platform});
  };
  const std::vector<Contact> struck = fly(2, 8);
  REQUIRE(struck.size() == 1);
  CHECK(struck[0].approach_speed == Approx(6).epsilon(1e-6));
  // To the distance at which parts count as touching, 0.1 mm.
  CHECK(struck[0].time == Approx(gap / 6).margin(1e-4 / 6 * 1.01));
  CHECK(struck[0].normal.z() == Approx(-1).epsilon(1e-6));
  CHECK(fly(-4, -7).empty());
  CHECK(fly(-4, -3).empty());  // 1 m/s closes 2 mm of them
  const std::vector<Contact> met = fly(-6, 0);
  REQUIRE(met.size() == 1);
  CHECK(met[0].approach_speed == Approx(6).epsilon(1e-6));
  CHECK(world->sweep(part).empty());  // to the place where the world has it there are 30 mm
}
