// A slab that lands on one corner: the impulse that stops the corner, with friction, is known, whatever the step.
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "world_builder.h"

using namespace collision_test;

namespace {

constexpr double kMass = 17000, kSpeed = 6.5;
const Vec3 kHalf(2.5, 2.5, 0.1);

Mat3 cross_with(const Vec3& r) {
  Mat3 matrix;
  matrix << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
  return matrix;
}

BodyDescription tilted_slab(double by_x, double by_y) {
  BodyDescription slab = box_body(kHalf, kMass, Vec3::Zero());
  slab.pose.orientation = Eigen::AngleAxisd(by_x, Vec3::UnitX()) * Eigen::AngleAxisd(by_y, Vec3::UnitY());
  slab.velocity = Vec3(0, 0, -kSpeed);
  slab.friction = 3;  // it sticks
  return slab;
}

Vec3 lowest_corner(const BodyDescription& slab) {
  Vec3 lowest(0, 0, std::numeric_limits<double>::infinity());
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner(i & 1 ? kHalf.x() : -kHalf.x(), i & 2 ? kHalf.y() : -kHalf.y(), i & 4 ? kHalf.z() : -kHalf.z());
    const Vec3 turned = slab.pose.orientation * corner;
    if (turned.z() < lowest.z()) lowest = turned;
  }
  return lowest;
}

/// Of the slab, once it has been stopped at the corner r from its centre: J = -(1/m - [r] I^-1 [r])^-1 v.
Vec3 velocity_after(const BodyDescription& slab, const Vec3& r, double speed) {
  const Mat3 turn = slab.pose.orientation.toRotationMatrix(),
             inverse = turn * slab.inertia.inverse() * turn.transpose();
  const Mat3 mobility = Mat3::Identity() / slab.mass - cross_with(r) * inverse * cross_with(r);
  const Vec3 velocity(0, 0, -speed);
  return velocity - mobility.inverse() * velocity / slab.mass;
}

}  // namespace

TEST_CASE("a slab that lands on a corner is thrown aside by friction alike, however long the step and its sub-steps") {
  for (const auto& [by_x, by_y] : {std::pair(0.12, 0.05), std::pair(-0.08, 0.1), std::pair(0.03, -0.14)})
    for (const double rate : {60.0, 480.0, 1920.0, 2880.0, 3840.0, 7680.0}) {
      BodyDescription slab = tilted_slab(by_x, by_y);
      const Vec3 corner = lowest_corner(slab);
      slab.pose.position.z() = 0.05 - corner.z();
      const auto world = world_with_ground(3);
      const BodyId id = world->add_body(slab);
      while (world->contacts().empty() || world->contacts().front().impulse.isZero(0)) world->step(1 / rate);
      const double fallen = std::sqrt(kSpeed * kSpeed + 2 * kGravity * 0.05);
      const Vec3 after = world->state(id).velocity, known = velocity_after(slab, corner, fallen);
      INFO(rate << " steps a second, tilted by " << by_x << ", " << by_y << ": " << after.transpose() << ", known "
                << known.transpose());
      CHECK(known.head<2>().norm() > 0.3);
      // Where the corner comes down in the last sub-step of a step, normal and friction are one pass after the other.
      CHECK((after - known).head<2>().norm() < 0.1 * known.head<2>().norm());
    }
}
