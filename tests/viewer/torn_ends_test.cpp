// What torn concrete looks like: closed meshes, bars where they belong, ends that are torn and those that are not.
#include "renderer/shapes/torn_ends.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>

#include "app/open_scene.h"
#include "app/session.h"
#include "renderer/instances/scene_instances.h"

namespace {

using namespace topple::viewer;

double volume(const Mesh& mesh, bool bars) {
  double sum = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    if ((mesh.vertices[mesh.indices[i]].broken > 1.5F) != bars) continue;
    const glm::dvec3 a(mesh.vertices[mesh.indices[i]].position), b(mesh.vertices[mesh.indices[i + 1]].position),
        c(mesh.vertices[mesh.indices[i + 2]].position);
    sum += glm::dot(a, glm::cross(b, c)) / 6;
  }
  return sum;
}

/// The surface of a closed body has no direction that it faces more than the other.
glm::dvec3 all_faces(const Mesh& mesh) {
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const glm::dvec3 a(mesh.vertices[mesh.indices[i]].position), b(mesh.vertices[mesh.indices[i + 1]].position),
        c(mesh.vertices[mesh.indices[i + 2]].position);
    sum += glm::cross(b - a, c - a) / 2.0;
  }
  return sum;
}

topple::structure::Section square(double side) {
  topple::structure::Section section;
  section.shape = topple::structure::Section::Shape::rectangle;
  section.width = section.depth = side;
  section.area = side * side;
  return section;
}

std::size_t ends(const SceneInstances& scene) {
  std::size_t count = 0;
  for (const auto& batch : scene.torn_ends()) count += batch.instances.size();
  return count;
}

}  // namespace

TEST_CASE("a torn end is closed, faces outwards, and is rough concrete with bars in its corners") {
  for (unsigned variant = 0; variant < torn_end_variants; ++variant) {
    const Mesh mesh = torn_end_mesh(square(0.35), variant);
    CHECK(glm::length(all_faces(mesh)) < 1e-6);
    // Between nothing and a layer of a third of the side.
    CHECK(volume(mesh, false) > 0.02 * 0.35 * 0.35 * 0.35);
    CHECK(volume(mesh, false) < 0.34 * 0.35 * 0.35 * 0.35);
    // Four bars of 20 mm (drawn with five sides), 14 to 60 cm long.
    const double area = 5 / 2.0 * std::sin(2 * M_PI / 5) * 0.01 * 0.01;
    CHECK(volume(mesh, true) > 0.9 * 4 * 0.14 * area * 0.8);  // bent tubes are thinner at the knee
    CHECK(volume(mesh, true) < 4 * 0.65 * area);
    for (const Vertex& v : mesh.vertices) {
      CHECK(glm::length(v.normal) == Approx(1).epsilon(1e-4));
      CHECK(v.position.x > -0.05F);
    }
  }
}

TEST_CASE("bars stick out of torn faces alone, no more than are asked for") {
  // A cube of 1 m, one face of which is torn.
  Mesh cube = section_mesh(square(1), 1);
  const std::size_t own = cube.vertices.size();
  for (Vertex& v : cube.vertices) v.broken = v.normal.x > 0.9F ? 1.0F : 0.0F;
  Mesh few = cube, none = cube;
  add_bars(cube, 1000);
  add_bars(few, 3);
  add_bars(none, 0);
  CHECK(none.vertices.size() == own);
  for (std::size_t i = own; i < cube.vertices.size(); ++i) {
    CHECK(cube.vertices[i].broken == bar_mark);
    CHECK(cube.vertices[i].position.x > 0.9F);
  }
  // One for each 0.04 m2: 25 of 1 m2.
  const double each = static_cast<double>(few.vertices.size() - own) / 3;
  CHECK(static_cast<double>(cube.vertices.size() - own) / each == Approx(25).margin(2));
}

TEST_CASE("ends of concrete are torn where they came off, and nowhere else or in views of numbers") {
  const Scene scene = open_scene("town_house");
  Session session(scene.building, scene.scenario);
  SceneInstances instances(*scene.building);
  session.step();
  ViewOptions options;
  instances.update(*session.snapshot(), options);
  CHECK(ends(instances) == 0);
  session.explode({{11, -0.5, 4.2}, 30});
  for (int i = 0; i < 150; ++i) session.step();
  const auto moment = session.snapshot();
  instances.update(*moment, options);
  std::size_t moving = 0;
  for (const int place : moment->membership->member) moving += place >= 0 ? 1 : 0;
  REQUIRE(moving > 0);
  CHECK(ends(instances) > 0);
  CHECK(ends(instances) <= 2 * moving);
  options.colouring = Colouring::joints;
  instances.update(*moment, options);
  CHECK(ends(instances) == 0);
  // Steel has none.
  const Scene steel = open_scene("seed_building");
  Session other(steel.building, steel.scenario);
  SceneInstances bare(*steel.building);
  const topple::structure::NameIndex names(*steel.building);
  other.apply(topple::structure::RemoveTool{{*names.member("P-1-1-1"), *names.member("P-1-1-2")}, {}, {}});
  for (int i = 0; i < 60; ++i) other.step();
  bare.update(*other.snapshot(), {});
  CHECK(ends(bare) == 0);
}
