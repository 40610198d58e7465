// Bodies that lie on something: what they press with, that they fall asleep, and what wakes them.
#include <catch2/catch.hpp>

#include "world_builder.h"

using namespace collision_test;

namespace {

Vec3 impulse_on_ground(const World& world) {
  Vec3 sum = Vec3::Zero();
  for (const Contact& contact : world.contacts()) {
    if (contact.other.kind == Touched::Kind::ground) sum += contact.impulse;
  }
  return sum;
}

}  // namespace

TEST_CASE("a resting box presses on the ground with its weight") {
  const auto world = world_with_ground();
  const BodyId id = world->add_body(box_body({1.5, 1, 0.1}, 720, {0, 0, 0.1}));
  run(*world, 30);
  REQUIRE(world->contacts().size() == 1);
  const Contact& contact = world->contacts()[0];
  CHECK(contact.body == id);
  CHECK(contact.persistent);
  CHECK(contact.normal.z() == Approx(-1));
  // The solver stops after a number of iterations: a thousandth of the weight.
  CHECK(contact.impulse.z() == Approx(-720 * kGravity * kStep).epsilon(1e-3));
  CHECK(contact.impulse.head<2>().norm() < 1e-3 * contact.impulse.norm());
  CHECK(contact.point.head<2>().norm() < 0.01);
}

TEST_CASE("a box that slides is braked by the friction of the pair and the contact says what that cost") {
  const auto world = world_with_gravity();
  world->set_ground(0, 0.9, 0);
  BodyDescription box = box_body({1, 1, 0.1}, 100, {0, 0, 0.1});
  box.friction = 0.4;
  box.velocity = Vec3(3, 0, 0);
  const BodyId id = world->add_body(box);
  run(*world, 5);
  const double before = world->state(id).velocity.x();
  world->step(kStep);
  const double after = world->state(id).velocity.x();
  const double friction = std::sqrt(0.9 * 0.4);  // geometric mean of the two
  CHECK((before - after) / kStep == Approx(friction * kGravity).epsilon(0.01));
  REQUIRE(world->contacts().size() == 1);
  CHECK(world->contacts()[0].impulse.x() == Approx(100 * (before - after)).epsilon(1e-6));
  const double lost = 50 * (before * before - after * after);
  CHECK(world->contacts()[0].work_lost == Approx(lost).epsilon(1e-6));
}

TEST_CASE("what contacts took out of a box that falls, bounces and slides is what is missing in its energy") {
  const auto world = world_with_gravity();
  world->set_ground(0, 0.5, 0.3);
  const double mass = 120, dt = 1.0 / 480;
  BodyDescription box = box_body({0.6, 0.3, 0.2}, mass, {0, 0, 2});
  box.pose.orientation = Eigen::Quaterniond(0.8, 0.3, 0.1, 0.2).normalized();
  box.velocity = Vec3(4, 1, -3 + kGravity * dt / 2);
  const BodyId id = world->add_body(box);
  const auto energy = [&] {
    const BodyState state = world->state(id);
    const Vec3 velocity = state.velocity - Vec3(0, 0, kGravity * dt / 2);
    const Mat3 axes = state.pose.orientation.toRotationMatrix();
    const Vec3 spin = state.angular_velocity;
    return mass * (velocity.squaredNorm() / 2 + kGravity * state.pose.position.z()) +
           spin.dot(axes * box.inertia * axes.transpose() * spin) / 2;
  };
  const double start = energy();
  double lost = 0;
  for (int step = 0; step < 1440; ++step) {
    world->step(dt);
    for (const Contact& contact : world->contacts()) lost += contact.work_lost;
  }
  CHECK(lost > 0.9 * (start - mass * kGravity * 0.2));  // it lies still, on one of its faces
  // Rotation is of second order in a step of this length.
  CHECK(start - energy() == Approx(lost).epsilon(0.01));
}

