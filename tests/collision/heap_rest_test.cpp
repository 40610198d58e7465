// What comes to rest: when, what it presses with then, and what wakes it.
#include <catch2/catch.hpp>
#include <map>
#include <random>

#include "random_chunk.h"
#include "world_builder.h"

using namespace collision_test;

namespace {

std::unique_ptr<World> falling_chunks(int count) {
  auto world = world_with_ground();
  std::mt19937 random(3);
  for (int i = 0; i < count; ++i)
    world->add_body(chunk(random, {1.2 * (i % 3) - 1.2, 1.2 * (i / 3 % 3) - 1.2, 1 + 0.9 * (i / 9)}));
  return world;
}

std::vector<double> positions(const World& world) {
  std::vector<double> numbers;
  for (const BodyId id : world.bodies()) {
    const BodyState state = world.state(id);
    numbers.insert(numbers.end(), state.pose.position.begin(), state.pose.position.end());
    numbers.insert(numbers.end(), state.pose.orientation.coeffs().begin(), state.pose.orientation.coeffs().end());
  }
  return numbers;
}

/// What bodies press on obstacles with, each contact averaged over a tenth of a second while its body is awake, as what
/// stands is loaded.
class LoadOnObstacles {
 public:
  void read(const World& world) {
    std::map<std::int64_t, Vec3> now;
    for (const Contact& contact : world.contacts())
      if (contact.other.kind == Touched::Kind::obstacle)
        now.try_emplace(contact.body.value, Vec3::Zero()).first->second += contact.impulse / kStep;
    for (const auto& [body, force] : now) force_.try_emplace(body, Vec3::Zero());
    for (auto& [body, force] : force_)
      if (!world.state({body}).asleep) force += kStep / 0.1 * ((now.count(body) ? now[body] : Vec3::Zero()) - force);
  }
  [[nodiscard]] Vec3 sum() const {
    Vec3 sum = Vec3::Zero();
    for (const auto& [body, force] : force_) sum += force;
    return sum;
  }

 private:
  std::map<std::int64_t, Vec3> force_;
};

constexpr double kWeight = 600 * kGravity;

BodyDescription block(double z) { return box_body({0.5, 0.5, 0.25}, 600, {0, 0, z}); }

/// Two blocks on a table.
struct OnTable {
  std::unique_ptr<World> world = world_with_ground();
  ObstacleId table = world->add_obstacle(box_obstacle({1, 1, 0.5}, {0, 0, 2.5}));
  BodyId lower = world->add_body(block(3.25)), upper = world->add_body(block(3.75));
  LoadOnObstacles load;
  OnTable() { pass(90); }
  void pass(int steps) {
    for (int i = 0; i < steps; ++i) {
      world->step(kStep);
      load.read(*world);
    }
  }
};

}  // namespace

TEST_CASE("a heap of chunks comes to rest and stays") {
  const auto world = falling_chunks(72);
  int steps = 0;
  for (; world->awake_count() > 0 && steps < 60 * 20; ++steps) world->step(kStep);
  REQUIRE(steps < 60 * 12);
  const std::vector<double> at_rest = positions(*world);
  run(*world, 60);
  CHECK(positions(*world) == at_rest);
}

TEST_CASE("two runs of a heap that comes to rest agree to the bit") {
  const auto first = falling_chunks(45), second = falling_chunks(45);
  run(*first, 400);
  run(*second, 400);
  CHECK(positions(*first) == positions(*second));
}

TEST_CASE("what is held still loads what it lies on with its weight, and so does what is laid on it") {
  OnTable two;
  REQUIRE(two.world->awake_count() == 0);
  CHECK(-two.load.sum().z() == Approx(2 * kWeight).epsilon(0.02));
  // Laid on without an impact: what comes is felt through those that were held.
  const BodyId third = two.world->add_body(block(4.25));
  two.pass(20);
  CHECK_FALSE(two.world->state(two.lower).asleep);
  two.pass(100);
  CHECK(two.world->state(third).asleep);
  CHECK(two.world->awake_count() == 0);
  CHECK(-two.load.sum().z() == Approx(3 * kWeight).epsilon(0.05));
  // And what is taken off again.
  two.world->remove_body(third);
  two.pass(120);
  CHECK(two.world->awake_count() == 0);
  CHECK(-two.load.sum().z() == Approx(2 * kWeight).epsilon(0.05));
}

