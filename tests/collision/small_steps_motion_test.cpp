// What the contact solver in small steps moves, against closed forms: a ball that rolls, a top, balls in a row.
#include <catch2/catch.hpp>
#include <cmath>

#include "solver/solver_settings.h"
#include "topple/collision/small_steps.h"
#include "world_builder.h"

using namespace collision_test;

TEST_CASE("small steps: a ball rolls down a slope as its inertia and the resistance to rolling say") {
  const auto world = make_small_steps_world();
  world->set_gravity({0, 0, -kGravity});
  const double angle = 20 * M_PI / 180, radius = 0.3;
  const Eigen::Quaterniond lean(Eigen::AngleAxisd(angle, Vec3::UnitY()));
  ObstacleDescription plane = box_obstacle({20, 5, 0.5}, lean * Vec3(0, 0, -0.5));
  plane.pose.orientation = lean;
  world->add_obstacle(plane);
  BodyDescription ball = ball_body(radius, 200, lean * Vec3(0, 0, radius));
  ball.velocity = entering({0, 0, 0});
  const BodyId id = world->add_body(ball);
  run(*world, 120);
  // m a = m g sin - F and 2/5 m r^2 a/r = F r - c r m g cos: 7/5 a = g (sin - c cos).
  const double slowed = std::sin(angle) - SolverSettings{}.rolling_resistance * std::cos(angle);
  const double way = kGravity * slowed / 1.4 * 2 * 2 / 2;
  // First order in the step: resistance acts at its end.
  CHECK((world->state(id).pose.position - ball.pose.position).norm() == Approx(way).epsilon(0.02));
}

TEST_CASE("small steps: a fast top on a joint that turns freely precesses as its spin and weight say") {
  const auto world = make_small_steps_world();
  world->set_gravity({0, 0, -kGravity});
  const double arm = 0.8, mass = 50, spin = 60;
  BodyDescription top = box_body({0.05, 0.4, 0.4}, mass, {arm, 0, 5});
  const double along = top.inertia(0, 0), precession = mass * kGravity * arm / (along * spin);  // axis level: exact
  top.angular_velocity = Vec3(spin, 0, precession);
  top.velocity = entering(Vec3(0, 0, precession).cross(Vec3(arm, 0, 0)));
  const BodyId id = world->add_body(top);
  HingeDescription joint;
  joint.body = id;
  joint.point = Vec3(0, 0, 5);
  joint.held = {true, true, true, false, false, false};
  world->add_hinge(joint);
  double turned = 0, before = 0;
  for (int i = 0; i < 240; ++i) {
    world->step(1.0 / 240);
    const Vec3 at = world->state(id).pose.position;
    const double now = std::atan2(at.y(), at.x());
    turned += std::remainder(now - before, 2 * M_PI);
    before = now;
    CHECK(std::abs(at.z() - 5) < 0.05 * arm);
  }
  CHECK(turned == Approx(precession).epsilon(0.03));  // in a second
}

TEST_CASE("small steps: of balls in a row that do not touch yet, the last takes the speed of the first") {
  const auto world = make_small_steps_world();
  std::vector<BodyId> row;
  for (int i = 0; i < 4; ++i) {
    BodyDescription ball = ball_body(0.25, 30, {0.8 * i, 0, 0});
    ball.restitution = 1;
    ball.friction = 0;
    if (i == 0) ball.velocity = Vec3(4, 0, 0);
    row.push_back(world->add_body(ball));
  }
  run(*world, 60);
  for (int i = 0; i < 3; ++i) CHECK(std::abs(world->state(row[static_cast<std::size_t>(i)]).velocity.x()) < 1e-9 * 4);
  CHECK(world->state(row[3]).velocity.x() == Approx(4).epsilon(1e-9));
}

TEST_CASE("small steps: a post that spins end over end does not go into the ground that it falls on") {
  const auto world = make_small_steps_world();
  world->set_gravity({0, 0, -kGravity});
  world->set_ground(0, 0.6, 0.1);
  BodyDescription post = box_body({2, 0.15, 0.15}, 900, {0, 0, 3});
  post.angular_velocity = Vec3(0, 20, 0);  // its ends at 40 m/s: 19 degrees in a step
  post.velocity = Vec3(0, 0, -4);
  const BodyId id = world->add_body(post);
  double deepest = 0;
  for (int i = 0; i < 180; ++i) {
    world->step(kStep);
    const Pose pose = world->state(id).pose;
    for (const double x : {-2.0, 2.0})
      for (const double y : {-0.15, 0.15})
        for (const double z : {-0.15, 0.15}) deepest = std::max(deepest, -(pose * Vec3(x, y, z)).z());
  }
  CHECK(deepest < 0.01);  // what a body may leave the planes of its contacts by in a part of a step
}

