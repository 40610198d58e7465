#include "scenes.h"

#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>

namespace topple::bench {

namespace {

using Eigen::AngleAxisd, Eigen::Quaterniond, Eigen::Vector3d;

constexpr double kDegree = M_PI / 180;

class Chance {
 public:
  explicit Chance(unsigned seed) : random_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(random_()) / 4294967296.0);
  }
  int up_to(int largest) { return static_cast<int>(between(0, largest + 1)); }
  Quaterniond turn() {
    Eigen::Vector4d q;
    do {
      for (double& component : q) component = between(-1, 1);
    } while (q.norm() > 1 || q.norm() < 0.1);
    return Quaterniond(q.normalized());
  }

 private:
  std::mt19937 random_;  // its numbers are the standard's, whoever compiles it
};

/// A piece of a slab 0.2 m thick: four to seven sides, half a metre to more than a metre across, sides that lean.
ConvexSolid chunk(Chance& chance) {
  const int sides = 4 + chance.up_to(3);
  const double wide = chance.between(0.25, 0.6), deep = chance.between(0.25, 0.6), taper = chance.between(0.75, 1);
  std::vector<Eigen::Vector2d> base;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * M_PI * (i + chance.between(-0.25, 0.25)) / sides;
    base.emplace_back(wide * std::cos(angle), deep * std::sin(angle));
  }
  return frustum(base, 0.2, taper);
}

FallingSolid at(std::size_t shape, const Vector3d& position, const Quaterniond& turn = Quaterniond::Identity()) {
  FallingSolid made;
  made.shape = shape;
  made.pose = {position, turn};
  return made;
}

Quaterniond about(const Vector3d& axis, double angle) { return Quaterniond(AngleAxisd(angle, axis)); }

/// Floors of 6 m with a post lying on each, nine stacks of them.
void slabs(DebrisScene& scene, Chance& chance) {
  scene.what = "200 slabs of 6 m and 200 posts of 4 m fall in nine stacks";
  scene.shapes = {box_solid({3, 3, 0.1}), box_solid({0.15, 0.15, 2})};
  for (int i = 0; i < 200; ++i) {
    const int level = i / 9, cell = i % 9;
    const Vector3d place(6.6 * (cell % 3 - 1), 6.6 * (cell / 3 - 1), 3 + 0.74 * level);
    const double turn = chance.between(-3, 3), nod = chance.between(-1.2, 1.2), roll = chance.between(-1.2, 1.2);
    scene.falling.push_back(at(0, place,
                               about(Vector3d::UnitZ(), turn * kDegree) * about(Vector3d::UnitX(), nod * kDegree) *
                                   about(Vector3d::UnitY(), roll * kDegree)));
    const Vector3d beside(chance.between(-0.5, 0.5), chance.between(-0.5, 0.5), 0.42);
    const double heading = chance.between(0, 180), lean = 90 + chance.between(-0.5, 0.5);
    scene.falling.push_back(
        at(1, place + beside, about(Vector3d::UnitZ(), heading * kDegree) * about(Vector3d::UnitY(), lean * kDegree)));
  }
}

/// 64 forms of chunks, `count` of them, a layer of side x side every `every` steps.
void pour(DebrisScene& scene, Chance& chance, int count, int side, int every, const Vector3d& corner) {
  for (int i = 0; i < 64; ++i) scene.shapes.push_back(chunk(chance));
  for (int i = 0; i < count; ++i) {
    const int layer = i / (side * side), cell = i % (side * side);
    FallingSolid made =
        at(static_cast<std::size_t>(i % 64), corner + 1.3 * Vector3d(cell % side, cell / side, 0), chance.turn());
    made.velocity = Vector3d(0, 0, -6);
    made.from_step = every * layer;
    scene.falling.push_back(made);
  }
}

void chunks(DebrisScene& scene, Chance& chance) {
  scene.what = "1,000 chunks are poured on the ground and a wall";
  pour(scene, chance, 1000, 5, 15, {-5.9, -2.6, 8});
  scene.standing.push_back({scene.shapes.size(), {0, 0, 1.5}, 0.6});
  scene.shapes.push_back(box_solid({0.15, 3, 1.5}));
}

