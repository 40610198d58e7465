// What supports above the ground stand on is drawn, and only that.
#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include "app/open_scene.h"
#include "app/session.h"
#include "renderer/instances/scene_instances.h"
#include "renderer/picture_renderer.h"

namespace {

using namespace topple::viewer;
using topple::structure::NodeId;

SceneInstances instances_of(const Scene& scene) {
  return SceneInstances(*scene.building, ground_height(*scene.building, scene.scenario));
}

}  // namespace

TEST_CASE("a bridge above the ground stands on a pier below each of its bearings") {
  const Scene scene = open_scene("bridge_hit");
  REQUIRE(*scene.scenario.ground == 0);
  SceneInstances instances = instances_of(scene);
  instances.update(undeformed(*scene.building), {});
  const auto& piers = instances.piers().instances;
  REQUIRE(piers.size() == scene.building->supports.size());
  for (std::size_t i = 0; i < piers.size(); ++i) {
    const auto& at = (*scene.building)[scene.building->supports[i].node].position;
    const glm::dvec3 foot = glm::dvec3(piers[i].position) + instances.origin();
    CHECK(foot.x == Approx(at.x()));
    CHECK(foot.y == Approx(at.y()));
    CHECK(foot.z == Approx(0).margin(1e-5));  // floats of some 10 m
    // Up to the chord that lies on it, which is some decimetres deep.
    CHECK(piers[i].scale.z < at.z());
    CHECK(piers[i].scale.z > at.z() - 0.5);
  }
  ViewOptions numbers;
  numbers.colouring = Colouring::utilisation;
  instances.update(undeformed(*scene.building), numbers);
  CHECK(instances.piers().instances.empty());
}

TEST_CASE("a building on the ground has no piers, and posts that reach down need none") {
  const Scene house = open_scene("seed_building");
  CHECK(piers_of(*house.building, ground_height(*house.building, house.scenario)).empty());
  // Its posts end a metre above this ground; they go up from there.
  CHECK(piers_of(*house.building, -1).size() == house.building->supports.size());
  // A tie at the top of a post holds what the post is seen to carry.
  topple::structure::Building tied = *house.building;
  for (const auto& member : tied.members) {
    const auto &low = tied[member.nodes[0]].position, &high = tied[member.nodes[1]].position;
    if (high.z() <= low.z() || high.head<2>() != low.head<2>()) continue;
    topple::structure::NodeSupport tie = tied.supports.front();
    tie.node = member.nodes[1];
    tied.supports = {tie};
    break;
  }
  REQUIRE(tied.supports.size() == 1);
  CHECK(piers_of(tied, -1).empty());
}

TEST_CASE("a support that is taken away takes its pier along") {
  const Scene scene = open_scene("bridge_hit");
  Session session(scene.building, scene.scenario);
  SceneInstances instances = instances_of(scene);
  session.step();
  instances.update(*session.snapshot(), {});
  const std::size_t before = instances.piers().instances.size();
  session.apply(topple::structure::RemoveTool{{}, {}, {scene.building->supports.front().node}});
  session.step();
  instances.update(*session.snapshot(), {});
  CHECK(instances.piers().instances.size() == before - 1);
}

TEST_CASE("a pier is a closed box of width and height 1 on the ground") {
  const Mesh mesh = pier_mesh();
  double volume = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const glm::vec3 a = mesh.vertices[mesh.indices[i]].position, b = mesh.vertices[mesh.indices[i + 1]].position,
                    c = mesh.vertices[mesh.indices[i + 2]].position;
    volume += double{glm::dot(a, glm::cross(b, c))} / 6;
    CHECK(glm::dot(glm::cross(b - a, c - a), mesh.vertices[mesh.indices[i]].normal) > 0);
  }
  CHECK(volume == Approx(1));
  for (const Vertex& v : mesh.vertices) CHECK(v.position.z >= 0);
}
