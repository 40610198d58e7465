// Swept detection: what a body will touch before it gets there.
#include <catch2/catch.hpp>

#include <algorithm>

#include "world_builder.h"

using namespace collision_test;

namespace {

BodyId throw_body(World& world, BodyDescription body, const Vec3& velocity) {
  body.velocity = entering(velocity);
  return world.add_body(body);
}

}  // namespace

TEST_CASE("a fast ball is found before a thin wall that one step would carry it through") {
  const auto world = world_with_gravity();
  const ObstacleId wall = world->add_obstacle(box_obstacle({0.075, 3, 3}, {5, 0, 2}, 77));
  const double radius = 0.4, speed = 120;
  const BodyId ball = throw_body(*world, ball_body(radius, 500, {4, 0, 2}), {speed, 0, 0});
  const std::vector<Contact> contacts = world->sweep(kStep);
  REQUIRE(contacts.size() == 1);
  const Contact& hit = contacts[0];
  CHECK(hit.body == ball);
  CHECK(hit.other.kind == Touched::Kind::obstacle);
  CHECK(hit.other.obstacle == wall);
  CHECK(hit.other.part_tag == 77);
  const double gap = 5 - 0.075 - radius - 4;
  CHECK(hit.time == Approx(gap / speed).epsilon(1e-4));
  CHECK(hit.approach_speed == Approx(speed).epsilon(1e-9));
  CHECK(hit.normal.x() == Approx(1));
  CHECK(hit.point.x() == Approx(4.925).margin(1e-4));
  CHECK(hit.point.z() == Approx(2 - kGravity * hit.time * hit.time / 2).margin(1e-4));
  CHECK_FALSE(hit.persistent);
  // Nothing moved.
  CHECK(world->state(ball).pose.position.x() == 4);
}

TEST_CASE("a falling ball meets the ground at the time and speed of the parabola") {
  const auto world = world_with_ground();
  const double drop = 0.05, down = 2;
  throw_body(*world, ball_body(0.4, 10, {0, 0, 0.4 + drop}), {1, 0, -down});
  const double time = (std::sqrt(down * down + 2 * kGravity * drop) - down) / kGravity;
  REQUIRE(time > kStep);  // not in this step, but in two
  CHECK(world->sweep(kStep).empty());
  const auto later = make_bullet_world();
  const double dt = 2 * kStep;
  later->set_gravity({0, 0, -kGravity});
  later->set_ground(0, 0.6, 0);
  BodyDescription ball = ball_body(0.4, 10, {0, 0, 0.4 + drop});
  ball.velocity = Vec3(1, 0, -down + kGravity * dt / 2);
  later->add_body(ball);
  const std::vector<Contact> contacts = later->sweep(dt);
  REQUIRE(contacts.size() == 1);
  CHECK(contacts[0].time == Approx(time).epsilon(1e-5));
  CHECK(contacts[0].approach_speed == Approx(down + kGravity * time).epsilon(1e-6));
  CHECK(contacts[0].point.x() == Approx(time).epsilon(1e-5));
}

TEST_CASE("a box turned by 45 degrees meets a wall with its edge, and its spin is part of the speed") {
  const auto world = make_bullet_world();
  world->add_obstacle(box_obstacle({0.5, 5, 5}, {0, 0, 0}));
  const double half = 0.5, reach = half * std::sqrt(2.0), gap = 0.1, speed = 30, spin = 8;
  BodyDescription box = box_body({half, half, 1}, 100, {-0.5 - gap - reach, 0, 0});
  box.pose.orientation = Eigen::AngleAxisd(EIGEN_PI / 4, Vec3::UnitZ());
  box.velocity = Vec3(speed, 0, 0);
  box.angular_velocity = Vec3(0, 0, spin);
  world->add_body(box);
  const std::vector<Contact> contacts = world->sweep(kStep);
  REQUIRE(contacts.size() == 1);
  // The leading edge turns away from the wall's normal: it is where x = v t + r cos(w t) reaches the gap.
  double time = gap / speed;
  for (int i = 0; i < 50; ++i) time = (gap + reach - reach * std::cos(spin * time)) / speed;
  // Edges are rounded by 0.4 of the skin, 4 um of a gap of 100 mm.
  CHECK(contacts[0].time == Approx(time).epsilon(1e-4));
  CHECK(contacts[0].approach_speed == Approx(speed - spin * reach * std::sin(spin * time)).epsilon(2e-3));
  CHECK(contacts[0].normal.x() == Approx(1).margin(1e-6));
  // An edge along z: its middle is where it touches, and its ends are the corners.
  CHECK(std::abs(contacts[0].point.z()) < 1e-6);
}

