// What stands by friction and weight alone, against statics: a wedge, a house of cards, a pyramid.
#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "pressing.h"
#include "topple/collision/small_steps.h"
#include "world_builder.h"

using namespace collision_test;

namespace {

constexpr double kWide = 1;  // m along y

std::unique_ptr<World> ground_with_friction(double friction) {
  auto world = make_small_steps_world();
  world->set_gravity({0, 0, -kGravity});
  world->set_ground(0, friction, 0);
  return world;
}

/// The wedge has weight `share` of the block's, and is under it with its thick end at +x; the block is kept from going
/// along by a wall without friction. Whether the wedge is still where it was after ten seconds.
bool wedge_holds(double angle, double friction, double share) {
  const auto world = ground_with_friction(friction);
  const double length = 1, low = 0.1, high = low + length * std::tan(angle), top = high + 0.5, weight = 4000;
  const BodyDescription wedge =
      extruded({{0, 0}, {length, 0}, {length, high}, {0, low}}, kWide, share * weight, friction);
  const BodyDescription block = extruded({{0, low}, {length, high}, {length, top}, {0, top}}, kWide, weight, friction);
  ObstacleDescription wall = box_obstacle({0.2, 2, 2}, {-0.2, 0, low + 2.05});
  wall.friction = 0;
  world->add_obstacle(wall);
  const BodyId id = world->add_body(wedge);
  world->add_body(block);
  run(*world, 600);
  return (world->state(id).pose.position - wedge.pose.position).norm() < 0.01;
}

/// Two plates that lean against each other, with faces where they meet and stand. Upright half of the section, which
/// has its foot at -x and its top at x = 0.
std::vector<Eigen::Vector2d> card(double lean) {
  const double height = 3, thick = 0.1, foot = thick / std::cos(lean), face = thick / std::sin(lean);
  const double x = -height * std::tan(lean);
  return {{x, 0}, {x + foot, 0}, {0, height - face}, {0, height}};
}

/// Boxes of a pyramid down to `row` that have an end on the line between the places `left` and left + 1 (in half of the
/// spacing, from the middle): one of each row, at most.
int standing_on_line(int row, int left) {
  int count = 0;
  for (int above = 0; above <= row; ++above) {
    const int at = (left - above) % 2 == 0 ? left : left + 1;
    if (std::abs(at) <= above) ++count;
  }
  return count;
}

/// Whether both are still where they were after ten seconds.
bool cards_stand(double lean, double friction) {
  const auto world = ground_with_friction(friction);
  std::vector<Eigen::Vector2d> left = card(lean), right;
  for (auto corner = left.rbegin(); corner != left.rend(); ++corner) right.emplace_back(-corner->x(), corner->y());
  const BodyDescription plate = extruded(left, kWide, 600, friction);
  const BodyId id = world->add_body(plate);
  world->add_body(extruded(right, kWide, 600, friction));
  run(*world, 600);
  return (world->state(id).pose.position - plate.pose.position).norm() < 0.01;
}

}  // namespace

TEST_CASE("a wedge under a load holds one per cent inside the cones of its faces, and is squeezed out one outside") {
  for (const double friction : {0.2, 0.4})
    for (const double share : {0.05, 0.5}) {
      CAPTURE(friction, share);
      // W tan(angle - phi), what the block presses it out with, is friction (W + w) at the limit.
      const double limit = std::atan(friction) + std::atan(friction * (1 + share));
      CHECK(wedge_holds(0.99 * limit, friction, share));
      CHECK_FALSE(wedge_holds(1.01 * limit, friction, share));
    }
}