TEST_CASE("a stack of boxes rests, falls asleep and then costs no step") {
  const auto world = world_with_ground();
  std::vector<BodyId> stack;
  for (int level = 0; level < 5; ++level)
    stack.push_back(world->add_body(box_body({0.5, 0.5, 0.25}, 600, {0, 0, 0.25 + 0.5 * level})));
  CHECK(world->awake_count() == 5);
  for (int i = 0; i < 60; ++i) {
    world->step(kStep);
    if (i > 20 && world->awake_count() > 0)
      CHECK(-impulse_on_ground(*world).z() == Approx(5 * 600 * kGravity * kStep).epsilon(0.02));
  }
  run(*world, 240);
  CHECK(world->awake_count() == 0);
  CHECK(world->contacts().empty());
  for (int level = 0; level < 5; ++level) {
    const BodyState state = world->state(stack[static_cast<std::size_t>(level)]);
    CHECK(state.asleep);
    // Each may sink 2 mm into what it lies on, and the load of those above takes it somewhat further.
    CHECK((state.pose.position - Vec3(0, 0, 0.25 + 0.5 * level)).norm() < 0.003 * (level + 1));
  }
  CHECK(world->sweep(kStep).empty());
}

TEST_CASE("a body that slept is seen as it is after whatever moves it, and those awake are counted") {
  const auto world = world_with_ground();
  const BodyId pushed = world->add_body(box_body({0.5, 0.5, 0.25}, 600, {0, 0, 0.25}));
  const BodyId placed = world->add_body(box_body({0.5, 0.5, 0.25}, 600, {9, 0, 0.25}));
  const BodyId met = world->add_body(box_body({0.5, 0.5, 0.25}, 600, {-9, 0, 0.25}));
  const BodyId alone = world->add_body(box_body({0.5, 0.5, 0.25}, 600, {0, 9, 0.25}));
  run(*world, 300);
  REQUIRE(world->awake_count() == 0);
  const Vec3 rested = world->state(alone).pose.position;

  world->apply_impulse(pushed, {0, 0, 6000}, world->state(pushed).pose.position);
  CHECK(world->awake_count() == 1);
  CHECK(world->state(pushed).velocity.z() == Approx(10 + kGravity * kStep / 2));  // 10 at once, read at mid-step
  CHECK_FALSE(world->state(pushed).asleep);

  BodyState state = world->state(placed);
  state.pose.position = Vec3(9, 1, 5);
  state.velocity = Vec3(0, 2, 0);
  state.asleep = false;
  world->set_state(placed, state);
  CHECK(world->awake_count() == 2);
  CHECK(world->state(placed).pose.position == state.pose.position);
  CHECK(world->state(placed).velocity == state.velocity);

  BodyDescription ball = ball_body(0.4, 500, {-7, 0, 0.4});
  ball.velocity = Vec3(-20, 0, 0);
  const BodyId thrown = world->add_body(ball);
  CHECK(world->awake_count() == 3);
  for (int i = 0; i < 12; ++i) {
    const BodyState before = world->state(placed);
    world->step(kStep);
    const BodyState after = world->state(placed);
    CHECK((after.pose.position - before.pose.position - kStep * after.velocity).norm() < 1e-9);
  }
  CHECK_FALSE(world->state(met).asleep);  // the ball came upon it
  CHECK(world->state(met).pose.position.x() < -9.1);
  CHECK(world->awake_count() == 4);
  CHECK(world->state(alone).asleep);
  CHECK(world->state(alone).pose.position == rested);

  state = world->state(placed);
  state.asleep = true;
  world->set_state(placed, state);
  CHECK(world->state(placed).asleep);
  world->remove_body(thrown);
  CHECK(world->awake_count() == 2);
  CHECK_THROWS_AS(world->state(thrown), std::out_of_range);
  world->wake(alone);
  CHECK_FALSE(world->state(alone).asleep);
}

