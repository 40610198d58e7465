// What has lain asleep and is woken was at rest, and goes on from there.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "random_chunk.h"
#include "topple/collision/small_steps.h"
#include "world_builder.h"

using namespace collision_test;

namespace {

constexpr double kMass = 300;

/// A box of half a metre that sleeps on a shelf at the height of 10 m.
struct Sleeper {
  explicit Sleeper(double step) {
    world->set_gravity({0, 0, -kGravity});
    shelf = world->add_obstacle(box_obstacle({1, 1, 0.1}, {0, 0, 9.9}));
    box = world->add_body(box_body({0.25, 0.25, 0.25}, kMass, {0, 0, 10.25}));
    for (double time = 0; time < 2; time += step) world->step(step);
    REQUIRE(world->state(box).asleep);
  }
  std::unique_ptr<World> world = make_small_steps_world();
  ObstacleId shelf;
  BodyId box;
};

}  // namespace

TEST_CASE("what loses its support while it sleeps falls from rest, at every length of step") {
  const double step = GENERATE(1.0 / 30, 1.0 / 60, 1.0 / 240);
  Sleeper sleeper(step);
  const double begun = sleeper.world->state(sleeper.box).pose.position.z();
  sleeper.world->remove_obstacle(sleeper.shelf);
  for (int i = 1; i <= 20; ++i) {
    sleeper.world->step(step);
    const double fallen = begun - sleeper.world->state(sleeper.box).pose.position.z();
    CHECK(fallen == Approx(kGravity * std::pow(i * step, 2) / 2).epsilon(1e-12));
  }
}

TEST_CASE("what is woken where it lies presses with its weight from the first step on, and stays") {
  const double step = GENERATE(1.0 / 30, 1.0 / 60, 1.0 / 240);
  Sleeper sleeper(step);
  const Vec3 begun = sleeper.world->state(sleeper.box).pose.position;
  sleeper.world->wake(sleeper.box);
  // It is at rest when it wakes, and at the middle of a sub-step from then on: half of one, of 540 or more a second.
  const double half_substep = 0.5 / 540, weight = kMass * kGravity * step;
  double told = 0;
  for (int i = 1; i <= 10; ++i) {
    sleeper.world->step(step);
    double pressed = 0;
    for (const Contact& contact : sleeper.world->contacts()) pressed -= contact.impulse.z();
    told += pressed;
    CHECK(std::abs(pressed - weight) < (i == 1 ? 1.001 * half_substep / step : 1e-4) * weight);
  }
  CHECK(std::abs(told - 10 * weight) < 1.001 * half_substep / step * weight);
  CHECK((sleeper.world->state(sleeper.box).pose.position - begun).norm() < 1e-5);
}

TEST_CASE("a push on what sleeps gives it the momentum of the push and no other") {
  Sleeper sleeper(kStep);
  const Vec3 impulse(600, -150, 900);
  const BodyState before = sleeper.world->state(sleeper.box);
  sleeper.world->apply_impulse(sleeper.box, impulse, before.pose.position);
  const Vec3 half_step(0, 0, -kGravity * kStep / 2);
  CHECK((sleeper.world->state(sleeper.box).velocity + half_step - impulse / kMass).norm() < 1e-14);
  CHECK((sleeper.world->velocity_when_woken(sleeper.box) + half_step).norm() < 1e-15);
}

namespace {

/// A heap of chunks under a slab, by chance, once it sleeps.
struct SleepingHeap {
  explicit SleepingHeap(unsigned seed) {
    std::mt19937 random(seed);
    const auto between = [&](double low, double high) { return low + (high - low) * (random() % 1000) / 1000.0; };
    for (int i = 0; i < 40; ++i)
      bodies.push_back(world->add_body(chunk(random, {between(-1, 1), between(-1, 1), 1 + 0.7 * i})));
    bodies.push_back(world->add_body(box_body({1.5, 1.5, 0.15}, 6000, {0, 0, 32})));
    REQUIRE(falls_asleep(2400));
  }
  [[nodiscard]] bool falls_asleep(int steps) {
    for (int i = 0; i < steps && world->awake_count() > 0; ++i) world->step(kStep);
    return world->awake_count() == 0;
  }
  /// m: the farthest that any has gone half a second after one has been woken.
  [[nodiscard]] double moved_by_waking(BodyId woken) {
    std::vector<Vec3> begun;
    for (const BodyId one : bodies) begun.push_back(world->state(one).pose.position);
    world->wake(woken);
    for (int i = 0; i < 30; ++i) world->step(kStep);
    double moved = 0;
    for (std::size_t i = 0; i < bodies.size(); ++i)
      moved = std::max(moved, (world->state(bodies[i]).pose.position - begun[i]).norm());
    return moved;
  }

  std::unique_ptr<World> world = world_with_ground();
  std::vector<BodyId> bodies;
};

}  // namespace

TEST_CASE("one body of a heap that sleeps can wake, and next to nothing of the heap moves") {
  int woken = 0, moved_on = 0;
  for (const unsigned seed : {5U, 6U, 7U, 8U}) {
    SleepingHeap heap(seed);
    for (const BodyId one : heap.bodies) {
      const double moved = heap.moved_by_waking(one);
      INFO("heap " << seed << ", body " << one.value << ": " << moved << " m");
      ++woken;
      if (moved > 1e-3) ++moved_on;  // farther than what rests is apart from what it touches
      CHECK(moved < 0.05);           // it lies on one edge, and tips to the other
      REQUIRE(heap.falls_asleep(300));
    }
  }
  CHECK(10 * moved_on < woken);  // one in 25 to 40, over twelve heaps
}