TEST_CASE("a corner is swept before contacts stop it, however slow it is and however short the part of a step") {
  for (const double dt : {1.0 / 60, 1.0 / 480, 1.0 / 7680})
    for (const double speed : {0.05, 0.2, 1.0}) {
      INFO(speed << " m/s in steps of " << dt << " s");
      const auto world = make_bullet_world();
      world->add_obstacle(box_obstacle({0.5, 5, 5}, {0, 0, 0}));
      const double half = 0.5, reach = half * std::sqrt(3.0);
      BodyDescription box = box_body({half, half, half}, 1000, {-0.5 - 0.003 - reach, 0, 0});
      box.pose.orientation = Eigen::Quaterniond::FromTwoVectors(Vec3(1, 1, 1), Vec3(1, 0, 0));
      box.velocity = Vec3(speed, 0, 0);
      world->add_body(box);
      bool swept = false, stopped = false;
      for (double time = 0; time < 0.1 && !stopped; time += dt) {
        for (const Contact& contact : world->sweep(dt)) swept = swept || contact.approach_speed > 0.9 * speed;
        world->step(dt);
        for (const Contact& contact : world->contacts()) stopped = stopped || contact.impulse.norm() > 0;
      }
      CHECK(stopped);
      CHECK(swept);
    }
}

TEST_CASE("a slab that falls flat on a table touches with four corners about its centre") {
  const auto world = world_with_gravity();
  world->add_obstacle(box_obstacle({5, 5, 0.5}, {0, 0, 0.5}));
  throw_body(*world, box_body({3, 2, 0.1}, 2000, {0.5, 0.25, 1.15}), {0, 0, -8});
  const std::vector<Contact> contacts = world->sweep(kStep);
  REQUIRE(contacts.size() == 1);
  CHECK(contacts[0].corner_count == 4);
  CHECK((contacts[0].point - Vec3(0.5, 0.25, 1)).norm() < 0.005);
  double spread = 0;
  for (const Vec3& corner : contacts[0].corners) spread += (corner - Vec3(0.5, 0.25, 1)).head<2>().norm();
  CHECK(spread / 4 == Approx(std::sqrt(13.0)).epsilon(0.01));
}

TEST_CASE("contacts come in order of time, then of body id, and two bodies meet by the lower id") {
  const auto world = make_bullet_world();
  world->add_obstacle(box_obstacle({0.1, 20, 20}, {3, 0, 0}));
  const BodyId late = throw_body(*world, ball_body(0.2, 1, {0, 5, 0}), Vec3(200, 0, -kGravity * kStep / 2));
  const BodyId left = throw_body(*world, ball_body(0.2, 1, {-1, 0, 0}), Vec3(50, 0, -kGravity * kStep / 2));
  const BodyId right = throw_body(*world, ball_body(0.2, 1, {0, 0, 0}), Vec3(-50, 0, -kGravity * kStep / 2));
  const BodyId twin = throw_body(*world, ball_body(0.2, 1, {0, -5, 0}), Vec3(200, 0, -kGravity * kStep / 2));
  const std::vector<Contact> contacts = world->sweep(kStep);
  REQUIRE(contacts.size() == 3);
  CHECK(contacts[0].body == left);
  CHECK(contacts[0].other.body == right);
  CHECK(contacts[0].approach_speed == Approx(100));
  CHECK(contacts[0].time == Approx(0.6 / 100).epsilon(1e-3));
  CHECK(contacts[1].body == late);
  CHECK(contacts[2].body == twin);
  CHECK(contacts[1].time == contacts[2].time);
}

TEST_CASE("a body of several parts says which of them will touch which part of what stands") {
  const auto world = make_bullet_world();
  ObstacleDescription posts;
  posts.parts = {box_part({0.1, 0.1, 1}, 501, {0, -2, 0}), box_part({0.1, 0.1, 1}, 502, {0, 2, 0})};
  posts.pose.position = Vec3(5, 0, 0);
  world->add_obstacle(posts);
  BodyDescription bar = box_body({0.1, 3, 0.1}, 50, {4.5, 0, 0});
  bar.parts = {box_part({0.1, 1.5, 0.1}, 11, {0, -1.5, 0}), box_part({0.1, 1.5, 0.1}, 12, {0, 1.5, 0})};
  bar.velocity = Vec3(40, 0, 0);
  bar.angular_velocity = Vec3(0, 0, -2);
  world->add_body(bar);
  const std::vector<Contact> contacts = world->sweep(kStep);
  REQUIRE(contacts.size() == 2);
  CHECK(contacts[0].part_tag == 12);  // this end is ahead
  CHECK(contacts[0].other.part_tag == 502);
  CHECK(contacts[1].part_tag == 11);
  CHECK(contacts[1].other.part_tag == 501);
  CHECK(contacts[0].approach_speed > 40);
  CHECK(contacts[1].approach_speed < 40);
}

