// A hull whose points are seen to be a prism has the faces that a search finds.
#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>

#include "world_builder.h"

using namespace collision_test;

namespace {

/// Six-sided, 0.2 m thick, its axis along z; corners going round one way or the other. Not in order they are just
/// points.
ConvexPart hexagon(bool in_order, bool clockwise) {
  ConvexPart part;
  part.kind = ConvexPart::Kind::hull;
  for (int i = 0; i < 6; ++i) {
    const double angle = (clockwise ? -1 : 1) * (0.3 + M_PI * i / 3);
    for (const double side : {-0.1, 0.1}) part.points.emplace_back(0.5 * std::cos(angle), 0.4 * std::sin(angle), side);
  }
  if (!in_order) std::swap(part.points[1], part.points[7]);
  return part;
}

BodyDescription lying(bool in_order, bool clockwise, const Vec3& at) {
  BodyDescription body = box_body({0.45, 0.35, 0.1}, 200, at);
  body.parts = {hexagon(in_order, clockwise)};
  return body;
}

/// One on a plate, 1 cm into it, one upon that one, a little askew.
std::unique_ptr<World> stack(bool in_order, bool clockwise) {
  auto world = world_with_ground();
  world->add_obstacle(box_obstacle({2, 2, 0.05}, {0, 0, 1}));
  world->add_body(lying(in_order, clockwise, {0, 0, 1.14}));
  BodyDescription upper = lying(in_order, clockwise, {0.05, 0, 1.36});
  upper.pose.orientation = Eigen::AngleAxisd(0.05, Vec3(0.2, 1, 0).normalized());
  world->add_body(upper);
  return world;
}

}  // namespace

TEST_CASE("a prism touches as the hull of its points does, whichever way its corners go round") {
  for (const bool clockwise : {false, true}) {
    const auto told = stack(true, clockwise), sought = stack(false, clockwise);
    told->step(kStep);
    sought->step(kStep);
    REQUIRE(told->contacts().size() == sought->contacts().size());
    REQUIRE_FALSE(told->contacts().empty());
    for (std::size_t i = 0; i < told->contacts().size(); ++i) {
      const Contact &a = told->contacts()[i], &b = sought->contacts()[i];
      CHECK(a.thickness == Approx(b.thickness).epsilon(1e-9));
      CHECK(a.depth == Approx(b.depth).margin(1e-5));  // where faces do not meet, of an iteration
      CHECK((a.normal - b.normal).norm() < 1e-4);
      CHECK(a.corner_count == b.corner_count);
    }
    for (int i = 0; i < 240; ++i) {
      told->step(kStep);
      sought->step(kStep);
    }
    for (const std::int64_t id : {0, 1}) {
      const BodyState a = told->state({id}), b = sought->state({id});
      // Points of contact come in another order, and with them the solver's rounding: the same way to lie all the same.
      CHECK((a.pose.position - b.pose.position).norm() < 0.02);
      CHECK(a.pose.position.z() == Approx(b.pose.position.z()).margin(0.002));
    }
  }
}

TEST_CASE("points that only look like a prism's at first have the faces of their hull") {
  using Points = std::vector<Vec3>;
  const std::vector<std::function<void(Points&)>> changes{
      [](Points& points) { points[3].z() += 0.02; },  // one corner higher
      [](Points& points) {                            // leaning
        for (std::size_t i = 1; i < points.size(); i += 2) points[i].x() += 0.05;
      },
      [](Points& points) {  // crossing itself
        for (const std::size_t end : {0, 1}) std::swap(points[2 + end], points[6 + end]);
      },
      [](Points& points) {  // a corner that points inwards
        for (const std::size_t end : {0, 1}) points[2 + end].head<2>() *= 0.2;
      },
      [](Points& points) { points.pop_back(); },  // a corner without its opposite
  };
  for (std::size_t change = 0; change < changes.size(); ++change) {
    CAPTURE(change);
    const auto contact = [&](bool as_given) {
      auto world = world_with_ground();
      world->add_obstacle(box_obstacle({2, 2, 0.05}, {0, 0, 1}));
      BodyDescription body = lying(true, false, {0, 0, 1.14});
      changes[change](body.parts[0].points);
      if (!as_given) std::reverse(body.parts[0].points.begin(), body.parts[0].points.end() - 1);
      world->add_body(body);
      world->step(kStep);
      REQUIRE(world->contacts().size() == 1);
      return world->contacts()[0];
    };
    const Contact given = contact(true), turned = contact(false);
    CHECK(given.thickness == Approx(turned.thickness).epsilon(1e-9));
    CHECK(given.depth == Approx(turned.depth).margin(1e-9));
    CHECK(given.corner_count == turned.corner_count);
  }
}

TEST_CASE("a prism that turns past another, known to be apart from it, touches it when its tip gets there") {
  const auto bar = [](double half_length) {
    ConvexPart part = hexagon(true, false);
    for (Vec3& point : part.points) point.x() *= half_length / 0.5;
    return part;
  };
  const auto world = make_bullet_world();  // no gravity
  BodyDescription turning = box_body({2, 0.35, 0.1}, 400, {0, 0, 5});
  turning.parts = {bar(2)};
  turning.angular_velocity = Vec3(0, 0, 0.5);
  // A tall post that stands in the way of the bar's end, a quarter of a turn on; their bounds meet long before.
  ObstacleDescription post;
  post.parts = {bar(0.5)};
  for (Vec3& point : post.parts[0].points) point.z() *= 30;
  post.pose.position = Vec3(0, 1.8, 5);
  world->add_obstacle(post);  // first, so that to the search it is the bar that moves
  const BodyId id = world->add_body(turning);
  const auto apart = [&] {
    const BodyState state = world->state(id);
    double least = 10;  // m across the bar's sides, of the post's corners near its end
    for (const Vec3& corner : post.parts[0].points) {
      const Vec3 at = state.pose.orientation.conjugate() * (Vec3(corner.x(), corner.y(), 0) + Vec3(0, 1.8, 0));
      double out = -10;  // over the side of the bar that it is farthest out of
      const std::vector<Vec3>& sides = turning.parts[0].points;
      for (std::size_t i = 0; i < sides.size(); i += 2) {
        const Vec3 &a = sides[i], &b = sides[(i + 2) % sides.size()];
        const Vec3 outward = Vec3(b.y() - a.y(), a.x() - b.x(), 0).normalized();
        out = std::max(out, (Vec3(at.x(), at.y(), a.z()) - a).dot(outward));
      }
      least = std::min(least, out);
    }
    return least;
  };
  int steps = 0;
  double before = apart();
  while (world->state(id).angular_velocity.z() > 0.4 && steps < 600) {
    before = apart();
    world->step(kStep);
    ++steps;
  }
  INFO(steps);
  CHECK(steps > 60);
  CHECK(steps < 190);      // a quarter of a turn
  CHECK(before < 0.02);    // no sooner
  CHECK(apart() > -0.01);  // and no later
}
