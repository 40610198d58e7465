// How what the contact solver in small steps holds comes to rest, and what it rests with.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "solver/equilibrium.h"
#include "topple/collision/small_steps.h"
#include "world_builder.h"

using namespace collision_test;

namespace {

using Rows = RestContact::Rows;

Rows random_rows(std::mt19937& random) {
  Rows made;
  for (int i = 0; i < 7; ++i) made[i] = (random() % 2001) / 1000.0 - 1;
  return made;
}

/// A member of the cone n >= 0, |T| <= friction (sum of n).
Rows member(std::mt19937& random, int count, double friction) {
  Rows made = random_rows(random);
  double pressed = 0;
  for (int i = 0; i < 4; ++i) {
    made[i] = i < count ? std::abs(made[i]) : 0;
    pressed += made[i];
  }
  const double size = made.tail<3>().norm();
  made.tail<3>() *= friction * pressed * ((random() % 1001) / 1000.0) / size;
  return made;
}

/// A plank of slope `lean` from upright against a wall without friction; whether it stays for ten seconds.
bool stays(double lean, double friction) {
  const auto world = make_small_steps_world();
  world->set_gravity({0, 0, -kGravity});
  world->set_ground(0, friction, 0);
  ObstacleDescription wall = box_obstacle({0.15, 3, 3}, {-0.15, 0, 3});
  wall.friction = 0;
  world->add_obstacle(wall);
  BodyDescription plank = box_body({0.02, 1, 1.5}, 600, Vec3::Zero());
  plank.friction = friction;
  plank.pose.orientation = Eigen::AngleAxisd(-lean, Vec3::UnitY());
  const Vec3 top = plank.pose.orientation * Vec3(-0.02, 0, 1.5), foot = plank.pose.orientation * Vec3(-0.02, 0, -1.5),
             heel = plank.pose.orientation * Vec3(0.02, 0, -1.5);
  plank.pose.position = Vec3(-top.x(), 0, -std::min(foot.z(), heel.z()));
  const BodyId id = world->add_body(plank);
  run(*world, 600);
  return (world->state(id).pose.position - plank.pose.position).norm() < 0.01;
}

}  // namespace

TEST_CASE("the projection on a contact's cone is the nearest point of it, and its derivative is that of differences") {
  std::mt19937 random(5);
  for (int trial = 0; trial < 400; ++trial) {
    CAPTURE(trial);
    const int count = 1 + static_cast<int>(random() % 4);
    const double friction = 0.1 + (random() % 1000) / 1000.0;
    Rows stiffness = Rows::Ones();
    for (int i = 0; i < 4; ++i) stiffness[i] = 0.2 + (random() % 1000) / 500.0;
    stiffness.tail<3>().setConstant(0.2 + (random() % 1000) / 500.0);
    Rows z = random_rows(random);
    for (int i = count; i < 4; ++i) z[i] = 0;
    Rows nearest;
    RestContact::Square gives;
    project_on_cone(z, stiffness, count, friction, nearest, gives);
    CHECK(nearest.head<4>().minCoeff() >= 0);
    CHECK(nearest.tail<3>().norm() <= friction * nearest.head<4>().sum() + 1e-12);
    // Of a convex cone (Moreau): what is left over is at right angles to it, and leads away from all of the cone.
    const Rows left = (z - nearest).cwiseQuotient(stiffness);
    CHECK(std::abs(left.dot(nearest)) < 1e-12);
    for (int k = 0; k < 20; ++k) CHECK(left.dot(member(random, count, friction)) < 1e-12);
    const double h = 1e-6;
    for (int i = 0; i < 7; ++i) {
      if (i >= count && i < 4) continue;
      Rows before = z, after = z, low, high;
      before[i] -= h, after[i] += h;
      RestContact::Square unused;
      project_on_cone(before, stiffness, count, friction, low, unused);
      project_on_cone(after, stiffness, count, friction, high, unused);
      const Rows slope = (high - low) / (2 * h) * stiffness[i];
      // One in a thousand of these points lies within h of a fold of the cone, where there is no derivative.
      if ((slope - gives.col(i)).norm() > 1e-4) CHECK(left.cwiseAbs().maxCoeff() < 0.1);
    }
  }
}

TEST_CASE("a plank against a smooth wall stays one per cent inside the cone of its foot, and slides one outside") {
  const double lean = 35 * M_PI / 180;
  // Moments about the foot, W (x of the middle) = H (z of the top); the foot bears W and H.
  const Eigen::AngleAxisd turn(-lean, Vec3::UnitY());
  const Vec3 top = turn * Vec3(-0.02, 0, 1.5), foot = turn * Vec3(-0.02, 0, -1.5), heel = turn * Vec3(0.02, 0, -1.5);
  const Vec3 low = foot.z() < heel.z() ? foot : heel;
  const double needed = std::abs(low.x()) / (top.z() - low.z());
  CHECK(stays(lean, 1.01 * needed));
  CHECK_FALSE(stays(lean, 0.99 * needed));
}