void heap(DebrisScene& scene, Chance& chance) {
  scene.what = "5,000 chunks are poured on the ground";
  pour(scene, chance, 5000, 10, 15, {-5.85, -5.85, 12});
  scene.seconds = 30;
}

/// Panels side by side come down at once, on the ground and on walls that are left of the storey below.
void falling_floor(DebrisScene& scene, Chance& chance) {
  scene.what = "a floor of 400 panels falls on walls that stand";
  scene.shapes = {box_solid({1.5, 1.5, 0.1}), box_solid({0.15, 30, 0.75})};
  for (int i = 0; i < 400; ++i) {
    const Vector3d place(3.02 * (i % 20 - 9.5), 3.02 * (i / 20 - 9.5), 4);
    const double nod = chance.between(-0.1, 0.1), roll = chance.between(-0.1, 0.1);  // 3 mm at the edge
    scene.falling.push_back(
        at(0, place, about(Vector3d::UnitX(), nod * kDegree) * about(Vector3d::UnitY(), roll * kDegree)));
  }
  for (int i = -2; i <= 2; ++i) scene.standing.push_back({1, {12.4 * i, 0, 0.75}, 0.6});
}

void heavy(DebrisScene& scene, double ratio) {
  scene.what = "a box of so many times the mass on another";
  scene.shapes = {box_solid({0.5, 0.5, 0.5})};
  scene.falling = {at(0, {0, 0, 0.5}), at(0, {0, 0, 1.5})};
  scene.falling[1].density *= ratio;
  scene.seconds = 10;
}

void stack(DebrisScene& scene, Chance&) {
  scene.what = "ten boxes one upon the other";
  scene.shapes = {box_solid({0.5, 0.5, 0.5})};
  for (int i = 0; i < 10; ++i) scene.falling.push_back(at(0, {0.01 * (i % 2), 0, 0.5 + i}));
  scene.seconds = 10;
}

/// Upright 3 m high, 0.2 m thick.
void add_slab_and_wall(DebrisScene& scene, double wall_x, double wall_friction) {
  scene.shapes = {box_solid({0.1, 1, 1.5}), box_solid({0.15, 3, 2})};
  scene.standing = {{1, {wall_x - 0.15, 0, 2}, wall_friction}};
}

/// A slab that leans towards -x by `angle` from upright and touches the wall x = 0 and the ground, both but for `gap`.
FallingSolid leaning(double angle, double gap) {
  const Quaterniond turn = about(Vector3d::UnitY(), -angle);
  const double half_along = 0.1 * std::cos(angle) + 1.5 * std::sin(angle),
               half_up = 1.5 * std::cos(angle) + 0.1 * std::sin(angle);
  return at(0, {half_along + gap, 0, half_up + gap}, turn);
}

void lean(DebrisScene& scene, Chance&) {
  scene.what = "20 slabs lean on a wall like books";
  add_slab_and_wall(scene, 0, 0.6);
  const double angle = 15 * kDegree, gap = 0.002;
  for (int i = 0; i < 20; ++i) {
    scene.falling.push_back(leaning(angle, gap));
    scene.falling.back().pose.position.x() += i * (0.2 / std::cos(angle) + gap);
  }
}

void dominoes(DebrisScene& scene, Chance&) {
  scene.what = "20 slabs in a row, the last pushed over";
  add_slab_and_wall(scene, -1, 0.6);
  for (int i = 0; i < 20; ++i) scene.falling.push_back(at(0, {0.1 + i, 0, 1.5}));
  scene.falling.back().spin = Vector3d(0, -0.6, 0);
  scene.falling.back().velocity = scene.falling.back().spin.cross(Vector3d(0, 0, 1.5));
}

void plank(DebrisScene& scene, Chance&) {
  scene.what = "a slab leans on a wall without friction";
  add_slab_and_wall(scene, 0, 0);
  scene.falling = {leaning(25 * kDegree, 0)};
  scene.seconds = 10;
}