TEST_CASE("taking away an obstacle wakes what lay on it, and that falls") {
  const auto world = world_with_ground();
  const ObstacleId table = world->add_obstacle(box_obstacle({1, 1, 0.5}, {0, 0, 2.5}));
  const BodyId lower = world->add_body(box_body({0.5, 0.5, 0.25}, 600, {0, 0, 3.25}));
  const BodyId upper = world->add_body(box_body({0.5, 0.5, 0.25}, 600, {0, 0, 3.75}));
  const BodyId elsewhere = world->add_body(box_body({0.5, 0.5, 0.25}, 600, {9, 0, 0.25}));
  run(*world, 300);
  REQUIRE(world->awake_count() == 0);
  world->remove_obstacle(table);
  CHECK_FALSE(world->state(lower).asleep);
  run(*world, 10);
  CHECK(world->state(upper).velocity.z() < -1);
  CHECK(world->state(elsewhere).asleep);
  CHECK_THROWS_AS(world->move_obstacle(table, {}), std::out_of_range);
}

TEST_CASE("a ball on flat ground comes to rest") {
  const auto world = world_with_ground();
  BodyDescription ball = ball_body(0.4, 500, {0, 0, 0.4});
  ball.velocity = Vec3(3, 0, 0);
  world->add_body(ball);
  int steps = 0;
  while (world->awake_count() > 0 && steps < 60 * 60) {
    world->step(kStep);
    ++steps;
  }
  CHECK(steps < 60 * 60);
}

TEST_CASE("a convex hull rests on its face where a box of the same size does") {
  const auto world = world_with_ground();
  BodyDescription wedge = box_body({0.5, 0.5, 0.25}, 300, {0, 0, 0.3});
  ConvexPart& part = wedge.parts[0];
  part.kind = ConvexPart::Kind::hull;
  for (int corner = 0; corner < 8; ++corner) {
    part.points.emplace_back(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.25 : -0.25);
  }
  const BodyId id = world->add_body(wedge);
  run(*world, 300);
  CHECK(world->state(id).asleep);
  // A hull keeps a skin of 2 mm around it.
  CHECK(world->state(id).pose.position.z() == Approx(0.25).margin(0.004));
}

TEST_CASE("a heap of heavy slabs and light bars between them comes to rest") {
  const auto world = world_with_ground();
  for (int level = 0; level < 8; ++level) {
    const double z = 0.5 + 0.6 * level, skew = 0.3 * (level % 3);
    world->add_body(box_body({2, 2, 0.1}, 25000, {skew, -skew, z}));
    world->add_body(box_body({1.5, 0.06, 0.1}, 300, {skew, 0.8 - skew, z + 0.3}));
    world->add_body(box_body({0.06, 1.5, 0.1}, 300, {0.5 * skew - 0.9, skew, z + 0.3}));
  }
  int steps = 0;
  while (world->awake_count() > 0 && steps < 60 * 30) {
    world->step(kStep);
    ++steps;
  }
  CHECK(steps < 60 * 30);
}

TEST_CASE("two runs of a falling heap agree to the bit") {
  const auto run_once = [] {
    const auto world = world_with_ground(0.6, 0.1);
    world->add_obstacle(box_obstacle({0.2, 3, 1}, {0.3, 0, 1}));
    for (int i = 0; i < 40; ++i) {
      BodyDescription body =
          i % 3 == 0 ? ball_body(0.3, 200, {0.05 * i, 0.03 * (i % 7), 3 + 0.7 * i})
                     : box_body({0.6, 0.2, 0.1 + 0.01 * i}, 100 + i, {0.02 * i, 0.04 * (i % 5), 3 + 0.7 * i});
      world->add_body(body);
    }
    std::vector<double> numbers;
    for (int step = 0; step < 200; ++step) {
      for (const Contact& contact : world->sweep(kStep))
        numbers.insert(numbers.end(), {contact.time, contact.approach_speed});
      world->step(kStep);
      for (const Contact& contact : world->contacts())
        numbers.insert(numbers.end(), contact.impulse.data(), contact.impulse.data() + 3);
    }
    for (const BodyId id : world->bodies()) {
      const BodyState state = world->state(id);
      numbers.insert(numbers.end(), state.pose.position.data(), state.pose.position.data() + 3);
      numbers.insert(numbers.end(), state.pose.orientation.coeffs().data(), state.pose.orientation.coeffs().data() + 4);
    }
    return numbers;
  };
  const std::vector<double> first = run_once(), second = run_once();
  REQUIRE(first.size() > 1000);
  CHECK(first == second);
}

