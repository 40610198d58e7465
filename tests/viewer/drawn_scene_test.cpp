// What is drawn around a building stands bent with it, comes down in pieces, and is looked back at.
#include <catch2/catch.hpp>

#include "app/open_scene.h"
#include "app/session.h"
#include "app/show_words.h"
#include "renderer/instances/scene_instances.h"

namespace {

using namespace topple::viewer;
using topple::structure::Vec3;

/// Vertices of all pieces that are drawn, global.
std::size_t count_instances(const SceneInstances& scene) {
  std::size_t count = 0;
  for (const auto& batch : scene.drawn()) count += batch.instances.size();
  return count;
}

}  // namespace

TEST_CASE("a drawn facade stands around its building, bent with it, and comes down in pieces with the bodies") {
  const Scene scene = open_scene("seed_house_hit");
  REQUIRE(scene.drawn);
  REQUIRE(scene.drawn->size() > 1);
  Session session(scene.building, scene.scenario, scene.drawn);
  session.step();
  const auto standing = session.snapshot();
  REQUIRE(standing->drawn);
  CHECK(standing->drawn->size() == scene.drawn->size());
  SceneInstances instances(*scene.building);
  ViewOptions options;
  instances.update(*standing, options);
  CHECK(count_instances(instances) == scene.drawn->size());

  // A hundred times its displacement: the vertex goes where its bone takes it.
  options.deflection_scale = 100;
  instances.update(*standing, options);
  const DrawnPiece& piece = standing->drawn->front();
  REQUIRE(piece.bones);
  const std::size_t last = piece.mesh->positions.size() - 1;
  const Vec3 once =
      topple::structure::displacement_with(*scene.building, (*piece.bones)[last], piece.mesh->positions[last],
                                           topple::structure::bent_as(session.simulation().frame()));
  const glm::vec3& at = instances.drawn()[0].mesh.vertices[last].position;
  CHECK(once.norm() > 1e-6);
  CHECK((Vec3(at.x, at.y, at.z) - piece.mesh->positions[last] - 100 * once).norm() < 1e-4);  // floats

  options.drawn = false;
  instances.update(*standing, options);
  CHECK(count_instances(instances) == 0);
  options = {};
  ModeView mode;
  show("no drawn", options, mode);
  CHECK_FALSE(options.drawn);
  show("drawn", options, mode);
  CHECK(options.drawn);

  // After the hit pieces move as their bodies do.
  while (session.simulation().time() < 4) {
    session.step();
    (void)session.snapshot();
  }
  const auto falling = session.snapshot();
  CHECK(falling->drawn->size() > scene.drawn->size());
  instances.update(*falling, options);
  CHECK(count_instances(instances) == falling->drawn->size());
  std::size_t moving = 0;
  for (const DrawnPiece& one : *falling->drawn) moving += one.body != part_stands;
  CHECK(moving > 3);
  // The last piece that moves: where its first vertex is drawn, against the body's own pose.
  const DrawnPiece* mover = nullptr;
  for (const DrawnPiece& one : *falling->drawn)
    if (one.body != part_stands) mover = &one;
  REQUIRE(mover);
  for (const BodyPose& body : falling->bodies) {
    if (body.id != mover->body) continue;
    const Vec3 expected = body.position + body.orientation * (mover->mesh->positions.front() - body.rest_centre);
    bool found = false;
    for (const auto& batch : instances.drawn()) {
      if (batch.instances.empty() || batch.mesh.vertices.size() != mover->mesh->positions.size()) continue;
      const RigidInstance& instance = batch.instances.front();
      const Eigen::Quaternionf turn(instance.rotation.w, instance.rotation.x, instance.rotation.y, instance.rotation.z);
      const glm::vec3& p = batch.mesh.vertices.front().position;
      const glm::vec3 origin(instances.origin());
      const Eigen::Vector3f shown = turn * Eigen::Vector3f(p.x, p.y, p.z) +
                                    Eigen::Vector3f(instance.position.x, instance.position.y, instance.position.z) +
                                    Eigen::Vector3f(origin.x, origin.y, origin.z);
      found = found || (shown.cast<double>() - expected).norm() < 1e-3;
    }
    CHECK(found);
  }

  // Looking back, the facade is whole again.
  CHECK(session.recording()->at(0.5).drawn->size() == scene.drawn->size());
}