TEST_CASE("what lies closes on nothing, what is new there is told as new, and what is pressed as persistent") {
  const auto world = world_with_ground();
  const BodyId lying = world->add_body(box_body({0.5, 0.5, 0.5}, 100, {0, 0, 0.5}));
  run(*world, 10);
  const BodyId fresh = world->add_body(box_body({0.5, 0.5, 0.5}, 100, {5, 0, 0.5}));
  std::vector<Contact> contacts = world->sweep(kStep);
  REQUIRE(contacts.size() == 1);
  CHECK(contacts[0].body == fresh);
  CHECK_FALSE(contacts[0].persistent);
  CHECK(contacts[0].approach_speed < 2 * kGravity * kStep);
  world->apply_impulse(lying, {0, 0, -100}, {0, 0, 0.5});
  contacts = world->sweep(kStep);
  REQUIRE(contacts.size() == 2);
  CHECK(contacts[0].body == lying);
  CHECK(contacts[0].persistent);
  CHECK(contacts[0].approach_speed == Approx(1).margin(1e-3));
}

TEST_CASE("the step itself does not carry a fast ball through a wall, nor through a sleeping body") {
  const auto world = make_bullet_world();
  world->add_obstacle(box_obstacle({0.05, 3, 3}, {5, 0, 0}));
  BodyDescription ball = ball_body(0.3, 500, {0, 0, 0});
  ball.velocity = Vec3(150, 0, 0);
  const BodyId id = world->add_body(ball);
  run(*world, 10);
  CHECK(world->state(id).pose.position.x() < 4.7);
}

TEST_CASE("a sweep for obstacles finds those alone, as the full sweep does") {
  const auto world = world_with_ground();
  world->add_obstacle(box_obstacle({0.1, 2, 2}, {0.55, 0, 0.5}));
  BodyDescription ball = ball_body(0.4, 500, {0, 0, 0.45});
  ball.velocity = Vec3(30, 0, -20);
  world->add_body(ball);
  world->add_body(box_body({0.2, 0.2, 0.2}, 100, {0, 0.7, 0.45}));
  const std::vector<Contact> all = world->sweep(kStep), standing = world->sweep(kStep, {Sweep::obstacles});
  REQUIRE(standing.size() == 1);
  CHECK(all.size() > 1);
  const auto same =
      std::find_if(all.begin(), all.end(), [](const Contact& c) { return c.other.kind == Touched::Kind::obstacle; });
  REQUIRE(same != all.end());
  CHECK(same->time == standing[0].time);
  CHECK(same->point == standing[0].point);
}

TEST_CASE("a sweep with a least speed leaves out bodies that close slowly, and no faster ones nor obstacles") {
  const auto world = world_with_ground();
  world->add_obstacle(box_obstacle({0.1, 2, 2}, {-0.55, 0, 2}));
  BodyDescription fast = box_body({0.2, 0.2, 0.2}, 100, {0, 0, 2}),
                  slow = box_body({0.2, 0.2, 0.2}, 100, {0, 5, 0.201});
  fast.velocity = Vec3(8, 0, 0);
  const BodyId hits = world->add_body(fast);
  BodyDescription struck = box_body({0.2, 0.2, 0.2}, 100, {0.45, 0, 2});
  world->add_body(struck);
  world->add_body(slow);  // it comes to lie on the ground
  BodyDescription spinning = box_body({1, 0.1, 0.1}, 100, {5, 0, 0.5});
  spinning.angular_velocity = Vec3(0, 30, 0);  // its centre falls slowly, its end strikes the ground
  const BodyId turns = world->add_body(spinning);
  const std::vector<Contact> all = world->sweep(kStep), quick = world->sweep(kStep, {.least_speed = 2.0});
  std::vector<Contact> expected;
  for (const Contact& contact : all)
    if (contact.approach_speed >= 2) expected.push_back(contact);
  REQUIRE(expected.size() >= 2);
  CHECK(quick.size() < all.size());
  for (const Contact& contact : expected)
    CHECK(std::any_of(quick.begin(), quick.end(), [&](const Contact& one) {
      return one.body == contact.body && one.time == contact.time && one.other.body == contact.other.body;
    }));
  CHECK(std::any_of(quick.begin(), quick.end(), [&](const Contact& one) { return one.body == hits; }));
  CHECK(std::any_of(quick.begin(), quick.end(), [&](const Contact& one) { return one.body == turns; }));
}