TEST_CASE("a box that slides and spins is held by one bound for both, and by no more") {
  const auto world = make_small_steps_world();
  world->set_gravity({0, 0, -kGravity});
  const double friction = 0.5, half = 0.4, mass = 100;
  world->set_ground(0, friction, 0);
  BodyDescription box = box_body({half, half, 0.05}, mass, {0, 0, 0.05});
  box.friction = friction;
  box.velocity = entering({0.5, 0, 0});
  box.angular_velocity = Vec3(0, 0, 6);
  world->add_body(box);
  const double lever = std::sqrt(2.0) * half;
  for (int i = 0; i < 12; ++i) {
    world->step(kStep);
    REQUIRE(world->contacts().size() == 1);
    const Contact& contact = world->contacts()[0];
    const double pressed = contact.impulse.dot(contact.normal);
    const Vec3 across = contact.impulse - pressed * contact.normal;
    const double twist = contact.moment.dot(contact.normal);
    // Where it is pressed shifts to the front by friction times its height, an eighth of its half: so does the lever.
    if (i > 1) CHECK(std::hypot(across.norm(), twist / lever) == Approx(friction * pressed).epsilon(0.02));
    CHECK(across.norm() <= friction * pressed * (1 + 1e-12));
  }
}

TEST_CASE("slabs that fall one behind the other land on each other, though they did not close in the air") {
  const auto world = make_small_steps_world();
  world->set_gravity({0, 0, -kGravity});
  world->set_ground(0, 0.6, 0.1);
  std::vector<BodyId> slabs;
  for (int i = 0; i < 8; ++i) {
    BodyDescription slab = box_body({3, 3, 0.1}, 18000, {0, 0, 1 + 0.25 * i});
    slab.velocity = Vec3(0, 0, -12);
    slabs.push_back(world->add_body(slab));
  }
  double deepest = 0;
  for (int k = 0; k < 120; ++k) {
    world->step(kStep);
    double below = -0.1;
    for (const BodyId id : slabs) {
      const double z = world->state(id).pose.position.z();
      deepest = std::max(deepest, below + 0.2 - z);
      below = z;
    }
  }
  // A seventh of the thickness; at 12 m/s each goes 0.2 m in a step.
  CHECK(deepest < 0.03);
}

TEST_CASE("a post that lies across the edge of a slab comes to rest on it, and does not rock for ever") {
  const auto world = make_small_steps_world();
  world->set_gravity({0, 0, -kGravity});
  world->set_ground(0, 0.6, 0.1);
  ObstacleDescription slab = box_obstacle({3, 3, 0.1}, {0, 0, 0.1});
  slab.pose.orientation = Eigen::AngleAxisd(0.4, Vec3::UnitZ());
  world->add_obstacle(slab);
  BodyDescription post = box_body({0.15, 0.15, 2}, 900, {3.6, 0.3, 0.6});
  post.pose.orientation = Eigen::AngleAxisd(M_PI / 2 + 0.12, Vec3::UnitY()) * Eigen::AngleAxisd(0.05, Vec3::UnitZ());
  const BodyId id = world->add_body(post);
  run(*world, 300);
  CHECK(world->state(id).asleep);
}

TEST_CASE("small steps: a stone stays on its base, though corners beside it are near the ground as well") {
  const auto world = make_small_steps_world();
  world->set_gravity({0, 0, -kGravity});
  world->set_ground(0, 0.6, 0);
  BodyDescription stone = box_body({0.15, 0.15, 0.1}, 40, {0, 0, 0.1});
  ConvexPart hull;
  hull.kind = ConvexPart::Kind::hull;
  // Four corners of the base, two 7 mm over the ground farther out, and the top.
  hull.points = {{0.054, -0.150, -0.1},   {0.160, 0.019, -0.1},   {-0.067, 0.159, -0.1}, {-0.172, -0.011, -0.1},
                 {0.070, -0.160, -0.093}, {0.175, 0.009, -0.093}, {0.054, -0.150, 0.1},  {0.160, 0.019, 0.1},
                 {-0.067, 0.159, 0.1},    {-0.172, -0.011, 0.1}};
  stone.parts = {hull};
  const BodyId id = world->add_body(stone);
  run(*world, 30);
  double turning = 0;
  for (int i = 0; i < 30; ++i) {
    world->step(kStep);
    turning = std::max(turning, world->state(id).angular_velocity.norm());
  }
  CHECK(turning < 1e-3);  // it rocked at 0.1 rad/s when a corner of the base gave way to one over the ground
  run(*world, 60);
  CHECK(world->state(id).asleep);
}

namespace {

/// A ball on ground that slopes so steeply, 5 s after it was put there.
struct BallOnSlope {
  explicit BallOnSlope(double slope) {
    const double angle = std::atan(slope);
    world->set_gravity(kGravity * Vec3(std::sin(angle), 0, -std::cos(angle)));
    world->set_ground(0, 0.6, 0);
    BodyDescription one = ball_body(0.5, 4000, {0, 0, 0.5});
    one.friction = 0.6;
    ball = world->add_body(one);
    run(*world, 300);
  }
  std::unique_ptr<World> world = make_small_steps_world();
  BodyId ball;
};

}  // namespace

TEST_CASE("a ball comes to rest on a gentle slope, held by its resistance to rolling, and rolls down a steep one") {
  BallOnSlope gentle(0.04);
  CHECK(gentle.world->state(gentle.ball).asleep);
  CHECK(gentle.world->state(gentle.ball).pose.position.x() < 0.01);
  BallOnSlope steep(0.2);
  CHECK_FALSE(steep.world->state(steep.ball).asleep);
  // 7/5 a = g (sin - 0.1 cos), for 5 s.
  const double way = kGravity * (0.2 - 0.1) / std::sqrt(1 + 0.2 * 0.2) / 1.4 * 5 * 5 / 2;
  CHECK(steep.world->state(steep.ball).pose.position.x() == Approx(way).epsilon(0.05));
}
