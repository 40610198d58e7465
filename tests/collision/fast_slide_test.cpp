// What contacts take from bodies that come in fast and flat, where the engine foresees contacts: the energy is all
// there.
#include <catch2/catch.hpp>
#include <cmath>

#include "world_builder.h"

using namespace collision_test;

namespace {

BodyDescription thrown(bool ball, double speed) {
  BodyDescription body = ball ? ball_body(0.3, 400, {0, 0, 1.1}) : box_body({0.4, 0.1, 0.3}, 400, {0, 0, 1.1});
  if (!ball) {
    ConvexPart& part = body.parts[0];
    part.kind = ConvexPart::Kind::hull;
    for (int i = 0; i < 5; ++i)
      for (const double side : {-0.1, 0.1})
        part.points.emplace_back(0.4 * std::cos(0.4 * M_PI * i), side, 0.3 * std::sin(0.4 * M_PI * i));
    body.pose.orientation = Eigen::AngleAxisd(0.4, Vec3(1, 1, 0).normalized());
  }
  body.velocity = Vec3(0.3, speed, -2);
  body.angular_velocity = Vec3(3, 1, -2);
  return body;
}

/// Speeds of the middle of the step.
double kinetic(const BodyDescription& body, const BodyState& state) {
  const Vec3 velocity = state.velocity - Vec3(0, 0, kGravity * kStep / 2);
  const Mat3 turn = state.pose.orientation.toRotationMatrix();
  const Vec3 spin = turn.transpose() * state.angular_velocity;
  return body.mass * velocity.squaredNorm() / 2 + spin.dot(body.inertia * spin) / 2;
}

}  // namespace

TEST_CASE("what contacts take from a body that comes in fast is all told, friction of foreseen contacts included") {
  for (const bool ball : {true, false})
    for (const double speed : {5.0, 15.0, 30.0}) {
      CAPTURE(ball, speed);
      const auto world = world_with_ground();
      const BodyDescription body = thrown(ball, speed);
      const BodyId id = world->add_body(body);
      const double first = kinetic(body, world->state(id));
      double expected = first;
      for (int step = 0; step < 100 && !world->state(id).asleep; ++step) {
        const double height = world->state(id).pose.position.z();
        world->step(kStep);
        const BodyState after = world->state(id);
        if (after.asleep) break;
        expected -= body.mass * kGravity * (after.pose.position.z() - height);
        for (const Contact& contact : world->contacts()) expected -= contact.work_lost;
        REQUIRE(std::abs(kinetic(body, after) - expected) < 1e-4 * first);  // the turning of a body is of second order
      }
      CHECK(expected < 0.9 * first);
    }
}