TEST_CASE("a body born inside another passes through it until they have come apart, and then meets it again") {
  const auto world = world_with_gravity();
  const ObstacleId shelf = world->add_obstacle(box_obstacle({2, 2, 0.1}, {0, 0, 5}));
  const BodyId ball = world->add_body(ball_body(0.3, 100, {0, 0, 5.1}));
  Touched other;
  other.kind = Touched::Kind::obstacle;
  other.obstacle = shelf;
  world->ignore_until_separated(ball, other);
  CHECK(world->sweep(kStep).empty());
  run(*world, 60);
  CHECK(world->state(ball).pose.position.z() < 4);  // free fall through it
  BodyState state = world->state(ball);
  state.pose.position.z() = 5.6;
  state.velocity.setZero();
  world->set_state(ball, state);
  run(*world, 120);
  CHECK(world->state(ball).pose.position.z() == Approx(5.4).margin(0.01));  // lies on it
}

TEST_CASE("a ball that is to go through what it is about to hit goes through it, and meets it on the way back") {
  const auto world = world_with_gravity();
  const ObstacleId wall = world->add_obstacle(box_obstacle({0.1, 2, 2}, {1, 0, 5}));
  const BodyId ball = world->add_body(ball_body(0.3, 100, {0.27, 0, 5}));  // arrives 0.33 m on, at the end of the step
  BodyState state = world->state(ball);
  state.velocity.x() = 20;
  world->set_state(ball, state);
  Touched other;
  other.kind = Touched::Kind::obstacle;
  other.obstacle = wall;
  REQUIRE(world->sweep(kStep).size() == 1);
  world->ignore_until_separated(ball, other);  // it has not reached the wall yet
  CHECK(world->sweep(kStep).empty());
  run(*world, 6);
  CHECK(world->state(ball).pose.position.x() == Approx(0.27 + 20 * 6 * kStep).margin(1e-6));
  state = world->state(ball);
  state.velocity.x() = -20;
  world->set_state(ball, state);
  run(*world, 20);
  CHECK(world->state(ball).pose.position.x() > 1);
}

TEST_CASE("nothing is left of a body that is taken away in the step in which it was about to hit another") {
  const auto world = world_with_gravity();
  const BodyId box = world->add_body(box_body({0.5, 0.5, 0.5}, 1000, {1.3, 0, 5}));
  const BodyId ball = world->add_body(ball_body(0.4, 500, {0, 0, 5}));
  BodyState state = world->state(ball);
  state.velocity.x() = 40;  // 0.67 m in the step, with 0.4 m between them: the collision is foreseen
  world->set_state(ball, state);
  world->step(kStep);
  world->remove_body(ball);
  world->remove_body(box);  // looks for what touches it: the sanitizers see whether it looks at the ball
  CHECK(world->awake_count() == 0);
  CHECK(world->sweep(kStep).empty());
}

TEST_CASE("descriptions that mean nothing are refused with their name") {
  const auto world = make_bullet_world();
  BodyDescription body = box_body({1, 1, 1}, 10, Vec3::Zero());
  body.mass = 0;
  CHECK_THROWS_WITH(world->add_body(body), Catch::Contains("body 0") && Catch::Contains("mass"));
  body = box_body({1, 1, 0}, 10, Vec3::Zero());
  body.inertia = Mat3::Identity();
  body.parts[0].tag = 42;
  CHECK_THROWS_WITH(world->add_body(body), Catch::Contains("tag 42") && Catch::Contains("half extents"));
  body = box_body({1, 1, 1}, 10, Vec3::Zero());
  body.inertia(2, 2) = -1;
  CHECK_THROWS_WITH(world->add_body(body), Catch::Contains("positive definite"));
  ObstacleDescription flat;
  flat.parts.emplace_back();
  flat.parts[0].kind = ConvexPart::Kind::hull;
  flat.parts[0].points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  CHECK_THROWS_WITH(world->add_obstacle(flat), Catch::Contains("one plane"));
  CHECK(world->bodies().empty());
}