TEST_CASE("two cards that lean on each other stand one per cent inside the cones of their feet, and slide outside") {
  for (const double lean : {20 * M_PI / 180, 40 * M_PI / 180}) {
    CAPTURE(lean);
    // They slide about the inner edge of the foot and the upper one where they meet: W (x of the middle) = H z.
    const std::vector<Eigen::Vector2d> section = card(lean);
    const double middle = extruded(section, kWide, 600, 0).pose.position.x();
    const double needed = (middle - section[1].x()) / section[3].y();
    CHECK(cards_stand(lean, 1.01 * needed));
    CHECK_FALSE(cards_stand(lean, 0.99 * needed));
  }
}

TEST_CASE("boxes in a pyramid that bear on their ends press with half of the weight of all that stand on that line") {
  const auto world = ground_with_friction(0.01);
  // Friction can bear moments, of which statics does not say how much: half a per cent with this little.
  const int rows = 5;
  const double half = 0.5, overlap = 0.01, spacing = 4 * half - 2 * overlap, mass = 500, weight = mass * kGravity;
  std::map<std::int64_t, std::pair<int, int>> place;  // row from the top, number in it
  for (int row = 0; row < rows; ++row)
    for (int i = 0; i <= row; ++i) {
      const double x = spacing * (i - 0.5 * row), z = 0.25 + 0.5 * (rows - 1 - row);
      BodyDescription box = box_body({half, 0.5, 0.25}, mass, {x, 0, z});
      box.friction = 0.01;
      place[world->add_body(box).value] = {row, i};
    }
  Pressing pressing;
  for (int i = 0; i < 240; ++i) {
    world->step(kStep);
    pressing.read(*world);
  }
  REQUIRE(world->awake_count() == 0);
  int seen = 0;
  for (const auto& [key, contact] : pressing.all()) {
    const auto [row, number] = place.at(key.first);
    const double pressed = -contact.impulse.z() / kStep;
    ++seen;
    const int middle = 2 * number - row;
    if (contact.other.kind == Touched::Kind::ground) {
      const int on_lines = standing_on_line(row, middle - 1) + standing_on_line(row, middle);
      CHECK(pressed == Approx(on_lines * weight / 2).epsilon(0.02));
      continue;
    }
    const auto [below, under] = place.at(key.second);
    REQUIRE(below == row + 1);
    const int on_line = standing_on_line(row, middle - (under == number ? 1 : 0));
    CAPTURE(row, number, under);
    CHECK(pressed == Approx(on_line * weight / 2).epsilon(0.02));  // and each end is 10 mm of 1 m long
  }
  CHECK(seen == rows * rows);
  CHECK(-pressing.on_standing().z() == Approx(rows * (rows + 1) / 2 * weight).epsilon(1e-5));
}

TEST_CASE("a pyramid of boxes rests with forces that balance each box and are alike on both sides") {
  const auto world = ground_with_friction(0.6);
  const int rows = 6;
  const double mass = 500, weight = mass * kGravity;
  for (int row = 0; row < rows; ++row)
    for (int i = 0; i <= row; ++i)
      world->add_body(box_body({0.5, 0.5, 0.25}, mass, {1.02 * (i - 0.5 * row), 0, 0.25 + 0.5 * (rows - 1 - row)}));
  Pressing pressing;
  for (int i = 0; i < 240; ++i) {
    world->step(kStep);
    pressing.read(*world);
  }
  REQUIRE(world->awake_count() == 0);
  for (const BodyId id : world->bodies()) {
    CAPTURE(id.value);
    CHECK((pressing.on_body(id.value) - Vec3(0, 0, weight)).norm() < 1e-5 * weight);
    CHECK(pressing.moment_on_body(id.value, world->state(id).pose.position).norm() < 1e-5 * weight);
  }
  for (const auto& [key, contact] : pressing.all()) {
    const double pressed = contact.impulse.dot(contact.normal);
    CHECK(pressed >= 0);
    CHECK((contact.impulse - pressed * contact.normal).norm() <= 0.6 * pressed * (1 + 1e-9));
  }
  CHECK(-pressing.on_standing().z() == Approx(rows * (rows + 1) / 2 * weight).epsilon(1e-5));
}
