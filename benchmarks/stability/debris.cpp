#include "debris.h"

#include <cmath>

#include "topple/collision/world.h"

namespace topple::bench {

namespace {

using namespace collision;

constexpr double side = 1, gravity = 9.81, step = 1.0 / 60;

BodyDescription box(double mass, double height) {
  BodyDescription body;
  ConvexPart part;
  part.half_extents = Vec3::Constant(side / 2);
  part.tag = 0;
  body.parts = {part};
  body.mass = mass;
  body.inertia = Mat3::Identity() * (mass * side * side / 6);
  body.pose.position = Vec3(0, 0, height);
  return body;
}

DebrisVerdict pile(double ratio) {
  constexpr int settling = 120, averaged = 60;
  constexpr double light = 100;
  const auto world = make_bullet_world();
  world->set_gravity({0, 0, -gravity});
  world->set_ground(0, 0.6, 0);
  const BodyId lower = world->add_body(box(light, side / 2)), upper = world->add_body(box(light * ratio, 1.5 * side));
  double impulse = 0;
  for (int i = 0; i < settling + averaged; ++i) {
    world->wake(lower);
    world->wake(upper);
    world->step(step);
    if (i < settling) continue;
    for (const Contact& contact : world->contacts()) {
      if (contact.other.kind == Touched::Kind::ground) impulse -= contact.impulse.z();
    }
  }
  const double weight = light * (1 + ratio) * gravity;
  DebrisVerdict verdict{.mass_ratio = ratio};
  verdict.overlap = std::abs(1.5 * side - world->state(upper).pose.position.z()) / side;
  verdict.force_error = std::abs(impulse / (averaged * step) / weight - 1);
  return verdict;
}

}  // namespace

std::vector<DebrisVerdict> judge_debris() {
  std::vector<DebrisVerdict> verdicts;
  for (const double ratio : {1.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6}) verdicts.push_back(pile(ratio));
  return verdicts;
}

}  // namespace topple::bench
