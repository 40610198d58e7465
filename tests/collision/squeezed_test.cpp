// What is caught between heavy pieces that close and slide: their pushes on it are nearly opposite and large, and
// only their difference may move it.
#include <catch2/catch.hpp>
#include <random>
#include <vector>

#include "topple/collision/overlap_watch.h"
#include "world_builder.h"

using namespace collision_test;

namespace {

/// A steel beam of 6 m on the ground, and concrete slabs of 25 t that come down on it one after the other, turned at
/// random, aside as fast as down.
std::unique_ptr<World> beam_under_slabs(std::mt19937& random) {
  const auto between = [&](double low, double high) { return low + (high - low) * (random() % 10000) / 10000.0; };
  auto world = world_with_ground();
  BodyDescription beam = box_body({3, 0.08, 0.165}, 295, {0, 0, 0.2});
  beam.restitution = 0;
  beam.pose.orientation = Eigen::AngleAxisd(between(-1, 1), Vec3::UnitX());
  world->add_body(beam);
  for (int i = 0; i < 3; ++i) {
    const Vec3 half(3, 3, 0.1);
    BodyDescription slab = box_body(half, 25000, {between(-2, 2), between(-2, 2), 2.5 + 1.5 * i});
    slab.restitution = 0;
    slab.pose.orientation =
        Eigen::AngleAxisd(between(-0.4, 0.4), Vec3(between(-1, 1), between(-1, 1), 0.1).normalized());
    slab.velocity = Vec3(between(-10, 10), between(-10, 10), -between(5, 15));
    slab.angular_velocity = Vec3(between(-1, 1), between(-1, 1), between(-1, 1));
    world->add_body(slab);
  }
  return world;
}

}  // namespace

TEST_CASE("contacts make no energy of what is squeezed between heavy pieces that slide") {
  std::mt19937 random(7);
  double made = 0, lost = 0;
  for (int scene = 0; scene < 40; ++scene) {
    const auto world = beam_under_slabs(random);
    for (int step = 0; step < 60; ++step) {
      world->step(kStep);
      double work_lost = 0;
      for (const Contact& contact : world->contacts()) work_lost += contact.work_lost;
      (work_lost < 0 ? made : lost) += std::abs(work_lost);
    }
  }
  // Arms of impulses stay through a step, which makes 1.2e-4; with one pass over friction in a sub-step it is 6.3e-4.
  CHECK(made < 2.5e-4 * lost);
}

TEST_CASE("what is squeezed between heavy pieces is pushed out of them, and does not come to lie in them") {
  std::mt19937 random(7);
  double deepest = 0;
  int deep = 0;
  for (int scene = 0; scene < 40; ++scene) {
    const auto world = beam_under_slabs(random);
    OverlapWatch watch;
    std::vector<Contact> of_beam;  // slabs may begin inside each other
    for (int step = 0; step < 240; ++step) {
      world->step(kStep);
      of_beam.clear();
      for (const Contact& contact : world->contacts())
        if (contact.body.value == 0) of_beam.push_back(contact);
      watch.read(of_beam, kStep);
    }
    const double depth = watch.deepest() ? watch.deepest()->depth : 0;
    deepest = std::max(deepest, depth);
    if (depth > 0.008) ++deep;
  }
  // For a quarter of a second where slabs of 85 times its mass close on it with up to 15 m/s; 14 mm with two passes
  // over what pushes it out. Of 200 scenes 95 % come to less than 5.3 mm, and one to 9.3.
  CHECK(deepest < 0.012);
  CHECK(deep <= 1);
}
