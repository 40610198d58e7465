// What the sweep says of a step and what contacts do in it agree: nothing is pushed that is not touched.
#include <catch2/catch.hpp>
#include <cmath>
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

/// A post that turns slowly, and a ball, a slab or a chunk that flies close to it.
struct Encounter {
  Encounter(Draw& draw, int kind) : world(make_small_steps_world()) {
    world->set_gravity(Vec3::Zero());
    BodyDescription post = box_body({0.1, 0.1, 1.5}, 300, Vec3::Zero());
    post.angular_velocity = draw.between(0, 2) * draw.direction();
    one = world->add_body(post);
    BodyDescription flies = kind == 0   ? ball_body(0.2, 200, Vec3::Zero())
                            : kind == 1 ? box_body({1, 0.8, 0.1}, 4000, Vec3::Zero())
                                        : chunk(draw.random, Vec3::Zero());
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
