// What swings on an edge: contacts give it nothing, and rolling friction takes what it should.
#include <catch2/catch.hpp>
#include <cmath>

#include "solver/solver_settings.h"
#include "topple/collision/small_steps.h"
#include "world_builder.h"

using namespace collision_test;

namespace {

constexpr double kMass = 1000, kInertia = 150, kBelow = 0.4;

/// A plate on a ridge along y, with weights that hang from it at both sides: its middle is `kBelow` under the ridge.
struct Pendulum {
  explicit Pendulum(double spin) {
    world->set_gravity({0, 0, -kGravity});
    ObstacleDescription ridge = box_obstacle({0.1, 2, 0.1}, {0, 0, -0.1 * std::sqrt(2.0)});
    ridge.pose.orientation = Eigen::AngleAxisd(M_PI / 4, Vec3::UnitY());
    world->add_obstacle(ridge);
    BodyDescription hung = box_body({0.5, 0.5, 0.05}, kMass, {0, 0, -kBelow});
    hung.parts = {box_part({0.5, 0.5, 0.05}, 0, {0, 0, kBelow + 0.05}), box_part({0.1, 0.5, 0.2}, 1, {-0.5, 0, -0.1}),
                  box_part({0.1, 0.5, 0.2}, 2, {0.5, 0, -0.1})};
    hung.inertia = Vec3(200, kInertia, 200).asDiagonal();
    hung.friction = 2;
    hung.angular_velocity = {0, spin, 0};
    hung.velocity = {-spin * kBelow, 0, 0};
    body = world->add_body(hung);
  }
  [[nodiscard]] double tilt() const {
    const Vec3 up = world->state(body).pose.orientation * Vec3::UnitZ();
    return std::atan2(up.x(), up.z());
  }
  std::unique_ptr<World> world = make_small_steps_world();
  BodyId body;
};

}  // namespace

TEST_CASE("what swings on an edge loses by each swing what rolling friction takes, at every length of step") {
  const double step = GENERATE(1.0 / 30, 1.0 / 60, 1.0 / 120);
  const double rate = std::sqrt(kMass * kGravity * kBelow / (kInertia + kMass * kBelow * kBelow));
  Pendulum hung(0.25 * rate);
  std::vector<double> turns;  // tilt where it turns back
  double before = 0, last = 0;
  for (double time = 0; time < 10; time += step) {
    hung.world->step(step);
    const double now = hung.tilt();
    if ((last - before) * (now - last) < 0) turns.push_back(std::abs(last));
    before = last;
    last = now;
  }
  REQUIRE(turns.size() >= 8);
  // The normal force, a lever ahead, works against it along the whole of its way: from one turn to the next its height
  // m g d a^2/2 loses m g lever 2 a.
  const double lost = 2 * rolling_lever(solver_settings) / kBelow;
  for (std::size_t i = 1; i < turns.size(); ++i) CHECK(turns[i] < turns[i - 1]);
  CHECK((turns.front() - turns.back()) / static_cast<double>(turns.size() - 1) == Approx(lost).epsilon(0.25));
}
