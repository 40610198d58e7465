#pragma once
// A ball that meets an upright bar of what moves.
#include "frame_builder.h"
#include "topple/structure/scenario.h"

namespace topple::test {

/// Along x onto a bar of FrameBuilder's at the origin, 0.05 s after the start, at this height, without rebound.
[[nodiscard]] inline Scenario struck_post(double height, double speed, double body_mass, double step, double duration) {
  Scenario scenario;
  scenario.combination = CombinationId(0u);
  scenario.standing = StandingRule::dynamics;
  scenario.step = step;
  scenario.duration = duration;
  scenario.failure.bracing = BracingRule::none;
  scenario.impact.restitution = 0;
  Projectile ball;
  ball.radius = 0.25;
  const double flight = 0.05;  // s, in which it falls to that height
  ball.from = Vec3(-0.1 - ball.radius - flight * speed, 0, height + 10 * flight * flight / 2);
  ball.velocity = Vec3(speed, 0, 0);
  ball.mass = body_mass;
  scenario.events = {{0, ball}};
  return scenario;
}

}  // namespace topple::test
