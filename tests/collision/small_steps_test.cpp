// The contact solver of our own in small steps, against closed forms: what rests, slides, rolls, collides and hangs.
#include "topple/collision/small_steps.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "pressing.h"
#include "random_chunk.h"
#include "world_builder.h"

using namespace collision_test;

namespace {

std::unique_ptr<World> small_steps(bool ground, double friction = 0.6, double restitution = 0) {
  auto world = make_small_steps_world();
  world->set_gravity({0, 0, -kGravity});
  if (ground) world->set_ground(0, friction, restitution);
  return world;
}

/// A box on a plane that leans by `angle`, friction of both `friction`: how far it is after a second, m.
double slid(double angle, double friction) {
  const auto world = small_steps(false);
  ObstacleDescription plane = box_obstacle({20, 5, 0.5}, {0, 0, 0});
  const Eigen::Quaterniond lean(Eigen::AngleAxisd(angle, Vec3::UnitY()));
  plane.pose.position = lean * Vec3(0, 0, -0.5);
  plane.pose.orientation = lean;
  plane.friction = friction;
  world->add_obstacle(plane);
  BodyDescription box = box_body({0.5, 0.5, 0.1}, 400, lean * Vec3(0, 0, 0.1));
  box.pose.orientation = lean;
  box.friction = friction;
  box.velocity = entering({0, 0, 0});
  const BodyId id = world->add_body(box);
  run(*world, 60);
  return (world->state(id).pose.position - box.pose.position).norm();
}

}  // namespace

TEST_CASE(
    "small steps: a heavy box lies on a light one, up to a thousand times its mass, and both press with their weight") {
  // m: as deep as the springs of the solver's settings give under that load, and a half.
  for (const auto& [ratio, deepest] : {std::pair{10.0, 0.0007}, {100.0, 0.0025}, {1000.0, 0.017}}) {
    CAPTURE(ratio);
    const auto world = small_steps(true);
    const BodyId light = world->add_body(box_body({0.5, 0.5, 0.5}, 100, {0, 0, 0.5}));
    const BodyId heavy = world->add_body(box_body({0.5, 0.5, 0.5}, 100 * ratio, {0, 0, 1.5}));
    Pressing pressing;
    for (int i = 0; i < 240; ++i) {
      world->step(kStep);
      pressing.read(*world);
    }
    CHECK(world->awake_count() == 0);
    CHECK(world->state(light).pose.position.z() > 0.5 - deepest);
    CHECK(world->state(heavy).pose.position.z() > 1.5 - 2 * deepest);
    const double weight = 100 * (1 + ratio) * kGravity;
    // What sleeps is in balance to a millionth of its own weight.
    CHECK(-pressing.on_standing().z() == Approx(weight).epsilon(1e-5));
    CHECK((pressing.on_body(light.value) - Vec3(0, 0, 100 * kGravity)).norm() < 1e-5 * 100 * kGravity);
  }
}

TEST_CASE("small steps: a box on a slope stays below the angle of friction and slides above it as Coulomb says") {
  for (const double friction : {0.3, 0.6}) {
    CAPTURE(friction);
    const double angle = std::atan(friction);
    CHECK(slid(0.99 * angle, friction) < 0.002);
    // a = g (sin - mu cos), for a second; it begins 0.1 mm above the plane.
    const double steep = 1.2 * angle, expected = kGravity * (std::sin(steep) - friction * std::cos(steep)) / 2;
    CHECK(slid(steep, friction) == Approx(expected).epsilon(0.02));
    CHECK(slid(1.01 * angle, friction) >
          0.5 * kGravity * (std::sin(1.01 * angle) - friction * std::cos(1.01 * angle)) / 2);
  }
}

TEST_CASE("small steps: a plank against a wall without friction presses on it as statics says") {
  const auto world = small_steps(true);
  ObstacleDescription wall = box_obstacle({0.15, 3, 2}, {-0.15, 0, 2});
  wall.friction = 0;
  world->add_obstacle(wall);
  const double lean = 25 * M_PI / 180, mass = 3000;
  BodyDescription plank = box_body({0.1, 1, 1.5}, mass, Vec3::Zero());
  plank.pose.orientation = Eigen::AngleAxisd(-lean, Vec3::UnitY());
  const Vec3 top = plank.pose.orientation * Vec3(-0.1, 0, 1.5), foot = plank.pose.orientation * Vec3(0.1, 0, -1.5),
             heel = plank.pose.orientation * Vec3(-0.1, 0, -1.5);
  const Vec3 low = foot.z() < heel.z() ? foot : heel;
  plank.pose.position = Vec3(-top.x(), 0, -low.z());
  world->add_body(plank);
  Pressing pressing;
  for (int i = 0; i < 240; ++i) {
    world->step(kStep);
    pressing.read(*world);
  }
  REQUIRE(world->awake_count() == 0);
  double on_wall = 0;
  for (const auto& [key, contact] : pressing.all())
    if (contact.other.kind == Touched::Kind::obstacle) on_wall += contact.impulse.norm() / kStep;
  // Moments about the foot.
  CHECK(on_wall == Approx(mass * kGravity * std::abs(low.x()) / (top.z() - low.z())).epsilon(0.002));
  CHECK(-pressing.on_standing().z() == Approx(mass * kGravity).epsilon(1e-5));
}

