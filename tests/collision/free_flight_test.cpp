// Bodies that touch nothing: the parabola, and what a spinning body keeps.
#include <catch2/catch.hpp>

#include "world_builder.h"

using namespace collision_test;

namespace {

/// Angular momentum and energy of rotation in global axes, by the description's inertia.
Vec3 angular_momentum(const BodyState& state, const Mat3& inertia) {
  const Mat3 axes = state.pose.orientation.toRotationMatrix();
  return axes * inertia * axes.transpose() * state.angular_velocity;
}

}  // namespace

TEST_CASE("a body that enters with the velocity of mid-step flies on the exact parabola") {
  const auto world = world_with_gravity();
  const Vec3 start(1, 2, 30), velocity(7, -3, 5);
  const BodyId ball = world->add_body(ball_body(0.4, 500, start));
  BodyState state = world->state(ball);
  state.velocity = entering(velocity);
  world->set_state(ball, state);
  for (int step = 1; step <= 120; ++step) {
    world->step(kStep);
    const double t = step * kStep;
    const Vec3 exact = start + velocity * t + Vec3(0, 0, -kGravity) * (t * t / 2);
    // Rounding of 120 sums of numbers near 30.
    CHECK((world->state(ball).pose.position - exact).norm() < 1e-11);
  }
}

TEST_CASE(
    "a free spinning body with three different moments keeps its angular momentum to rounding and its energy nearly") {
  const auto world = make_bullet_world();
  BodyDescription body = box_body({1.5, 0.4, 0.1}, 200, Vec3::Zero());
  body.angular_velocity = Vec3(0.3, 6, 0.2);  // near the middle axis: it tumbles
  body.velocity = Vec3(1, 2, 3);
  const BodyId id = world->add_body(body);
  const Vec3 start = angular_momentum(world->state(id), body.inertia);
  const double energy = start.dot(world->state(id).angular_velocity) / 2;
  double most_turned = 0;
  for (int step = 0; step < 600; ++step) {
    world->step(kStep);
    const BodyState now = world->state(id);
    const Vec3 momentum = angular_momentum(now, body.inertia);
    CHECK((momentum - start).norm() < 1e-11 * start.norm());
    // The split is of second order in the largest turn of a part, 0.05 rad: 0.25 % of what is exchanged; it swings.
    CHECK(momentum.dot(now.angular_velocity) / 2 == Approx(energy).epsilon(5e-3));
    most_turned = std::max(most_turned, std::abs(now.angular_velocity.x()));
    CHECK((now.velocity - body.velocity).norm() == 0);
  }
  CHECK(most_turned > 2);  // it did tumble
}

TEST_CASE("a slender bar that tumbles fast gains no spin about its own axis") {
  // 6 m long and 0.1 m thick: its moments differ by a factor of 1800, so that an error of 1/40 in the direction of its
  // axis would be as much energy again.
  const auto world = make_bullet_world();
  BodyDescription bar = box_body({3, 0.05, 0.05}, 295, Vec3::Zero());
  bar.angular_velocity = Vec3(2, 9, 4);
  const BodyId id = world->add_body(bar);
  const Vec3 start = angular_momentum(world->state(id), bar.inertia);
  const double energy = start.dot(world->state(id).angular_velocity) / 2;
  for (int step = 0; step < 3600; ++step) world->step(kStep);
  const BodyState now = world->state(id);
  const Vec3 momentum = angular_momentum(now, bar.inertia);
  CHECK((momentum - start).norm() < 1e-10 * start.norm());  // rounding of 3600 steps
  CHECK(momentum.dot(now.angular_velocity) / 2 == Approx(energy).epsilon(5e-3));
  const double along = (now.pose.orientation.inverse() * now.angular_velocity).x();
  CHECK(std::abs(along) == Approx(2).epsilon(0.05));  // of a body with two equal moments it stays
}

TEST_CASE("a body whose inertia is not diagonal comes back in the frame it was given in") {
  const auto world = make_bullet_world();
  const Eigen::Quaterniond skew = Eigen::Quaterniond(0.8, 0.3, -0.4, 0.5).normalized();
  const Vec3 half(1.5, 0.4, 0.1);
  BodyDescription body = box_body(half, 200, {3, 4, 5});
  const Mat3 turn = skew.toRotationMatrix();
  body.inertia = turn * body.inertia * turn.transpose();
  body.inertia = (body.inertia + body.inertia.transpose().eval()) / 2;
  body.parts[0].pose.orientation = skew;
  body.pose.orientation = Eigen::Quaterniond(0.1, 0.9, 0.2, -0.3).normalized();
  body.angular_velocity = Vec3(1, -2, 0.5);
  const BodyId id = world->add_body(body);
  CHECK(world->state(id).pose.orientation.angularDistance(body.pose.orientation) < 1e-12);

  // The same box given in its principal axes moves in the same way.
  const auto reference_world = make_bullet_world();
  BodyDescription reference = box_body(half, 200, {3, 4, 5});
  reference.pose.orientation = body.pose.orientation * skew;
  reference.angular_velocity = body.angular_velocity;
  const BodyId same = reference_world->add_body(reference);
  run(*world, 60);
  run(*reference_world, 60);
  const Eigen::Quaterniond expected = reference_world->state(same).pose.orientation * skew.conjugate();
  CHECK(world->state(id).pose.orientation.angularDistance(expected) < 1e-9);
  CHECK((world->state(id).angular_velocity - reference_world->state(same).angular_velocity).norm() < 1e-9);
}

TEST_CASE("an impulse changes linear and angular momentum by what it is") {
  const auto world = make_bullet_world();
  const BodyDescription body = box_body({1, 0.5, 0.25}, 100, {0, 0, 10});
  const BodyId id = world->add_body(body);
  const Vec3 impulse(20, -30, 40), point(1, 0.5, 10.25);
  world->apply_impulse(id, impulse, point);
  const BodyState state = world->state(id);
  CHECK((100 * state.velocity - impulse).norm() < 1e-12);
  CHECK((angular_momentum(state, body.inertia) - (point - body.pose.position).cross(impulse)).norm() < 1e-12);
}
