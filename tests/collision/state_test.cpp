// A world that loads what another one saved goes on as that one does.
#include <atomic>
#include <catch2/catch.hpp>
#include <sstream>
#include <thread>

#include "random_history.h"
#include "same_world.h"
#include "topple/collision/sequential_impulse.h"

using namespace collision_test;

namespace {

void load(World& world, const std::string& state) {
  std::istringstream bytes(state);
  world.load_state(bytes);
}

std::unique_ptr<World> loaded(const std::string& state) {
  auto world = make_bullet_world();
  load(*world, state);
  return world;
}

/// That held something else before.
std::unique_ptr<World> loaded_by_a_used_world(const std::string& state, unsigned seed) {
  RandomHistory other(seed);
  for (int i = 0; i < 20; ++i) other.go_on();
  auto world = other.first().copy();
  load(*world, state);
  return world;
}

/// A hull that is no prism.
BodyDescription frustum(const Vec3& at) {
  BodyDescription body = box_body({0.2, 0.2, 0.2}, 100, at);
  ConvexPart& part = body.parts.front();
  part.kind = ConvexPart::Kind::hull;
  for (const Vec3& corner : {Vec3(1, 1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, -1), Vec3(1, -1, -1), Vec3(0.5, 0.5, 1),
                             Vec3(-0.5, 0.5, 1), Vec3(-0.5, -0.5, 1), Vec3(0.5, -0.5, 1)})
    part.points.push_back(0.2 * corner);
  return body;
}

std::unique_ptr<World> heap(int count) {
  auto world = world_with_ground();
  for (int i = 0; i < count; ++i) world->add_body(frustum({0.3 * (i % 5), 0.3 * (i / 5 % 5), 0.3 + 0.4 * (i / 25)}));
  return world;
}

}  // namespace

TEST_CASE(
    "a world that loads a state goes on as the one that saved it and as its copy, to the bit, whatever happened") {
  int asleep = 0, awake = 0, swaying = 0, joined = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    CAPTURE(seed);
    RandomHistory history(seed), undisturbed(seed);
    std::mt19937 moments(seed);
    for (int round = 0; round < 6; ++round) {
      for (int step = 0, steps = 10 + static_cast<int>(moments() % 70); step < steps; ++step) {
        CAPTURE(round, step);
        history.go_on();
        undisturbed.go_on();
      }
      for (RandomHistory* each : {&history, &undisturbed})  // what comes and moves is sought in the next step only
        for (int k = 0; k < 3 * (round % 2); ++k) each->change();
      const std::string state = saved(history.first());
      REQUIRE((state == saved(history.first())));
      const std::size_t awake_now = history.first().awake_count();
      awake += awake_now > 0;
      asleep += awake_now < history.first().bodies().size();
      swaying += history.sways();
      joined += history.joint_count() > 0;
      history.drop_others();
      history.add(loaded(state));
      history.add(history.first().copy());
      history.add(loaded_by_a_used_world(state, seed + 100));
      history.require_alike();
    }
    REQUIRE((saved(history.first()) == saved(undisturbed.first())));
  }
  // All of it was there when states were saved.
  CHECK(asleep > 10);
  CHECK(awake > 10);
  CHECK(swaying > 10);
  CHECK(joined > 10);
}

TEST_CASE("a heap that sleeps is woken in a world that loaded it as where it fell asleep") {
  const auto world = heap(50);
  run(*world, 400);
  REQUIRE(world->awake_count() == 0);
  const auto other = loaded(saved(*world));
  require_same(*world, *other);
  for (World* each : {world.get(), other.get()}) {
    each->remove_body(each->bodies()[12]);
    each->apply_impulse(each->bodies()[40], {200, 50, 0}, each->state(each->bodies()[40]).pose.position);
  }
  for (int i = 0; i < 240; ++i) {
    run(*world, 1);
    run(*other, 1);
    require_same(*world, *other);
  }
}

TEST_CASE("a body that is told in each step to pass goes on passing in a loaded world") {
  const auto world = world_with_gravity();
  Touched wall;
  wall.kind = Touched::Kind::obstacle;
  wall.obstacle = world->add_obstacle(box_obstacle({0.5, 2, 4}, {0, 0, 0}));
  BodyDescription description = box_body({0.2, 0.2, 0.2}, 100, {-0.705, 0, 0});
  description.velocity = Vec3(0.2, 0, 0);  // 5 mm away: there in the second step
  const BodyId body = world->add_body(description);
  world->ignore_until_separated(body, wall);
  run(*world, 1);  // they are apart: it is released
  const auto other = loaded(saved(*world));
  for (int i = 0; i < 10; ++i)
    for (World* each : {world.get(), other.get()}) {
      each->ignore_until_separated(body, wall);
      run(*each, 1);
    }
  require_same(*world, *other);
}

TEST_CASE("a loaded world makes the shapes, and gives the numbers, that the saved one does") {
  const auto world = heap(2);
  world->remove_body(world->bodies()[1]);
  world->remove_body(world->bodies()[0]);
  const auto other = loaded(saved(*world));  // which no longer knows what a frustum is
  for (int i = 0; i < 4; ++i) {
    const BodyDescription body = frustum({0.1 * i, 0, 0.3 + 0.5 * i});
    CHECK(world->add_body(body) == other->add_body(body));
  }
  run(*world, 60);
  run(*other, 60);
  require_same(*world, *other);
  CHECK((saved(*world) == saved(*other)));
}

TEST_CASE("threads that a world shares stay its own when it loads a state") {
  const auto world = heap(150);
  run(*world, 40);
  const std::string state = saved(*world);
  const auto other = make_bullet_world();
  std::atomic<int> calls = 0;
  other->set_parallel_for(
      [&](std::size_t count, const std::function<void(std::size_t)>& work) {
        ++calls;
        std::vector<std::jthread> threads;
        for (std::size_t i = 0; i < count; ++i) threads.emplace_back([&work, i] { work(i); });
      },
      3);
  load(*other, state);
  run(*world, 60);
  run(*other, 60);
  require_same(*world, *other);
  CHECK(calls > 0);
}

TEST_CASE("a state of which bytes are missing is refused") {
  RandomHistory history(3);
  for (int i = 0; i < 40; ++i) history.go_on();
  const std::string state = saved(history.first());
  std::mt19937 random(1);
  std::vector<std::size_t> lengths{0, 1, state.size() - 1};
  for (int i = 0; i < 60; ++i) lengths.push_back(random() % state.size());
  for (const std::size_t length : lengths) {
    CAPTURE(length);
    const auto world = make_bullet_world();
    CHECK_THROWS_AS(load(*world, state.substr(0, length)), std::runtime_error);
  }
}

TEST_CASE("a state is neither saved nor loaded within a step") {
  RandomHistory history(4);
  World& world = history.first();
  const std::string state = saved(world);
  Swaying structure;
  bool asked = false;
  structure.within_step = [&] {
    CHECK_THROWS_AS(saved(world), std::logic_error);
    CHECK_THROWS_AS(load(world, state), std::logic_error);
    asked = true;
  };
  world.step(kStep, 2, structure);
  CHECK(asked);
}

TEST_CASE("an engine that cannot save its state says so") {
  const auto world = make_sequential_impulse_world();
  CHECK_THROWS_AS(saved(*world), std::logic_error);
  CHECK_THROWS_AS(load(*world, {}), std::logic_error);
}