TEST_CASE("small steps: a pile that falls as one is stopped where it lands, all through") {
  const auto world = make_small_steps_world();
  world->set_gravity({0, 0, -kGravity});
  world->set_ground(0, 0.6, 0.1);
  const double gap = 0.001, thick = 0.2, begin = 5;  // 10 m/s
  std::vector<BodyId> pile;
  for (int i = 0; i < 20; ++i) {
    BodyDescription slab = box_body({2, 2, thick / 2}, 2000, {0, 0, begin + i * (thick + gap)});
    slab.restitution = 0;
    pile.push_back(world->add_body(slab));
  }
  double deepest = 0, lost = 0, created = 0;
  const auto energy = [&] {
    double sum = 0;
    for (const BodyId id : pile) {
      const BodyState state = world->state(id);
      const Vec3 velocity = state.velocity - Vec3(0, 0, kGravity * kStep / 2);
      sum += 2000 * (velocity.squaredNorm() / 2 + kGravity * state.pose.position.z());
    }
    return sum;
  };
  const double first = energy();
  double before = first;
  for (int i = 0; i < 180; ++i) {
    world->step(kStep);
    for (const Contact& contact : world->contacts()) lost += contact.work_lost;
    for (std::size_t k = 0; k < pile.size(); ++k) {
      const double low = k > 0 ? world->state(pile[k - 1]).pose.position.z() + thick / 2 : 0;
      deepest = std::max(deepest, low - (world->state(pile[k]).pose.position.z() - thick / 2));
    }
    if (world->awake_count() < pile.size()) break;  // what sleeps has no velocity
    created += std::max(0.0, energy() - before);
    before = energy();
  }
  CHECK(deepest < 0.01);
  CHECK(created < 0.01 * (first - before));
  CHECK(lost == Approx(first - before).epsilon(1e-5));  // the slabs' turning is left out
}

TEST_CASE(
    "small steps: what is told after each step to pass an obstacle passes it, though each step is swept as well") {
  const auto world = world_with_gravity();
  const ObstacleId mast = world->add_obstacle(box_obstacle({0.1, 0.1, 5}, {-0.1, 0, 5}));
  const BodyId beam = world->add_body(box_body({2, 0.1, 0.1}, 230, {2.09, 0, 9.9}));
  HingeDescription pin;
  pin.body = beam;
  pin.point = Vec3(0.09, 0, 9.9);  // as it turns, its end comes into the mast by 10 mm, slowly
  pin.held = {true, true, true, true, false, true};
  world->add_hinge(pin);
  Touched touched;
  touched.kind = Touched::Kind::obstacle;
  touched.obstacle = mast;
  world->ignore_until_separated(beam, touched);
  for (int i = 0; i < 120; ++i) {
    CHECK(world->sweep(kStep).empty());
    world->step(kStep);
    CHECK(world->contacts().empty());
    world->ignore_until_separated(beam, touched);
  }
}

