// A semicircular arch of voussoirs stands from the thickness on at which a line of thrust lies within it: Milankovitch
// 1907, 0.1075 of the radius for joints everywhere; with joints between voussoirs alone, by statics of the blocks.
#include <catch2/catch.hpp>
#include <cmath>

#include "topple/collision/small_steps.h"
#include "world_builder.h"

using namespace collision_test;

namespace {

using Vec2 = Eigen::Vector2d;

/// Corners of voussoir i of `count` from the right springing: the blocks meet on radii, with straight faces between.
std::vector<Vec2> voussoir(int i, int count, double radius, double thickness) {
  const double from = M_PI * i / count, to = M_PI * (i + 1) / count;
  const double inner = radius - thickness / 2, outer = radius + thickness / 2;
  const auto at = [](double distance, double angle) {
    return Vec2(distance * std::cos(angle), distance * std::sin(angle));
  };
  return {at(inner, from), at(outer, from), at(outer, to), at(inner, to)};
}

/// Whether a thrust at the crown, H at a height z0, keeps the moment about the inner end of each joint of half the arch
/// on one side and about the outer end on the other: linear in (H, H z0), so that a corner of the allowed set is where
/// two of them are at their limits. `count` even: the crown is a joint.
bool thrust_line_fits(int count, double ratio) {
  const double radius = 1;
  struct Bound {  // a H + b (H z0) <= c
    double a, b, c;
  };
  std::vector<Bound> bounds;
  double weight = 0, about = 0;
  for (int joint = count / 2; joint >= 0; --joint) {
    const double angle = M_PI * joint / count;
    for (const double side : {-1.0, 1.0}) {
      const double distance = radius + side * ratio / 2;
      const Vec2 end(distance * std::cos(angle), distance * std::sin(angle));
      // About the inner end: H (z0 - z) + W (x_w - x) >= 0; about the outer one: at most 0.
      bounds.push_back({side * -end.y(), side, side * (weight * end.x() - about)});
    }
    if (joint == 0) break;
    const BodyDescription block = extruded(voussoir(joint - 1, count, radius, ratio), 1, 1, 0);
    const double larger = radius + ratio / 2, smaller = radius - ratio / 2;
    const double area = std::sin(M_PI / count) * (larger * larger - smaller * smaller) / 2;
    weight += area;
    about += area * block.pose.position.x();
  }
  for (std::size_t i = 0; i < bounds.size(); ++i)
    for (std::size_t j = i + 1; j < bounds.size(); ++j) {
      const Bound &one = bounds[i], &other = bounds[j];
      const double determinant = one.a * other.b - other.a * one.b;
      if (std::abs(determinant) < 1e-12) continue;
      const double h = (one.c * other.b - other.c * one.b) / determinant,
                   hz = (one.a * other.c - other.a * one.c) / determinant;
      bool all = true;
      for (const Bound& bound : bounds) all = all && bound.a * h + bound.b * hz <= bound.c + 1e-9;
      if (all) return true;
    }
  return false;
}

double least_thickness(int count) {
  double low = 0.01, high = 0.3;
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    (thrust_line_fits(count, middle) ? high : low) = middle;
  }
  return high;
}

/// Whether its crown is where it was after ten seconds. Its weight comes on over two seconds, so that the forces
/// between the blocks follow: put there at once it falls a little before they do, and that is an impact.
bool arch_stands(int count, double ratio) {
  const auto world = make_small_steps_world();
  const double radius = 5, thickness = ratio * radius, wide = 1, friction = 0.8;
  world->set_ground(0, friction, 0);
  BodyId crown;
  for (int i = 0; i < count; ++i) {
    const double mass = 2500 * wide * thickness * radius * M_PI / count;
    const BodyId id = world->add_body(extruded(voussoir(i, count, radius, thickness), wide, mass, friction));
    if (i == count / 2) crown = id;
  }
  const double before = world->state(crown).pose.position.z();
  for (int i = 1; i <= 120; ++i) {
    world->set_gravity({0, 0, -kGravity * i / 120});
    world->step(kStep);
  }
  run(*world, 480);
  return std::abs(world->state(crown).pose.position.z() - before) < 0.01;  // what settles: 2 to 5 mm
}

}  // namespace

TEST_CASE("the thickness that statics of voussoirs asks for comes to the published one as they grow many") {
  CHECK(least_thickness(120) == Approx(0.1075).epsilon(0.005));
}

TEST_CASE("an arch of voussoirs stands two per cent above the thickness that statics asks for, and falls below") {
  for (const int count : {16, 24}) {
    CAPTURE(count);
    const double least = least_thickness(count);
    CHECK(arch_stands(count, 1.02 * least));
    CHECK_FALSE(arch_stands(count, 0.98 * least));
  }
}
