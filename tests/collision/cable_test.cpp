// A ball on a cable against the mathematical pendulum.
#include <catch2/catch.hpp>
#include <cmath>

#include "world_builder.h"

using namespace collision_test;

namespace {

constexpr double length = 20, mass = 3000;
const Vec3 anchor(1, 2, 30);

struct Pendulum {
  std::unique_ptr<World> world = world_with_gravity();
  BodyId ball;
  CableId cable;

  explicit Pendulum(double angle, double reach = length) {
    BodyDescription sphere;
    ConvexPart part;
    part.kind = ConvexPart::Kind::sphere;
    part.half_extents = Vec3::Constant(0.5);
    sphere.parts = {part};
    sphere.mass = mass;
    sphere.inertia = 0.4 * mass * 0.25 * Mat3::Identity();
    sphere.pose.position = anchor + reach * Vec3(std::sin(angle), 0, -std::cos(angle));
    sphere.velocity = -kGravity * kStep / 2 * Vec3(0, 0, -1);  // at rest now, read at mid-step
    ball = world->add_body(sphere);
    cable = world->add_cable({ball, anchor, length});
  }
  [[nodiscard]] Vec3 arm() const { return world->state(ball).pose.position - anchor; }
};

}  // namespace

TEST_CASE("a ball on a cable swings on its sphere with the speed that energy gives, at any step of a wide swing") {
  Pendulum one(1.2);
  const double top = one.arm().z();
  double lost = 0;
  for (int i = 0; i < 1200; ++i) {
    one.world->step(kStep);
    lost += one.world->cable_pull(one.cable).work_lost;
    CHECK(one.arm().norm() == Approx(length).epsilon(1e-12));
    CHECK(one.arm().z() < top + 1e-3);
  }
  // Two coarse steps' worth of error in twenty seconds: nothing adds up.
  CHECK(std::abs(lost) < 2e-3 * mass * kGravity * length * (1 - std::cos(1.2)));
}

TEST_CASE("the period of a small swing is that of the mathematical pendulum") {
  Pendulum one(0.05);
  double before = one.arm().x(), first = 0, last = 0;
  int passes = 0;
  for (int i = 1; i <= 4000; ++i) {
    one.world->step(kStep);
    const double now = one.arm().x();
    if (before > 0 && now <= 0) {
      const double time = (i - 1 + before / (before - now)) * kStep;
      if (passes++ == 0) first = time;
      last = time;
    }
    before = now;
  }
  REQUIRE(passes > 4);
  const double period = 2 * M_PI * std::sqrt(length / kGravity) * (1 + 0.05 * 0.05 / 16);
  CHECK((last - first) / (passes - 1) == Approx(period).epsilon(1e-4));  // h^2 w^2/24 is 6e-6; the rest is reading
}

TEST_CASE("a hanging ball pulls with its weight, and at the bottom of a swing with what turns it round") {
  Pendulum still(0);
  for (int i = 0; i < 30; ++i) still.world->step(kStep);
  CHECK(still.world->cable_pull(still.cable).tension == Approx(mass * kGravity).epsilon(1e-12));

  Pendulum swinging(M_PI / 2);
  double largest = 0;
  for (int i = 0; i < 240; ++i) {
    swinging.world->step(kStep);
    largest = std::max(largest, swinging.world->cable_pull(swinging.cable).tension);
  }
  CHECK(largest == Approx(3 * mass * kGravity).epsilon(1e-3));  // let go from the horizontal: 3 W
}

TEST_CASE("a slack cable does nothing until the ball has fallen its length, and then takes the fall out") {
  Pendulum one(0, length - 5);
  const double fall = std::sqrt(2 * 5 / kGravity);
  double pulled = 0, lost = 0;
  for (int i = 1; i <= 120; ++i) {
    one.world->step(kStep);
    const CablePull pull = one.world->cable_pull(one.cable);
    if (i * kStep < fall - kStep) CHECK(pull.tension == 0);
    pulled = std::max(pulled, pull.tension);
    lost += pull.work_lost;
  }
  CHECK(one.arm().norm() == Approx(length).epsilon(1e-12));
  CHECK(pulled > mass * std::sqrt(2 * kGravity * 5) / kStep * 0.45);  // all of its momentum in one step or two
  // Kinetic energy of the fall, but for the one step in which it comes taut somewhere inside.
  CHECK(lost == Approx(mass * kGravity * 5).epsilon(0.05));
}

TEST_CASE("a cable that does not reach its body is refused, and one goes with its body") {
  Pendulum one(0);
  CHECK_THROWS_AS(one.world->add_cable({one.ball, anchor, 0.9 * length}), std::invalid_argument);
  CHECK_THROWS_AS(one.world->add_cable({one.ball, anchor, 0}), std::invalid_argument);
  one.world->remove_body(one.ball);
  CHECK_THROWS_AS((void)one.world->cable_pull(one.cable), std::out_of_range);
}