TEST_CASE(
    "small steps: a heavy body that strikes a slender one aslant keeps momentum, and spins it up from nothing else") {
  const auto world = make_small_steps_world();
  // A beam of 6 m lies on one; the other strikes its overhanging end, and goes sideways as well.
  const double mass = 300, heavy = 1e5;
  const Vec3 coming(0, 25, -20);
  const BodyDescription beam = box_body({3, 0.1, 0.2}, mass, {2.7, 0, 0.2});
  const BodyDescription below = box_body({1.5, 1, 0.5}, heavy, {1.7, 0, -0.5});
  BodyDescription strikes = box_body({1.5, 1, 0.5}, heavy, {-1.6, 0, 0.95});
  strikes.velocity = coming;
  std::vector<std::pair<BodyId, const BodyDescription*>> all;
  for (const BodyDescription* one : {&beam, &below, static_cast<const BodyDescription*>(&strikes)})
    all.emplace_back(world->add_body(*one), one);
  struct Sums {
    Vec3 momentum = Vec3::Zero(), angular = Vec3::Zero();
    double energy = 0;
  };
  const auto sums = [&] {
    Sums result;
    for (const auto& [id, made] : all) {
      const BodyState state = world->state(id);
      const Mat3 turn = state.pose.orientation.toRotationMatrix();
      const Vec3 spin = turn * made->inertia * turn.transpose() * state.angular_velocity;
      result.momentum += made->mass * state.velocity;
      result.angular += made->mass * state.pose.position.cross(state.velocity) + spin;
      result.energy += (made->mass * state.velocity.squaredNorm() + state.angular_velocity.dot(spin)) / 2;
    }
    return result;
  };
  const Sums before = sums();
  double spun = 0;
  for (int i = 0; i < 60; ++i) {
    world->step(kStep);
    const Sums now = sums();
    CHECK((now.momentum - before.momentum).norm() < 1e-12 * before.momentum.norm());
    CHECK((now.angular - before.angular).norm() < 1e-6 * before.angular.norm());
    CHECK(now.energy < before.energy * (1 + 1e-9));
    spun = std::max(spun, world->state(all[0].first).angular_velocity.norm());
  }
  CHECK(spun > 1);
  CHECK(spun < 250);  // rolled by what slides over it: 25 m/s at 0.1 m from its axis
}

TEST_CASE("small steps: of two balls that hang side by side, each swings out as high as the other fell, in turn") {
  const auto world = world_with_gravity();
  const double length = 3, radius = 0.25, angle = 0.7, dt = 1.0 / 240;
  std::vector<BodyId> hung;
  for (int i = 0; i < 2; ++i) {
    const Vec3 anchor(2 * radius * i, 0, length);
    BodyDescription ball = ball_body(radius, 30, anchor - Vec3(0, 0, length));
    if (i == 0) ball.pose.position = anchor - length * Vec3(std::sin(angle), 0, std::cos(angle));
    ball.restitution = 1;
    ball.friction = 0;
    hung.push_back(world->add_body(ball));
    CableDescription cable;
    cable.body = hung.back();
    cable.anchor = anchor;
    cable.length = length;
    world->add_cable(cable);
  }
  const double fell = length * (1 - std::cos(angle));
  // From impact to impact, of a pendulum of this amplitude; the first comes after half of that.
  const double half = M_PI * std::sqrt(length / kGravity) * (1 + angle * angle / 16 + 11 * std::pow(angle, 4) / 3072);
  const auto highest = [&](int ball, double seconds) {
    double height = 0;
    for (int i = 0; i < static_cast<int>(seconds / dt); ++i) {
      world->step(dt);
      height = std::max(height, world->state(hung[static_cast<std::size_t>(ball)]).pose.position.z());
    }
    return height;
  };
  // Contacts are foreseen for a step, and the ball is lower or higher by what it swings in one: 1e-3 of the height.
  CHECK(highest(1, 1.25 * half) == Approx(fell).epsilon(1e-3));
  CHECK(highest(0, half) == Approx(fell).epsilon(1e-3));
}

TEST_CASE("small steps: a panel that lands aslant on a corner does not go into the ground with the others") {
  for (const double lean : {0.03, 0.06, 0.1, 0.2}) {
    CAPTURE(lean);
    const auto world = make_small_steps_world();
    world->set_gravity({0, 0, -kGravity});
    world->set_ground(0, 0.6, 0.1);
    const Vec3 half(1.5, 1.5, 0.1);
    BodyDescription panel = box_body(half, 4500, {0, 0, 2});
    panel.pose.orientation = Eigen::AngleAxisd(lean, Vec3(1, 0.4, 0).normalized());
    panel.velocity = Vec3(0, 0, -10);  // it goes almost as far in a step as it is thick
    const BodyId id = world->add_body(panel);
    double deepest = 0;
    for (int i = 0; i < 60; ++i) {
      world->step(kStep);
      const Pose pose = world->state(id).pose;
      for (int corner = 0; corner < 8; ++corner) {
        const Vec3 sides(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        deepest = std::max(deepest, -(pose * half.cwiseProduct(sides)).z());
      }
    }
    CHECK(deepest < 0.02);  // what a body may leave the planes of its contacts by in a part of a step
  }
}