TEST_CASE("a heap held still in a trough loads it with its weight") {
  const auto world = world_with_ground();
  world->add_obstacle(box_obstacle({3, 3, 0.2}, {0, 0, 1}));
  for (const double side : {-1.0, 1.0}) {
    world->add_obstacle(box_obstacle({0.2, 3, 1}, {3 * side, 0, 2}));
    world->add_obstacle(box_obstacle({3, 0.2, 1}, {0, 3 * side, 2}));
  }
  std::mt19937 random(5);
  for (int i = 0; i < 45; ++i)
    world->add_body(chunk(random, {1.2 * (i % 3) - 1.2, 1.2 * (i / 3 % 3) - 1.2, 2 + 0.9 * (i / 9)}));
  LoadOnObstacles load;
  for (int i = 0; i < 60 * 20 && world->awake_count() > 0; ++i) {
    world->step(kStep);
    load.read(*world);
  }
  REQUIRE(world->awake_count() == 0);
  CHECK(-load.sum().z() == Approx(45 * 250 * kGravity).epsilon(0.1));
}

TEST_CASE("what is held still falls when what bears it is taken away, one upon the other") {
  OnTable two;
  REQUIRE(two.world->awake_count() == 0);
  two.world->remove_obstacle(two.table);
  run(*two.world, 10);
  // Free fall, but for the steps in which the loss of the load was noticed.
  CHECK(two.world->state(two.lower).velocity.z() < -9 * kGravity * kStep);
  CHECK(two.world->state(two.upper).velocity.z() < -6 * kGravity * kStep);
}

TEST_CASE("what is held still takes an impact as a free body, in the step in which it comes") {
  OnTable two;
  REQUIRE(two.world->awake_count() == 0);
  BodyDescription ball = ball_body(0.3, 200, {-1.05, 0, 3.75});
  ball.velocity = Vec3(18, 0, 0);
  const BodyId thrown = two.world->add_body(ball);
  double momentum = 0;
  for (int i = 0; i < 5; ++i) {
    two.world->step(kStep);
    momentum = 200 * two.world->state(thrown).velocity.x() + 600 * two.world->state(two.upper).velocity.x() +
               600 * two.world->state(two.lower).velocity.x();
  }
  CHECK(two.world->state(two.upper).velocity.x() > 3);
  // Friction on the table takes no more than its coefficient times the weight, for some steps.
  CHECK(momentum > 200 * 18 - 0.8 * 1400 * kGravity * 5 * kStep);
  CHECK(momentum < 200 * 18 * 1.0001);
}

TEST_CASE("what comes to rest on a sleeping slab beside balls that roll on it rests, and all weights are felt below") {
  const auto world = world_with_ground();
  world->add_obstacle(box_obstacle({4, 1, 0.5}, {0, 0, 0.5}));
  const BodyId slab = world->add_body(box_body({4, 1, 0.1}, 4000, {0, 0, 1.1}));
  run(*world, 90);
  REQUIRE(world->state(slab).asleep);
  std::vector<BodyId> balls;
  for (int i = 0; i < 12; ++i) {
    balls.push_back(world->add_body(ball_body(0.1, 5, {0.3 * i - 0.5, 0.4, 1.3})));
    BodyState state = world->state(balls.back());
    state.velocity = {0, -0.2, 0};
    world->set_state(balls.back(), state);
  }
  const BodyId box = world->add_body(box_body({0.25, 0.25, 0.25}, 200, {-3, 0, 1.45}));
  int steps = 0;
  for (; !world->state(box).asleep && steps < 120; ++steps) world->step(kStep);
  REQUIRE(steps < 120);
  CHECK(world->state(slab).asleep);
  CHECK(world->awake_count() == balls.size());
  double load = 0;
  for (const Contact& contact : world->contacts())
    if (contact.other.kind == Touched::Kind::obstacle) load -= contact.impulse.z() / kStep;
  CHECK(load == Approx((4000 + 200 + 12 * 5) * kGravity).epsilon(0.002));  // the balls' forces are those of a step
}
