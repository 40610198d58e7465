// How deep things are inside each other, and what of it lasts.
#include <algorithm>
#include <catch2/catch.hpp>

#include "topple/collision/overlap_watch.h"
#include "world_builder.h"

using namespace collision_test;

namespace {

Contact touch(std::int64_t body, double depth, double thickness = 0.2) {
  Contact contact;
  contact.body.value = body;
  contact.part_tag = 0;
  contact.depth = depth;
  contact.thickness = thickness;
  return contact;
}

}  // namespace

TEST_CASE("a contact tells how deep a box began the step in what it touches, and the thinner of the two") {
  const auto world = world_with_ground();
  world->add_obstacle(box_obstacle({2, 2, 0.05}, {0, 0, 1}));
  world->add_body(box_body({0.5, 0.4, 0.3}, 100, {0, 0, 1.32}));  // 0.03 m into the plate
  world->add_body(box_body({0.5, 0.4, 0.3}, 100, {9, 0, 0.28}));  // 0.02 m into the ground
  ConvexPart wedge;  // a prism on a triangle of height 0.5, which is its least width across a face
  wedge.kind = ConvexPart::Kind::hull;
  for (const double y : {-1.0, 1.0})
    for (const Vec3& corner : {Vec3(-0.6, y, 0), Vec3(0.6, y, 0), Vec3(0, y, 0.5)}) wedge.points.push_back(corner);
  BodyDescription prism = box_body({1, 1, 1}, 100, {20, 0, -0.04});
  prism.parts = {wedge};
  world->add_body(prism);
  world->add_body(ball_body(0.3, 100, {30, 0, 0.25}));
  world->step(kStep);
  const auto contacts = world->contacts();
  REQUIRE(contacts.size() == 4);
  // Exact geometry, but for the rounding of coordinates and skins of 2 mm.
  CHECK(contacts[0].depth == Approx(0.03).margin(1e-6));
  CHECK(contacts[0].thickness == Approx(0.1).epsilon(1e-12));
  CHECK(contacts[1].depth == Approx(0.02).margin(1e-6));
  CHECK(contacts[1].thickness == Approx(0.6).epsilon(1e-12));
  CHECK(contacts[2].depth == Approx(0.04).margin(0.0021));
  CHECK(contacts[2].thickness == Approx(0.5).epsilon(1e-6));
  CHECK(contacts[3].depth == Approx(0.05).margin(1e-6));
  CHECK(contacts[3].thickness == Approx(0.6).epsilon(1e-12));
}

TEST_CASE("an overlap counts by the least of it over a quarter of a second") {
  OverlapWatch watch;
  const double dt = 0.05;
  for (const double depth : {0.09, 0.08, 0.009, 0.08}) watch.read(std::vector{touch(1, depth, 0.6)}, dt);
  CHECK_FALSE(watch.deepest());
  watch.read(std::vector{touch(1, 0.09, 0.6)}, dt);
  REQUIRE(watch.deepest());
  CHECK(watch.deepest()->depth == 0.009);
  CHECK(watch.deepest()->body.value == 1);
  CHECK(watch.deep_count() == 0);  // 0.009 of 0.6 is less than 2 %
  for (int i = 0; i < 5; ++i) watch.read(std::vector{touch(1, 0.07, 0.6)}, dt);
  CHECK(watch.deepest()->depth == 0.07);
  CHECK(watch.deep_count() == 1);
  for (int i = 0; i < 10; ++i) watch.read(std::vector{touch(1, 0.06, 0.6)}, dt);
  CHECK(watch.deepest()->depth == 0.07);
  CHECK(watch.deep_count() == 1);  // the same pair, the same overlap
}

TEST_CASE("what is apart again within a quarter of a second is no overlap, and pairs are told apart") {
  OverlapWatch watch;
  for (int i = 0; i < 40; ++i) {
    std::vector<Contact> contacts;
    if (i % 4 != 3) contacts.push_back(touch(1, 0.5));
    contacts.push_back(touch(2, i % 4 == 3 ? 0.001 : 0.5));  // touching still, but no longer inside
    if (i >= 20) contacts.push_back(touch(3, 0.1));
    watch.read(contacts, 0.05);
  }
  REQUIRE(watch.deepest());
  CHECK(watch.deepest()->body.value == 3);
  CHECK(watch.deep_count() == 1);
}

TEST_CASE("boxes of like mass that rest on each other are not inside each other, nor is one that fell on them") {
  const auto world = world_with_ground();
  for (int level = 0; level < 4; ++level) world->add_body(box_body({0.5, 0.5, 0.25}, 600, {0, 0, 0.25 + 0.5 * level}));
  world->add_body(box_body({0.3, 0.3, 0.25}, 200, {0, 0, 4}));
  OverlapWatch watch;
  for (int i = 0; i < 240; ++i) {
    world->step(kStep);
    watch.read(world->contacts(), kStep);
  }
  CHECK(watch.deep_count() == 0);
}

TEST_CASE("a box with a thousand times its mass on it holds, and how deep the two are inside each other is told") {
  const auto world = world_with_ground();
  const BodyId light = world->add_body(box_body({0.5, 0.5, 0.5}, 100, {0, 0, 0.5}));
  const BodyId heavy = world->add_body(box_body({0.5, 0.5, 0.5}, 1e5, {0, 0, 1.5}));
  OverlapWatch watch;
  int told = 0;
  for (int i = 0; i < 300 && world->awake_count() > 0; ++i) {
    const auto height = [&](BodyId id) { return world->state(id).pose.position.z(); };
    const double inside = 1 - (height(heavy) - height(light));
    double deepest = 0;  // corner, when the step begins, as contacts tell it
    for (const double x : {-0.5, 0.5})
      for (const double y : {-0.5, 0.5}) {
        const BodyState &over = world->state(heavy), &under = world->state(light);
        const Vec3 corner = over.pose.position + over.pose.orientation * Vec3(x, y, -0.5) - under.pose.position;
        deepest = std::max(deepest, 0.5 - (under.pose.orientation.conjugate() * corner).z());
      }
    world->step(kStep);
    watch.read(world->contacts(), kStep);
    CHECK(inside < 0.017);
    for (const Contact& contact : world->contacts()) {
      if (contact.body != light || contact.other.body != heavy) continue;
      CHECK(contact.depth == Approx(deepest).margin(5e-4));
      CHECK(contact.thickness == Approx(1).epsilon(1e-12));
      ++told;
    }
  }
  REQUIRE(world->awake_count() == 0);
  CHECK(told > 20);
  CHECK(watch.deep_count() == 0);
}
