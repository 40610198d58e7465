// A world and its copy go on alike.
#include <catch2/catch.hpp>
#include <random>

#include "same_world.h"
#include "topple/collision/sequential_impulse.h"
#include "world_builder.h"

using namespace collision_test;

namespace {

/// Boxes that fall on each other and on an obstacle, two of them on a hinge, one on a cable, two born inside each
/// other.
std::unique_ptr<World> busy_world() {
  auto world = world_with_ground(0.6, 0.1);
  world->add_obstacle(box_obstacle({1, 1, 0.3}, {0, 0, 0.3}));
  std::mt19937 random(5);
  const auto between = [&](double a, double b) { return a + (b - a) * double(random() % 1000) / 1000; };
  std::vector<BodyId> made;
  for (int i = 0; i < 40; ++i) {
    const Vec3 half(between(0.2, 0.5), between(0.2, 0.5), between(0.05, 0.2));
    BodyDescription body =
        box_body(half, 2000 * half.prod(), {between(-1, 1), between(-1, 1), 1 + 0.4 * static_cast<double>(i)});
    body.angular_velocity = Vec3(between(-6, 6), between(-6, 6), 0);
    made.push_back(world->add_body(body));
  }
  HingeDescription hinge;
  hinge.body = made[30];
  hinge.other = made[31];
  hinge.point = world->state(made[30]).pose.position;
  hinge.held = {true, true, true, false, false, false};
  world->add_hinge(hinge);
  CableDescription cable;
  cable.body = made[39];
  cable.anchor = world->state(made[39]).pose.position + Vec3(2, 0, 1);
  cable.length = 4;
  world->add_cable(cable);
  Touched other;
  other.kind = Touched::Kind::body;
  other.body = made[1];
  world->ignore_until_separated(made[0], other);
  world->remove_body(made[20]);  // numbers that are free again are in the copy as well
  return world;
}

/// A body more, and one less.
void change(World& world) {
  world.remove_body(world.bodies()[3]);
  world.add_body(box_body({0.3, 0.3, 0.3}, 100, {0, 0, 6}));
}

}  // namespace

TEST_CASE("a copy of a world goes on as the world does, to the bit, whenever it was taken") {
  // While things fall and strike, in the heap, and at rest.
  for (const int steps : {0, 30, 100, 600}) {
    const auto world = busy_world();
    run(*world, steps);
    const auto copy = world->copy();
    REQUIRE(copy);
    require_same(*world, *copy);
    run(*world, 120);
    run(*copy, 120);
    require_same(*world, *copy);
    for (World* each : {world.get(), copy.get()}) {
      change(*each);
      run(*each, 60);
    }
    require_same(*world, *copy);
  }
}

TEST_CASE("a copy outlives the world that it was taken of, and neither sees what happens to the other") {
  auto world = busy_world();
  run(*world, 60);
  const auto first = world->copy();
  auto second = world->copy();
  change(*world);
  run(*world, 60);
  world.reset();
  run(*first, 60);
  change(*second);
  second = first->copy();
  run(*first, 60);
  run(*second, 60);
  require_same(*first, *second);
  CHECK(!first->sweep(kStep).empty());
}

TEST_CASE("an engine without copies says so by giving none") { CHECK(!make_sequential_impulse_world()->copy()); }
