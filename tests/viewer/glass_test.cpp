// Glass: what is behind it is seen, it mirrors the sky at a glancing angle, casts no shadow, and breaks into shards.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "app/open_scene.h"
#include "app/session.h"
#include "renderer/picture_renderer.h"
#include "renderer/shapes/looks.h"
#include "topple/structure/formats/files.h"

namespace {

using namespace topple::viewer;
namespace structure = topple::structure;

/// The shipped wall of 6 m x 3 m in the plane y = 0, of another material.
structure::Building wall_of(const std::string& material) {
  structure::Building building = structure::read_model(structure::find_model("wall"));
  for (structure::Material& one : building.materials) one.name = material;
  return building;
}

Camera eye_at(glm::dvec3 eye) {
  Camera camera;
  camera.eye = eye;
  camera.target = {3, 0, 1.5};
  camera.field_of_view = 0.7;
  return camera;
}

struct Difference {
  double share = 0;  ///< of pixels that differ by more than noise
  double mean = 0;   ///< by how much those do, 0 to 255
};
Difference between(const Image& a, const Image& b) {
  Difference found;
  int count = 0;
  for (std::size_t i = 0; i < a.pixels.size(); i += 4) {
    int by = 0;
    for (std::size_t c = 0; c < 3; ++c) by = std::max(by, std::abs(a.pixels[i + c] - b.pixels[i + c]));
    if (by <= 3) continue;
    ++count;
    found.mean += by;
  }
  if (count > 0) found.mean /= count;
  found.share = static_cast<double>(count) / (a.width * a.height);
  return found;
}

/// What a wall of this material changes in the picture of the ground and sky without it.
Difference change_by(const std::string& material, const Camera& camera) {
  const structure::Building building = wall_of(material);
  PictureRenderer renderer(building, 0, 320, 240);
  ViewOptions without;
  without.shown.walls = false;
  const Snapshot snapshot = undeformed(building);
  return between(renderer.draw(snapshot, camera), renderer.draw(snapshot, camera, without));
}

}  // namespace

TEST_CASE("what is behind a pane of glass is seen through it, and a glancing look sees the sky in it") {
  const Camera straight = eye_at({3, -3, 1.6}), glancing = eye_at({-8, -0.6, 1.6});
  const Difference concrete = change_by("concrete", straight), glass = change_by("glass", straight);
  CHECK(concrete.share > 0.2);
  // A fifth of the light comes from the pane: 0.14 that its faces mirror, and little of its own.
  CHECK(glass.share > 0.2);
  CHECK(glass.mean < 0.35 * concrete.mean);
  const Difference mirroring = change_by("glass", glancing);
  CHECK(mirroring.mean > 2 * glass.mean);
}

TEST_CASE("glass casts no shadow") {
  // From behind and above: the sun comes from the side of -y, so the shadow lies before the eye, next to the wall.
  const Camera above = eye_at({3, 3, 16});
  const Difference concrete = change_by("concrete", above), glass = change_by("glass", above);
  CHECK(concrete.share > 0.03);
  CHECK(glass.share < 0.4 * concrete.share);
}

TEST_CASE("glass that is hit breaks into shards of glass, which are seen through") {
  Scene scene = open_scene("wall_hit");
  auto building = std::make_shared<structure::Building>(*scene.building);
  for (structure::Material& one : building->materials) one.name = "glass";
  scene.building = building;
  Session session(scene.building, scene.scenario);
  for (int i = 0; i < 60; ++i) session.step();
  const auto last = session.snapshot();
  PictureRenderer renderer(*scene.building, 0, 320, 240);
  const Camera camera = eye_at({3, 9, 2});
  ViewOptions shown, hidden;
  shown.dust = hidden.dust = false;
  hidden.debris = hidden.shown.walls = false;
  const Difference glass = between(renderer.draw(*last, camera, shown), renderer.draw(*last, camera, hidden));
  std::size_t shards = 0;
  (void)renderer.draw(*last, camera, shown);
  for (const auto& batch : renderer.scene().chunks())
    for (const RigidInstance& one : batch.instances) shards += one.colour >> 24U == static_cast<Rgba>(Look::glass);
  CHECK(shards > 3);
  CHECK(glass.share > 0.02);
  CHECK(glass.mean < 90);
}
