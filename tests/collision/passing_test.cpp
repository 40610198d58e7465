// What the sweep says of a step and what contacts do in it agree: nothing is pushed that is not touched.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <optional>
#include <random>

#include "random_chunk.h"
#include "topple/collision/small_steps.h"
#include "world_builder.h"

using namespace collision_test;

namespace {

struct Draw {
  std::mt19937 random;
  double between(double low, double high) { return low + (high - low) * (random() % 100003) / 100003.0; }
  Vec3 direction() {
    Vec3 made;
    do made = Vec3(between(-1, 1), between(-1, 1), between(-1, 1));
    while (made.norm() > 1 || made.norm() < 0.1);
    return made.normalized();
  }
};

BodyDescription flying(Draw& draw, int kind) {
  return kind == 0   ? ball_body(0.2, 200, Vec3::Zero())
         : kind == 1 ? box_body({1, 0.8, 0.1}, 4000, Vec3::Zero())
                     : chunk(draw.random, Vec3::Zero());
}

/// A post that turns slowly, and a ball, a slab or a chunk that flies close to it.
struct Encounter {
  Encounter(Draw& draw, int kind) : world(make_small_steps_world()) {
    world->set_gravity(Vec3::Zero());
    BodyDescription post = box_body({0.1, 0.1, 1.5}, 300, Vec3::Zero());
    post.angular_velocity = draw.between(0, 2) * draw.direction();
    one = world->add_body(post);
    BodyDescription flies = flying(draw, kind);
    const Vec3 along = draw.direction();
    flies.velocity = draw.between(4, 30) * along;
    flies.angular_velocity = draw.between(0, 4) * draw.direction();
    const Vec3 aside = along.cross(draw.direction());
    flies.pose.position = -4 * along + draw.between(0, 0.6) * aside.normalized();
    other = world->add_body(flies);
  }
  [[nodiscard]] Vec3 velocity() const { return world->state(other).velocity; }

  std::unique_ptr<World> world;
  BodyId one, other;
};

}  // namespace

TEST_CASE("what passes another within a step, or touches it only after, is not pushed in it, at any length of step") {
  Draw draw{std::mt19937(11)};
  int met = 0, passed = 0;
  for (int number = 0; number < 1200; ++number) {
    const double dt = std::array{1.0 / 30, 1.0 / 60, 1.0 / 240, 1.0 / 960}[static_cast<std::size_t>(number % 4)];
    Encounter encounter(draw, number / 4 % 3);
    bool touched = false;
    for (int i = 0; i < static_cast<int>(0.5 / dt) && !touched; ++i) {
      touched = !encounter.world->sweep(dt).empty();
      const Vec3 before = encounter.velocity();
      encounter.world->step(dt);
      INFO("encounter " << number << ", step " << i << " of " << dt << " s");
      if (!touched) CHECK((encounter.velocity() - before).norm() < 1e-12 * before.norm());
    }
    ++(touched ? met : passed);
  }
  CHECK(met > 300);
  CHECK(passed > 100);
}

namespace {

/// A post at rest, and what goes straight at it, slowly: so many seconds before they touch, or would if it passed
/// nearer.
struct SlowEncounter {
  SlowEncounter(const BodyDescription& flies, const Vec3& along, double speed) : body(flies), speed(speed) {
    body.velocity = speed * along;
  }
  [[nodiscard]] std::unique_ptr<World> world(const Vec3& at) const {
    auto made = make_small_steps_world();
    made->set_gravity(Vec3::Zero());
    (void)made->add_body(box_body({0.1, 0.1, 1.5}, 300, Vec3::Zero()));
    BodyDescription there = body;
    there.pose.position = at;
    (void)made->add_body(there);
    return made;
  }
  /// s; nothing where it passes.
  [[nodiscard]] std::optional<double> touches_after(const Vec3& from) const {
    const std::vector<Contact> met = world(from)->sweep(8 / speed);
    if (met.empty()) return std::nullopt;
    return met.front().time;
  }

  BodyDescription body;
  double speed;
};

}  // namespace

TEST_CASE("what comes slowly, or passes within a millimetre, is seen before it is pushed, at any length of step") {
  Draw draw{std::mt19937(12)};
  int met = 0, passed = 0;
  for (int number = 0; number < 360; ++number) {
    const double dt = std::array{1.0 / 60, 1.0 / 480, 1.0 / 1920, 1.0 / 7680}[static_cast<std::size_t>(number % 4)];
    const BodyDescription flies = flying(draw, number / 4 % 3);
    const Vec3 along = draw.direction(), aside = along.cross(draw.direction()).normalized();
    const SlowEncounter encounter(flies, along, draw.between(0.05, 1));
    // It touches as far aside as `near`, and passes at `far`.
    double near = 0, far = 4;
    const auto from = [&](double way) { return Vec3(-4 * along + way * aside); };
    double time = encounter.touches_after(from(near)).value();
    const bool passes = number % 2 == 0;
    if (passes)
      for (int i = 0; i < 14; ++i) {
        const double middle = (near + far) / 2;
        const std::optional<double> then = encounter.touches_after(from(middle));
        (then ? near : far) = middle;
        time = then.value_or(time);
      }
    const double before = 0.003;  // m
    const Vec3 begin = from(passes ? far : near) + (time * encounter.speed - before) * along;
    const auto world = encounter.world(begin);
    const BodyId other{1};
    bool touched = false;
    const int steps = static_cast<int>(std::ceil(3 * before / (encounter.speed * dt)));
    for (int i = 0; i < steps && !touched; ++i) {
      touched = !world->sweep(dt).empty();
      const Vec3 velocity = world->state(other).velocity;
      world->step(dt);
      INFO("encounter " << number << ", step " << i << " of " << dt << " s, at " << encounter.speed << " m/s");
      if (!touched) REQUIRE((world->state(other).velocity - velocity).norm() < 1e-12 * encounter.speed);
    }
    ++(touched ? met : passed);
  }
  CHECK(met > 150);
  CHECK(passed > 50);
}
