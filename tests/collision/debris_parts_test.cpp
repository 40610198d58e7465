// Parts of the world of debris, each alone: on boxes in a scene that no step is taken in.
#include <catch2/catch.hpp>

#include "debris/body_motion.h"
#include "debris/body_sweep.h"
#include "debris/waking.h"
#include "shapes/polyhedron_store.h"

using namespace topple::collision;

namespace {

/// Boxes of 1 m and 1 kg.
struct Boxes {
  DebrisScene scene{solver_settings};
  PolyhedronStore polyhedra;
  IgnoredPairs ignored{scene};
  ParallelRegion region;
  PairSearch search{scene, ignored, region};

  DebrisBody& add(const Vec3& at, const Vec3& velocity = Vec3::Zero()) {
    ConvexPart part;
    part.kind = ConvexPart::Kind::box;
    part.half_extents = Vec3::Constant(0.5);
    auto made = std::make_unique<DebrisBody>();
    made->kind = Touched::Kind::body;
    made->id = std::ssize(scene.bodies);
    make_parts({part}, "body", polyhedra, *made);
    make_shapes(*made);
    made->mass = 1;
    made->moments = Vec3::Constant(1.0 / 6);
    made->at.position = at;
    made->velocity = velocity;
    made->colliders = {scene.pairs.add(made.get(), 0, static_cast<std::uint64_t>(made->id),
                                       DebrisScene::bounds_of(made->shapes[0], made->at))};
    scene.bodies.push_back(std::move(made));
    scene.order.push_back({scene.bodies.back()->id});
    ++scene.awake_count;
    return *scene.bodies.back();
  }
  std::size_t find(double dt) {
    search.update_bounds(dt);
    scene.pairs.find();
    search.note_ways(dt);
    search.seek_contacts(dt);
    search.find_touching();
    return scene.touching.size();
  }
};

Touched body_touched(std::int64_t id) {
  Touched other;
  other.kind = Touched::Kind::body;
  other.body.value = id;
  return other;
}

}  // namespace

TEST_CASE("debris: two that may meet within the step are contacts before they touch") {
  Boxes boxes;
  boxes.add({0, 0, 0});
  boxes.add({1.3, 0, 0}, {-4, 0, 0});
  CHECK(boxes.find(0.05) == 0);
  CHECK(boxes.find(0.1) == 1);
}

TEST_CASE("debris: two that are to be ignored are no contact, nor swept for, until they have come apart") {
  Boxes boxes;
  boxes.add({0, 0, 0});
  DebrisBody& other = boxes.add({0.9, 0, 0});
  boxes.ignored.add({0}, body_touched(1));
  CHECK(boxes.find(0.01) == 0);
  CHECK(first_touches(boxes.scene, boxes.ignored, 0.01, {}).empty());
  boxes.ignored.release(0.01, false);
  CHECK(boxes.ignored.any());
  other.at.position.x() = 1.1;
  boxes.ignored.begin_step(0.01);
  CHECK_FALSE(boxes.ignored.any());
  // Told again at once, they are ignored in the next step though they are apart.
  boxes.ignored.add({0}, body_touched(1));
  boxes.ignored.begin_step(0.01);
  CHECK(boxes.ignored.any());
  boxes.ignored.begin_step(0.01);
  CHECK_FALSE(boxes.ignored.any());
}

TEST_CASE("debris: a first touch comes at gap over speed") {
  Boxes boxes;
  boxes.add({0, 0, 0});
  boxes.add({3, 0.1, 0}, {-10, 0, 0});
  const std::vector<Contact> found = first_touches(boxes.scene, boxes.ignored, 0.25, {});
  REQUIRE(found.size() == 1);
  CHECK(found[0].body.value == 0);
  // By the search's skin earlier than the 2 m between them take.
  CHECK(found[0].time == Approx(0.2).margin(0.001));
  CHECK(found[0].approach_speed == Approx(10));
  CHECK(found[0].normal.isApprox(Vec3(1, 0, 0), 1e-9));
}

TEST_CASE("debris: who is struck while it sleeps wakes, and as many behind it as the impact moves noticeably") {
  for (const double speed : {0.15, 0.5, 5.0}) {
    Boxes boxes;
    for (int i = 0; i < 10; ++i) boxes.add({1.0 * i, 0, 0});
    REQUIRE(boxes.find(0.01) == 9);
    for (int i = 0; i < 10; ++i) boxes.scene.fall_asleep(boxes.scene.body(i));
    boxes.add({-1.0005, 0, 0}, {speed, 0, 0});
    Waking waking(boxes.scene, boxes.search);
    boxes.find(0.01);
    waking.wake_struck(0.01);
    std::size_t woken = 0;
    for (int i = 0; i < 10; ++i) woken += boxes.scene.body(i).asleep ? 0 : 1;
    // Each of 1 kg: so many move at 0.1 m/s or more.
    CHECK(woken == std::min<std::size_t>(10, static_cast<std::size_t>(std::ceil(speed / 0.1 - 1e-9))));
  }
}

TEST_CASE("debris: what is woken within the step in which it fell asleep goes on as it was") {
  Boxes boxes;
  DebrisBody& one = boxes.add({0, 0, 0}, {0.01, 0.02, 0.07});
  one.spin = {0.001, 0, 0.002};
  boxes.scene.fall_asleep(one);
  one.velocity.setZero();
  one.spin.setZero();
  boxes.scene.reading = {0, 0, -0.04};
  boxes.scene.wake_up(one);
  CHECK(one.velocity == Vec3(0.01, 0.02, 0.07 - 0.04));
  CHECK(one.spin == Vec3(0.001, 0, 0.002));
}

TEST_CASE("debris: what flies falls by the parabola exactly, and tells by what its energy is off") {
  Boxes boxes;
  DebrisBody& one = boxes.add({0, 0, 0});
  one.moments = {0.1, 0.2, 0.3};
  one.inverse_root_moments = one.moments.cwiseSqrt().cwiseInverse();
  one.spin = {1, 2, 3};
  const Vec3 gravity(0, 0, -10);
  const double dt = 0.01;
  one.velocity = Vec3(3, 0, 4) - gravity * (dt / 2);  // of mid-step, before the first
  const double before = energy(one, gravity, dt);
  double swung = 0;
  for (int i = 0; i < 100; ++i) {
    fly(one, gravity, dt);
    swung += one.swung;
  }
  CHECK((one.at.position - Vec3(3, 0, 4 - 5)).norm() < 1e-12);
  // Free rotation misses its energy by little, and tells by how much.
  CHECK(std::abs(swung) < 1e-6);
  CHECK(energy(one, gravity, dt) - before == Approx(swung).margin(1e-12));
}

TEST_CASE("debris: a copy of a scene has bodies and pairs of its own") {
  Boxes boxes;
  boxes.add({0, 0, 0});
  boxes.add({0.99, 0, 0});
  REQUIRE(boxes.find(0.01) == 1);
  DebrisScene copy(boxes.scene);
  copy.body(0).at.position.z() = 5;
  CHECK(boxes.scene.body(0).at.position.z() == 0);
  REQUIRE(copy.pairs.order().size() == 1);
  const NearPair& pair = copy.pairs.pair(copy.pairs.order().front());
  CHECK(copy.pairs.collider(pair.first).solid == &copy.body(0));
  CHECK_THROWS_AS(copy.body(2), std::out_of_range);
}