TEST_CASE("small steps: what a heap rests with balances the weight of each of its bodies, within friction") {
  const auto world = small_steps(true);
  std::mt19937 random(3);
  for (int i = 0; i < 45; ++i)
    world->add_body(chunk(random, {1.2 * (i % 3) - 1.2, 1.2 * (i / 3 % 3) - 1.2, 1 + 0.9 * (i / 9)}));
  Pressing pressing;
  int steps = 0;
  for (; world->awake_count() > 0 && steps < 60 * 12; ++steps) {
    world->step(kStep);
    pressing.read(*world);
  }
  REQUIRE(world->awake_count() == 0);
  for (const BodyId id : world->bodies()) {
    const Vec3 missing = pressing.on_body(id.value) - Vec3(0, 0, 250 * kGravity);
    CHECK(missing.norm() < 1e-3 * 250 * kGravity);
  }
  for (const auto& [key, contact] : pressing.all()) {
    const double normal = contact.impulse.dot(contact.normal),
                 across = (contact.impulse - normal * contact.normal).norm();
    CHECK(normal >= -1e-9);  // N s, rounding
    CHECK(across <= 0.6 * normal * (1 + 1e-9) + 1e-9);
  }
  CHECK(-pressing.on_standing().z() == Approx(45 * 250 * kGravity).epsilon(1e-3));
}