void thrown(DebrisScene& scene, Chance& chance) {
  scene.what = "216 chunks fly at each other, without gravity";
  for (int i = 0; i < 64; ++i) scene.shapes.push_back(chunk(chance));
  scene.ground = scene.gravity = false;
  scene.seconds = 10;
  for (int i = 0; i < 216; ++i) {
    const Vector3d place = 1.4 * (Vector3d(i % 6, i / 6 % 6, i / 36) - Vector3d::Constant(2.5));
    FallingSolid made = at(static_cast<std::size_t>(i % 64), place, chance.turn());
    for (int k = 0; k < 3; ++k) {
      made.velocity[k] = chance.between(-1, 1) - place[k];
      made.spin[k] = chance.between(-2, 2);
    }
    scene.falling.push_back(made);
  }
}

struct Named {
  const char* name;
  std::function<void(DebrisScene&, Chance&)> make;
};

const std::array<Named, 12>& all_scenes() {
  const auto of_ratio = [](double ratio) { return [ratio](DebrisScene& scene, Chance&) { heavy(scene, ratio); }; };
  static const std::array<Named, 12> all{{{"plank", plank},
                                          {"heavy_10", of_ratio(10)},
                                          {"heavy_100", of_ratio(100)},
                                          {"heavy_1000", of_ratio(1000)},
                                          {"stack", stack},
                                          {"lean", lean},
                                          {"dominoes", dominoes},
                                          {"thrown", thrown},
                                          {"slabs", slabs},
                                          {"floor", falling_floor},
                                          {"chunks", chunks},
                                          {"heap", heap}}};
  return all;
}

}  // namespace

std::vector<std::string> debris_scene_names() {
  std::vector<std::string> names;
  for (const Named& one : all_scenes()) names.emplace_back(one.name);
  return names;
}

DebrisScene debris_scene(const std::string& name, unsigned seed) {
  std::string accepted;
  for (const Named& one : all_scenes()) {
    if (name == one.name) {
      DebrisScene scene;
      scene.name = name;
      Chance chance(seed);
      one.make(scene, chance);
      return scene;
    }
    accepted += accepted.empty() ? one.name : std::string(", ") + one.name;
  }
  throw std::invalid_argument("no scene " + name + "; accepted: " + accepted);
}

DebrisRun::DebrisRun(const DebrisScene& scene, std::unique_ptr<collision::World> world)
    : scene_(scene), world_(std::move(world)) {
  world_->set_gravity({0, 0, scene.gravity ? -kDebrisGravity : 0});
  if (scene.ground) world_->set_ground(0, 0.6, 0.1);
  for (const StandingSolid& stands : scene.standing) {
    collision::ConvexPart part;
    part.half_extents = scene.shapes[stands.shape].half;
    part.tag = 0;
    collision::ObstacleDescription obstacle;
    obstacle.parts = {part};
    obstacle.pose.position = stands.position;
    obstacle.friction = stands.friction;
    world_->add_obstacle(obstacle);
  }
}

bool DebrisRun::begin_step(int number) {
  const std::size_t before = bodies_.size();
  while (!all_there() && scene_.falling[bodies_.size()].from_step <= number) {
    const FallingSolid& falls = scene_.falling[bodies_.size()];
    const ConvexSolid& shape = scene_.shapes[falls.shape];
    collision::ConvexPart part;
    part.tag = 0;
    if (shape.box) {
      part.half_extents = shape.half;
    } else {
      part.kind = collision::ConvexPart::Kind::hull;
      part.points = shape.corners;
    }
    collision::BodyDescription body;
    body.parts = {part};
    body.mass = falls.density * shape.volume;
    body.inertia = falls.density * shape.inertia;
    body.pose = falls.pose;
    body.velocity = falls.velocity;
    body.angular_velocity = falls.spin;
    bodies_.push_back(world_->add_body(body));
  }
  return bodies_.size() > before;
}

}  // namespace topple::bench