TEST_CASE("a sweep among some bodies leaves out what none of them has a part in, and nothing else") {
  const auto world = world_with_ground();
  world->add_obstacle(box_obstacle({0.1, 2, 2}, {-0.55, 0, 2}));
  std::vector<BodyId> bodies;
  const auto throw_down = [&](const Vec3& at, const Vec3& velocity) {
    BodyDescription body = box_body({0.2, 0.2, 0.2}, 100, at);
    body.velocity = velocity;
    bodies.push_back(world->add_body(body));
  };
  throw_down({9, 0, 0.2}, {0, 0, 0});
  for (int step = 0; step < 200 && !world->state(bodies[0]).asleep; ++step) world->step(kStep);
  REQUIRE(world->state(bodies[0]).asleep);
  throw_down({9, 0, 0.75}, {0, 0, -9});  // upon what sleeps
  throw_down({0, 0, 2}, {8, 0, 0});      // into the next
  throw_down({0.45, 0, 2}, {0, 0, 0});   // which does nothing
  throw_down({5, 0, 0.25}, {0, 0, -9});  // upon the ground
  throw_down({5, 5, 0.25}, {0, 0, -9});  // the same
  throw_down({-0.2, 1, 2}, {-9, 0, 0});  // against the wall
  throw_down({8, 8, 2}, {0, 0, 0});      // which does nothing
  throw_down({8.45, 8, 2}, {-9, 0, 0});  // into the last
  const std::vector<Contact> all = world->sweep(kStep);
  const auto has = [](const std::vector<BodyId>& some, BodyId id) {
    return std::find(some.begin(), some.end(), id) != some.end();
  };
  std::size_t left_out = 0;
  for (std::size_t subset = 0; subset < 1u << bodies.size(); ++subset) {
    std::vector<BodyId> among;
    for (std::size_t i = 0; i < bodies.size(); ++i)
      if ((subset >> i & 1) != 0) among.push_back(bodies[i]);
    const std::vector<Contact> found = world->sweep(kStep, {.among = among});
    std::vector<Contact> expected;
    for (const Contact& contact : all)
      if (contact.other.kind == Touched::Kind::obstacle || has(among, contact.body) ||
          (contact.other.kind == Touched::Kind::body && has(among, contact.other.body)))
        expected.push_back(contact);
    REQUIRE(found.size() == expected.size());
    for (std::size_t i = 0; i < found.size(); ++i)
      CHECK((found[i].body == expected[i].body && found[i].time == expected[i].time &&
             found[i].other.kind == expected[i].other.kind && found[i].other.body == expected[i].other.body));
    left_out = std::max(left_out, all.size() - found.size());
  }
  CHECK(left_out >= 3);
}

TEST_CASE("thousands of obstacles come and go, and are found by box and by ray") {
  const auto world = make_bullet_world();
  std::vector<ObstacleId> ids;
  for (int x = 0; x < 50; ++x) {
    for (int y = 0; y < 50; ++y)
      ids.push_back(world->add_obstacle(box_obstacle({0.2, 0.2, 1.5}, {4.0 * x, 4.0 * y, 1.5}, x * 100 + y)));
  }
  const std::vector<ObstacleId> found = world->obstacles_in({-1, -1, 0}, {5, 5, 1});
  CHECK(found == std::vector<ObstacleId>{ids[0], ids[1], ids[50], ids[51]});
  const std::optional<RayHit> hit = world->ray_cast({4, -10, 1}, {4, 100, 1});
  REQUIRE(hit);
  CHECK(hit->what.obstacle == ids[50]);
  CHECK(hit->what.part_tag == 100);
  CHECK(hit->distance == Approx(9.8).epsilon(1e-6));
  CHECK(hit->normal.y() == Approx(-1));
  for (std::size_t i = 0; i < ids.size(); i += 2) world->remove_obstacle(ids[i]);
  CHECK(world->obstacles_in({-1, -1, 0}, {5, 5, 1}) == std::vector<ObstacleId>{ids[1], ids[51]});
  CHECK_FALSE(world->ray_cast({-2, -10, 1}, {-2, 100, 1}));
}
