// What the collision engine costs for a heap of chunks of broken slabs: prisms that fall on the ground one upon the
// other and come to rest, with a wall that stands in the heap. Each second: time of a step, how many are awake, how
// fast they still are, how far things are inside each other, what the wall bears.
//   bench_heap [CHUNKS] [SECONDS] [sequential-impulse|small-steps]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>

#include "support/provenance.h"
#include "topple/collision/overlap_watch.h"
#include "topple/collision/sequential_impulse.h"
#include "topple/collision/small_steps.h"
#include "topple/collision/world.h"

namespace {

using namespace topple::collision;

constexpr double kDensity = 2500, kGravity = 9.81, kStep = 1.0 / 60;

/// A polygon of five to eight corners about its centroid, and its second moments of area.
struct Polygon {
  std::vector<Eigen::Vector2d> corners;
  double area = 0, xx = 0, yy = 0, xy = 0;
};

Polygon polygon(std::mt19937& random) {
  const auto between = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random() % 100003) / 100003);
  };
  Polygon result;
  const int count = 5 + static_cast<int>(random() % 4);
  const double a = between(0.3, 0.7), b = between(0.3, 0.7);
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * M_PI * (i + between(-0.25, 0.25)) / count;
    result.corners.emplace_back(a * std::cos(angle), b * std::sin(angle));
  }
  const auto sum = [&](auto&& term) {
    for (std::size_t i = 0; i < result.corners.size(); ++i) {
      const Eigen::Vector2d &p = result.corners[i], &q = result.corners[(i + 1) % result.corners.size()];
      term(p, q, p.x() * q.y() - q.x() * p.y());
    }
  };
  Eigen::Vector2d first(0, 0);
  sum([&](const auto& p, const auto& q, double cross) {
    result.area += cross / 2;
    first += (p + q) * cross / 6;
  });
  for (Eigen::Vector2d& corner : result.corners) corner -= first / result.area;
  sum([&](const auto& p, const auto& q, double cross) {
    result.xx += cross * (p.x() * p.x() + p.x() * q.x() + q.x() * q.x()) / 12;
    result.yy += cross * (p.y() * p.y() + p.y() * q.y() + q.y() * q.y()) / 12;
    result.xy += cross * (p.x() * q.y() + 2 * p.x() * p.y() + 2 * q.x() * q.y() + q.x() * p.y()) / 24;
  });
  return result;
}

BodyDescription chunk(std::mt19937& random, const Vec3& at) {
  const Polygon base = polygon(random);
  const double thick = 0.15 + 0.1 * static_cast<double>(random() % 3) / 2;
  BodyDescription body;
  ConvexPart part;
  part.kind = ConvexPart::Kind::hull;
  for (const Eigen::Vector2d& corner : base.corners)
    for (const double side : {-thick / 2, thick / 2}) part.points.emplace_back(corner.x(), corner.y(), side);
  part.tag = 0;
  body.parts = {part};
  body.mass = kDensity * base.area * thick;
  const double along = body.mass * thick * thick / 12, areal = kDensity * thick;
  body.inertia << areal * base.yy + along, -areal * base.xy, 0, -areal * base.xy, areal * base.xx + along, 0, 0, 0,
      areal * (base.xx + base.yy);
  body.friction = 0.6;
  body.pose.position = at;
  Eigen::Vector4d turn;
  for (double& q : turn) q = static_cast<double>(random() % 2001) / 1000 - 1;
  body.pose.orientation = Eigen::Quaterniond(turn.normalized());
  return body;
}

}  // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 600;
  const double seconds = argc > 2 ? std::atof(argv[2]) : 30;
  const std::string solver = argc > 3 ? argv[3] : "sequential-impulse";
  if (solver != "sequential-impulse" && solver != "small-steps") {
    std::fprintf(stderr, "bench_heap: no solver %s; accepted: sequential-impulse, small-steps\n", solver.c_str());
    return 2;
  }
  topple::bench::print_provenance(("Steps of a heap of chunks, " + solver).c_str(), 1);
  const auto world = solver == "small-steps" ? make_small_steps_world() : make_sequential_impulse_world();
  world->set_gravity({0, 0, -kGravity});
  world->set_ground(0, 0.6, 0);
  ObstacleDescription wall;
  ConvexPart box;
  box.half_extents = {0.15, 2, 1.5};
  box.tag = 0;
  wall.parts = {box};
  wall.pose.position = {0, 0, 1.5};
  wall.friction = 0.6;
  world->add_obstacle(wall);
  std::mt19937 random(7);
  double weight = 0;
  for (int i = 0; i < count; ++i) {
    const BodyDescription body = chunk(random, {-3.0 + 1.5 * (i % 5), -3.0 + 1.5 * (i / 5 % 5), 4 + 1.2 * (i / 25)});
    weight += body.mass * kGravity;
    world->add_body(body);
  }
  std::printf(
      "%d chunks, %.0f kN\n   s    ms/step  worst  sweep  awake  <5 cm/s  mean cm/s  contacts  deepest mm  sum mm  "
      "wall kN  height m\n",
      count, weight / 1e3);
  using clock = std::chrono::steady_clock;
  const auto ms = [](clock::duration span) { return 1e3 * std::chrono::duration<double>(span).count(); };
  std::vector<double> all;
  for (int second = 1; second <= seconds; ++second) {
    double whole = 0, worst = 0, sweeps = 0, wall_force = 0;
    for (int i = 0; i < 60; ++i) {
      const auto begin = clock::now();
      (void)world->sweep(kStep, {Sweep::obstacles});
      const auto swept = clock::now();
      world->step(kStep);
      const double took = ms(clock::now() - begin);
      sweeps += ms(swept - begin) / 60;
      whole += took / 60;
      worst = std::max(worst, took);
      all.push_back(took);
      for (const Contact& contact : world->contacts())
        if (contact.other.kind == Touched::Kind::obstacle) wall_force += contact.impulse.norm() / kStep / 60;
    }
    double speed = 0, deepest = 0, depth = 0, height = 0;
    int slow = 0;
    for (const BodyId id : world->bodies()) {
      const BodyState state = world->state(id);
      speed += state.velocity.norm() / count;
      height += state.pose.position.z() / count;
      if (!state.asleep && state.velocity.norm() < 0.05) ++slow;
    }
    for (const Contact& contact : world->contacts()) {
      deepest = std::max(deepest, contact.depth);
      depth += std::max(0.0, contact.depth - 0.003);
    }
    std::printf("%4d %9.2f %7.2f %6.2f %6zu %8d %10.3f %9zu %11.1f %7.0f %8.1f %9.4f\n", second, whole, worst, sweeps,
                world->awake_count(), slow, 100 * speed, world->contacts().size(), 1e3 * deepest, 1e3 * depth,
                wall_force / 1e3, height);
    std::fflush(stdout);
    if (world->awake_count() == 0) break;
  }
  std::sort(all.begin(), all.end());
  double sum = 0;
  for (double one : all) sum += one;
  std::printf("mean %.2f ms, median %.2f, 99 %% %.2f, worst %.2f of %zu steps\n", sum / static_cast<double>(all.size()),
              all[all.size() / 2], all[all.size() * 99 / 100], all.back(), all.size());
  return 0;
}
