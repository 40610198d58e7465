#include "debris.h"

#include <cmath>

#include "topple/collision/overlap_watch.h"
#include "topple/collision/sequential_impulse.h"

namespace topple::bench {

namespace {

using namespace collision;

constexpr double gravity = 9.81, step = 1.0 / 60;

BodyDescription box(double side, double mass, double height) {
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

DebrisVerdict pile(double side, double ratio) {
  constexpr int settling = 540, averaged = 60;
  constexpr double light = 100;
  const auto world = make_sequential_impulse_world();  // what simulations run on
  world->set_gravity({0, 0, -gravity});
  world->set_ground(0, 0.6, 0);
  const BodyId lower = world->add_body(box(side, light, side / 2)),
               upper = world->add_body(box(side, light * ratio, 1.5 * side));
  OverlapWatch watch;
  double impulse = 0;
  for (int i = 0; i < settling + averaged; ++i) {
    world->wake(lower);
    world->wake(upper);
    world->step(step);
    watch.read(world->contacts(), step);
    if (i < settling) continue;
    for (const Contact& contact : world->contacts()) {
      if (contact.other.kind == Touched::Kind::ground) impulse -= contact.impulse.z();
    }
  }
  const double weight = light * (1 + ratio) * gravity;
  DebrisVerdict verdict{.side = side, .mass_ratio = ratio};
  verdict.error = std::abs(1.5 * side - world->state(upper).pose.position.z()) / side;
  // It stands on two places, and none that is told is deeper than this.
  verdict.bound = 2 * (watch.deepest() ? watch.deepest()->depth : OverlapWatch::tolerance) / side;
  verdict.warned = watch.deep_count() > 0;
  verdict.force_error = std::abs(impulse / (averaged * step) / weight - 1);
  return verdict;
}

}  // namespace

std::vector<DebrisVerdict> judge_debris() {
  std::vector<DebrisVerdict> verdicts;
  for (const double side : {1.0, 0.3})
    for (const double ratio : {1.0, 3.0, 10.0, 30.0, 50.0, 1e2, 3e2, 1e3, 1e4, 1e5, 1e6})
      verdicts.push_back(pile(side, ratio));
  return verdicts;
}

}  // namespace topple::bench
