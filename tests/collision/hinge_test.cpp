// Joints between a body and what stands: the forces that they carry.
#include <catch2/catch.hpp>

#include "world_builder.h"

using namespace collision_test;

namespace {

HingeDescription joint_at(BodyId body, const Vec3& point, const std::array<bool, 6>& held) {
  HingeDescription hinge;
  hinge.body = body;
  hinge.point = point;
  hinge.held = held;
  return hinge;
}

}  // namespace

TEST_CASE("a body that hangs from a ball joint pulls with its weight") {
  const auto world = world_with_gravity();
  const BodyId body = world->add_body(box_body({0.2, 0.2, 1}, 350, {0, 0, 4}));
  const HingeId hinge = world->add_hinge(joint_at(body, {0, 0, 5}, {true, true, true, false, false, false}));
  run(*world, 60);
  const auto force = world->hinge_force(hinge);
  CHECK(force[2] == Approx(-350 * kGravity).epsilon(1e-3));
  CHECK(force.head<2>().norm() < 1e-6 * 350 * kGravity);
  CHECK(force.tail<3>().norm() < 1e-6 * 350 * kGravity);
  CHECK((world->state(body).pose.position - Vec3(0, 0, 4)).norm() < 0.02);
}

TEST_CASE("a cantilever held in all six components gives its weight and the moment of its arm") {
  const auto world = world_with_gravity();
  const double arm = 1.5, weight = 360 * kGravity;
  const BodyId body = world->add_body(box_body({arm, 0.1, 0.2}, 360, {arm, 0, 3}));
  HingeDescription joint = joint_at(body, {0, 0, 3}, {true, true, true, true, true, true});
  joint.axes = Eigen::AngleAxisd(0.4, Vec3(1, 2, 3).normalized()).toRotationMatrix().transpose();
  const HingeId hinge = world->add_hinge(joint);
  run(*world, 120);
  const auto force = world->hinge_force(hinge);
  const Vec3 expected_force = joint.axes * Vec3(0, 0, -weight);
  const Vec3 expected_moment = joint.axes * Vec3(0, weight * arm, 0);  // (arm, 0, 0) x (0, 0, -W)
  // The solver's iterations leave a joint that gives way a little: half a per cent.
  CHECK((force.head<3>() - expected_force).norm() < 0.005 * weight);
  CHECK((force.tail<3>() - expected_moment).norm() < 0.005 * weight * arm);
}

TEST_CASE("a hinge lets its free axis swing like a physical pendulum and holds the others, whichever it is") {
  for (int free_axis = 3; free_axis < 6; ++free_axis) {
    CAPTURE(free_axis);
    const auto world = world_with_gravity();
    const double half = 1;
    // A bar along x, hinged at its end about the global y axis, let go from the horizontal.
    BodyDescription bar = box_body({half, 0.05, 0.05}, 100, {half, 0, 0});
    const BodyId body = world->add_body(bar);
    std::array<bool, 6> held{true, true, true, true, true, true};
    held[static_cast<std::size_t>(free_axis)] = false;
    HingeDescription joint = joint_at(body, Vec3::Zero(), held);
    // Joint axes such that the free one is global y.
    joint.axes = free_axis == 3   ? (Mat3() << 0, 1, 0, 0, 0, 1, 1, 0, 0).finished()
                 : free_axis == 4 ? Mat3(Mat3::Identity())
                                  : (Mat3() << 0, 0, 1, 1, 0, 0, 0, 1, 0).finished();
    world->add_hinge(joint);
    double lowest = 0, fastest = 0;
    for (int step = 0; step < 120; ++step) {
      world->step(kStep);
      const BodyState state = world->state(body);
      lowest = std::min(lowest, state.pose.position.z());
      fastest = std::max(fastest, state.angular_velocity.norm());
      CHECK(std::abs(state.pose.position.y()) < 1e-3);
    }
    CHECK(lowest == Approx(-half).epsilon(0.02));
    // Energy: w^2 = 2 m g half / I about the end.
    const double inertia = 100 * (half * half + (half * half + 0.05 * 0.05) / 3);
    CHECK(fastest == Approx(std::sqrt(2 * 100 * kGravity * half / inertia)).epsilon(0.05));
  }
}

TEST_CASE("a hinge between two bodies passes on the weight of the lower one") {
  const auto world = world_with_gravity();
  const BodyId upper = world->add_body(box_body({0.2, 0.2, 1}, 300, {0, 0, 9}));
  const BodyId lower = world->add_body(box_body({0.2, 0.2, 1}, 200, {0, 0, 7}));
  const HingeId top = world->add_hinge(joint_at(upper, {0, 0, 10}, {true, true, true, false, false, false}));
  HingeDescription between = joint_at(lower, {0, 0, 8}, {true, true, true, false, true, true});
  between.other = upper;
  const HingeId middle = world->add_hinge(between);
  run(*world, 120);
  CHECK(world->hinge_force(top)[2] == Approx(-500 * kGravity).epsilon(0.005));
  CHECK(world->hinge_force(middle)[2] == Approx(-200 * kGravity).epsilon(0.005));
  world->remove_body(upper);  // its hinges go with it
  CHECK_THROWS_AS(world->hinge_force(middle), std::out_of_range);
  run(*world, 30);
  CHECK(world->state(lower).velocity.z() < -4);
}