namespace {
/// Whether some of from + t along, 0 <= t <= 1, is inside of the box about the origin.
bool line_meets_box(const Vec3& from, const Vec3& along, const Vec3& half_extents) {
  double begin = 0, end = 1;
  for (int i = 0; i < 3; ++i) {
    if (along[i] == 0) {
      if (std::abs(from[i]) >= half_extents[i]) return false;
      continue;
    }
    const double a = (-half_extents[i] - from[i]) / along[i], b = (half_extents[i] - from[i]) / along[i];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  return begin < end;
}
}  // namespace

TEST_CASE("small steps: neither thin slabs that fall at 20 m/s nor posts that spin are passed through") {
  const auto world = small_steps(true);
  world->add_obstacle(box_obstacle({3, 3, 0.05}, {0, 0, 4}));
  BodyDescription slab = box_body({1.5, 1.5, 0.05}, 560, {0.2, 0.1, 6.1});
  slab.velocity = Vec3(0, 0, -20);
  slab.pose.orientation = Eigen::AngleAxisd(0.1, Vec3(1, 0.3, 0).normalized());
  const BodyId falling = world->add_body(slab);
  // A post that stands on the ground, and one that comes round at 12 m/s at its tip.
  world->add_obstacle(box_obstacle({0.15, 0.15, 1.5}, {20, 0, 1.5}));
  BodyDescription spinning = box_body({2, 0.1, 0.1}, 200, {20, -2.1, 1});
  spinning.angular_velocity = Vec3(0, 0, 6);
  spinning.velocity = Vec3(0, 3, 0);
  const BodyId post = world->add_body(spinning);
  double least = 10;
  for (int i = 0; i < 120; ++i) {
    world->step(kStep);
    least = std::min(least, world->state(falling).pose.position.z());
    const Pose& pose = world->state(post).pose;
    CHECK_FALSE(line_meets_box(pose.orientation.conjugate() * (Vec3(20, 0, 0) - pose.position),
                               pose.orientation.conjugate() * Vec3(0, 0, 3), {2, 0.1, 0.1}));
  }
  CHECK(least > 4);
}

TEST_CASE("small steps: boxes born inside each other come apart without being thrown") {
  const auto world = make_small_steps_world();
  const BodyId first = world->add_body(box_body({0.5, 0.5, 0.5}, 100, {0, 0, 0})),
               second = world->add_body(box_body({0.5, 0.5, 0.5}, 300, {0.8, 0, 0}));
  run(*world, 60);
  const BodyState a = world->state(first), b = world->state(second);
  // Pushed apart at 3 m/s; one pass over four points takes that speed out again but for about a sixth.
  CHECK(b.pose.position.x() - a.pose.position.x() > 0.998);
  CHECK((b.velocity - a.velocity).norm() < 0.6);
  CHECK((100 * a.velocity + 300 * b.velocity).norm() < 1e-12 * 100);
}

TEST_CASE("small steps: momentum and angular momentum are kept to rounding, and two runs agree to the bit") {
  const auto thrown = [] {
    auto world = make_small_steps_world();
    std::mt19937 random(9);
    for (int i = 0; i < 27; ++i) {
      BodyDescription body = chunk(random, {1.3 * (i % 3 - 1), 1.3 * (i / 3 % 3 - 1), 1.3 * (i / 9 - 1)});
      body.velocity = -2 * body.pose.position;
      body.angular_velocity = Vec3(1, -0.5, 0.3 * (i % 4));
      world->add_body(body);
    }
    return world;
  };
  const auto world = thrown(), again = thrown();
  const auto momentum = [&] {
    Vec3 sum = Vec3::Zero();
    for (const BodyId id : world->bodies()) sum += 250 * world->state(id).velocity;
    return sum;
  };
  const auto angular = [&](const Mat3& inertia) {
    Vec3 sum = Vec3::Zero();
    for (const BodyId id : world->bodies()) {
      const BodyState state = world->state(id);
      const Mat3 axes = state.pose.orientation.toRotationMatrix();
      sum +=
          250 * state.pose.position.cross(state.velocity) + axes * inertia * axes.transpose() * state.angular_velocity;
    }
    return sum;
  };
  const Mat3 inertia = box_inertia(250, {0.4, 0.4, 0.1});
  const Vec3 before = momentum(), angular_before = angular(inertia);
  run(*world, 120);
  run(*again, 120);
  CHECK((angular(inertia) - angular_before).norm() < 1e-13 * 27 * 250 * 4);
  CHECK((momentum() - before).norm() < 1e-14 * 27 * 250 * 4);  // rounding of sums of that size
  for (const BodyId id : world->bodies()) {
    CHECK(world->state(id).pose.position == again->state(id).pose.position);
    CHECK(world->state(id).angular_velocity == again->state(id).angular_velocity);
  }
}

TEST_CASE("small steps: forces of a step balance weight and change of momentum") {
  const auto world = small_steps(true, 0.6, 0.1);
  std::mt19937 random(4);
  for (int i = 0; i < 18; ++i)
    world->add_body(chunk(random, {1.2 * (i % 3) - 1.2, 1.2 * (i / 3 % 3) - 1.2, 1 + 0.9 * (i / 9)}));
  for (int i = 0; i < 90; ++i) {
    Vec3 change = Vec3::Zero(), pushed = Vec3::Zero();
    for (const BodyId id : world->bodies()) change -= 250 * world->state(id).velocity;
    const std::size_t awake = world->awake_count();
    world->step(kStep);
    if (awake < 18 || world->awake_count() < 18) break;  // what sleeps is set to no speed at all
    for (const BodyId id : world->bodies()) change += 250 * world->state(id).velocity;
    for (const Contact& contact : world->contacts())
      if (contact.other.kind == Touched::Kind::ground) pushed -= contact.impulse;
    const Vec3 weight(0, 0, -18 * 250 * kGravity * kStep);
    CHECK((change - pushed - weight).norm() < 1e-11 * weight.norm());
  }
}

TEST_CASE("small steps: what contacts tell is each body's change of angular momentum about a point fixed in space") {
  const auto world = small_steps(true, 0.6, 0.1);
  std::mt19937 random(4);
  for (int i = 0; i < 18; ++i) {
    BodyDescription body = chunk(random, {1.2 * (i % 3) - 1.2, 1.2 * (i / 3 % 3) - 1.2, 1 + 0.9 * (i / 9)});
    body.velocity = Vec3(3, 0, -8);
    body.angular_velocity = Vec3(4, 25, -3);  // so fast that steps are taken in parts
    world->add_body(body);
  }
  const Mat3 inertia = box_inertia(250, {0.4, 0.4, 0.1});
  const auto angular = [&](BodyId id) {
    const BodyState state = world->state(id);
    const Mat3 axes = state.pose.orientation.toRotationMatrix();
    return Vec3(250 * state.pose.position.cross(state.velocity) +
                axes * inertia * axes.transpose() * state.angular_velocity);
  };
  const Vec3 weight(0, 0, -250 * kGravity * kStep);
  int steps = 0;
  for (int i = 0; i < 60; ++i) {
    std::vector<Vec3> change;
    for (const BodyId id : world->bodies())  // gravity acts where velocities, as they are stored, have it
      change.push_back(-angular(id) - world->state(id).pose.position.cross(weight));
    world->step(kStep);
    if (world->awake_count() < 18) break;  // what sleeps is set to no speed at all
    ++steps;
    for (const BodyId id : world->bodies()) change[static_cast<std::size_t>(id.value)] += angular(id);
    for (const Contact& contact : world->contacts()) {
      const Vec3 told = contact.point.cross(contact.impulse) + contact.moment;
      change[static_cast<std::size_t>(contact.body.value)] += told;
      if (contact.other.kind == Touched::Kind::body) change[static_cast<std::size_t>(contact.other.body.value)] -= told;
    }
    // N m s; a step in parts misses by what gravity does within it: in each, velocities are read half a part later.
    for (const Vec3& lost : change) CHECK(lost.norm() < 0.01 * weight.norm());
  }
  CHECK(steps > 20);
}

TEST_CASE("small steps: a ball swings on a cable as the pendulum does, and a cantilever holds its weight and moment") {
  const auto world = small_steps(false);
  BodyDescription ball = ball_body(0.5, 3000, {1 + 20 * std::sin(M_PI / 2), 2, 30});
  ball.velocity = Vec3(0, 0, kGravity * kStep / 2);  // at rest now, read at mid-step
  const BodyId hung = world->add_body(ball);
  const CableId cable = world->add_cable({hung, {1, 2, 30}, 20});
  const double arm = 1.5, weight = 360 * kGravity;
  const BodyId bar = world->add_body(box_body({arm, 0.1, 0.2}, 360, {100 + arm, 0, 3}));
  HingeDescription joint;
  joint.body = bar;
  joint.point = Vec3(100, 0, 3);
  const HingeId hinge = world->add_hinge(joint);
  double largest = 0;
  for (int i = 0; i < 240; ++i) {
    world->step(kStep);
    largest = std::max(largest, world->cable_pull(cable).tension);
    CHECK((world->state(hung).pose.position - Vec3(1, 2, 30)).norm() == Approx(20).epsilon(1e-12));
  }
  CHECK(largest == Approx(3 * 3000 * kGravity).epsilon(1e-3));  // let go from the horizontal: 3 W
  const auto force = world->hinge_force(hinge);
  CHECK((force.head<3>() - Vec3(0, 0, -weight)).norm() < 1e-3 * weight);
  CHECK((force.tail<3>() - Vec3(0, weight * arm, 0)).norm() < 1e-3 * weight * arm);
}

TEST_CASE("small steps: what contacts took is what is missing in the energy of a body that falls, bounces and slides") {
  const auto world = small_steps(true, 0.5, 0.3);
  const double mass = 120;
  BodyDescription box = box_body({0.6, 0.3, 0.2}, mass, {0, 0, 2});
  box.pose.orientation = Eigen::Quaterniond(0.8, 0.3, 0.1, 0.2).normalized();
  box.velocity = entering({4, 1, -3});
  const BodyId id = world->add_body(box);
  const auto energy = [&] {
    const BodyState state = world->state(id);
    const Vec3 velocity = state.velocity - Vec3(0, 0, kGravity * kStep / 2);
    const Mat3 axes = state.pose.orientation.toRotationMatrix();
    return mass * (velocity.squaredNorm() / 2 + kGravity * state.pose.position.z()) +
           state.angular_velocity.dot(axes * box.inertia * axes.transpose() * state.angular_velocity) / 2;
  };
  const double start = energy();
  double lost = 0;
  for (int i = 0; i < 240 && !world->state(id).asleep; ++i) {
    world->step(kStep);
    if (world->state(id).asleep) break;
    for (const Contact& contact : world->contacts()) lost += contact.work_lost;
    // Free rotation keeps its energy to the square of 0.05 rad.
    REQUIRE(std::abs(start - energy() - lost) < 5e-3 * start);
  }
  CHECK(lost > 0.5 * start);
}

TEST_CASE("small steps: taking away what bears a stack wakes it, and it falls one upon the other") {
  const auto world = small_steps(true);
  const ObstacleId table = world->add_obstacle(box_obstacle({1, 1, 0.5}, {0, 0, 2.5}));
  const BodyId lower = world->add_body(box_body({0.5, 0.5, 0.25}, 600, {0, 0, 3.25})),
               upper = world->add_body(box_body({0.5, 0.5, 0.25}, 600, {0, 0, 3.75})),
               elsewhere = world->add_body(box_body({0.5, 0.5, 0.25}, 600, {9, 0, 0.25}));
  run(*world, 90);
  REQUIRE(world->awake_count() == 0);
  const std::vector<Contact> swept = world->sweep(kStep);
  CHECK(swept.empty());
  world->remove_obstacle(table);
  run(*world, 10);
  // Free fall, but for the steps in which the loss of the load was noticed.
  CHECK(world->state(lower).velocity.z() < -9 * kGravity * kStep);
  CHECK(world->state(upper).velocity.z() < -6 * kGravity * kStep);
  CHECK(world->state(elsewhere).asleep);
}
