// What the benchmark of debris measures with, against closed forms.
#include <catch2/catch.hpp>
#include <cmath>

#include "measures.h"
#include "topple/collision/sequential_impulse.h"
#include "topple/collision/small_steps.h"

using namespace topple::bench;
using Eigen::AngleAxisd, Eigen::Quaterniond, Eigen::Vector3d;

TEST_CASE("a box has the volume, moments, faces and edges of a box") {
  const ConvexSolid box = box_solid({1, 0.5, 0.25});
  CHECK(box.volume == Approx(1.0));
  CHECK(box.reach == Approx(std::sqrt(1 + 0.25 + 0.0625)));
  const Vector3d moments(0.25 + 0.0625, 1 + 0.0625, 1.25);  // times m/3
  CHECK((box.inertia - Eigen::Matrix3d((moments / 3).asDiagonal())).norm() < 1e-14);
  CHECK(box.normals.size() == 3);
  CHECK(box.edges.size() == 3);
}

TEST_CASE("a frustum has the volume and the centre of a cut pyramid") {
  const double taper = 0.5, thick = 0.6, side = 2;
  const ConvexSolid solid = frustum({{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, thick, taper);
  const double areas = side * side * (1 + taper + taper * taper);
  CHECK(solid.volume == Approx(thick / 3 * areas));
  const double centre = thick / 4 * (1 + 2 * taper + 3 * taper * taper) / (1 + taper + taper * taper);
  CHECK(-solid.corners[0].z() == Approx(centre));
}

TEST_CASE("overlaps are those of the axis along which two solids come apart first") {
  const ConvexSolid box = box_solid({0.5, 0.5, 0.5});
  const Quaterniond level = Quaterniond::Identity();
  const PlacedSolid one(box, {0, 0, 0}, level);
  CHECK(overlap(one, PlacedSolid(box, {0.97, 0.1, 0.2}, level)) == Approx(0.03));
  CHECK(overlap(one, PlacedSolid(box, {1.2, 0.1, 0.2}, level)) < 0);
  // Edge across edge: each reaches half a diagonal along the line between the centres.
  const Quaterniond first(AngleAxisd(M_PI / 4, Vector3d::UnitX())), second(AngleAxisd(M_PI / 4, Vector3d::UnitY()));
  const double apart = std::sqrt(2.0) - 0.05;
  CHECK(overlap(PlacedSolid(box, {0, 0, 0}, first), PlacedSolid(box, {0, 0, apart}, second)) == Approx(0.05));
  const std::vector<PlacedSolid> bodies{one, PlacedSolid(box, {0.985, 0, 0}, level)};
  const Overlaps found = find_overlaps(bodies, {}, true);
  CHECK(found.over_10_mm == 3);  // both are half in the ground
  CHECK(found.over_20_mm == 2);
  CHECK(found.deepest == Approx(0.5));
}

namespace {

/// A box that falls level, by `height`.
DebrisScene falling_box(double height) {
  DebrisScene scene;
  scene.shapes = {box_solid({0.5, 0.4, 0.3})};
  FallingSolid box;
  box.pose.position = Vector3d(0, 0, 0.3 + height);
  scene.falling = {box};
  scene.seconds = 4;
  return scene;
}

}  // namespace

TEST_CASE("a box that falls makes no energy, presses with its weight, rests, and has the same bits again") {
  const DebrisScene scene = falling_box(1);
  const MakeWorld make = topple::collision::make_small_steps_world;
  const DebrisMeasures measured = measure_debris(scene, make),
                       again = time_debris(scene, make, topple::bench::StepTime::processor);
  CHECK(measured.bits == again.bits);
  CHECK(measured.bodies == 1);
  REQUIRE(measured.rest.has_value());
  const double fall = std::sqrt(2 / kDebrisGravity);
  CHECK(*measured.rest > fall + 0.4);  // slow for half a second, read at the ends of steps
  CHECK(*measured.rest < 3);
  REQUIRE(measured.created.has_value());
  CHECK(*measured.created < 1e-3);
  CHECK(measured.height == Approx(0.3).margin(0.001));
  CHECK(measured.asleep.count == 1);
  CHECK(measured.asleep.worst_force < 1e-5);
  CHECK(measured.awake.count > 0);
  CHECK(measured.awake.worst_force < 1e-9);
  CHECK(measured.momentum < 1e-9);
}

TEST_CASE("under a solver that tells nothing when bodies fall asleep, they press as in the step before") {
  const DebrisMeasures measured = measure_debris(falling_box(0), topple::collision::make_sequential_impulse_world);
  REQUIRE(measured.rest.has_value());
  REQUIRE(measured.asleep.count == 1);
  CHECK(measured.asleep.worst_force < 1e-3);  // it stops after a number of iterations
}

TEST_CASE("a body that nothing bears while it sleeps is out of balance by its weight") {
  DebrisScene scene = falling_box(5);
  scene.seconds = 0.05;
  DebrisRun run(scene, topple::collision::make_small_steps_world());
  BodyBalances balances(scene);
  run.begin_step(0);
  balances.begin_step(run, run.world());
  topple::collision::BodyState state = run.world().state(run.bodies()[0]);
  state.asleep = true;
  run.world().set_state(run.bodies()[0], state);
  run.step();
  balances.end_step(run, run.world());
  CHECK(balances.asleep(run, run.world()).worst_force == Approx(1));
}

TEST_CASE("a scene that is not there is refused with those that are") {
  CHECK_THROWS_WITH(debris_scene("towers", 1), Catch::Contains("towers") && Catch::Contains("slabs"));
  for (const std::string& name : debris_scene_names()) CHECK_FALSE(debris_scene(name, 1).falling.empty());
}
