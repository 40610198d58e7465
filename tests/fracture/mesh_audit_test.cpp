// The audit sees what it is there to see.
#include <catch2/catch.hpp>

#include "topple/fracture/prism.h"

using namespace topple::fracture;

namespace {
Mesh box() { return prism_mesh({Vec2(0, 0), Vec2(2, 0), Vec2(2, 1), Vec2(0, 1)}, {{0, 1, 2}, {0, 2, 3}}, 0.5); }
}  // namespace

TEST_CASE("a box is sound, with its volume and surface") {
  const MeshAudit check = audit(box());
  CHECK(check.sound());
  CHECK(check.volume == Approx(1.0).epsilon(1e-15));
  CHECK(check.area == Approx(2 * (2 + 1 + 0.5)).epsilon(1e-15));
}

TEST_CASE("a missing, a turned and a doubled triangle are seen") {
  Mesh missing = box();
  missing.triangles.pop_back();
  CHECK(audit(missing).open_edges == 3);
  Mesh turned = box();
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  CHECK(audit(turned).open_edges == 3);
  CHECK(audit(turned).wrong_normals == 3);
  Mesh twice = box();
  twice.triangles.push_back(twice.triangles[0]);
  CHECK(audit(twice).open_edges == 3);
  Mesh inside_out = box();
  for (auto& triangle : inside_out.triangles) std::swap(triangle[0], triangle[1]);
  CHECK(audit(inside_out).open_edges == 0);
  CHECK_FALSE(audit(inside_out).sound());
}

TEST_CASE("a T-junction is an open edge, a needle is degenerate, a wrong normal is told") {
  Mesh junction = box();
  // The upper face's long side is divided, the side face below it is not.
  const auto face = junction.triangles[0];
  const int middle = static_cast<int>(junction.positions.size());
  junction.positions.push_back(Vec3(1, 0, 0.25));
  junction.normals.push_back(Vec3::UnitZ());
  junction.texture.push_back(Vec2(1, 0));
  junction.triangles[0] = {face[0], middle, face[2]};
  junction.triangles.push_back({middle, face[1], face[2]});
  CHECK(audit(junction).open_edges == 3);
  CHECK(audit(junction).degenerate_triangles == 0);
  Mesh needle = box();
  needle.positions[0] = needle.positions[2];
  CHECK(audit(needle).degenerate_triangles > 0);
  Mesh wrong = box();
  wrong.normals[0] = Vec3::UnitX();
  CHECK(audit(wrong).wrong_normals > 0);
}

TEST_CASE("compacting keeps the mesh and drops what nothing uses") {
  Mesh mesh = box();
  mesh.positions.push_back(Vec3(9, 9, 9));
  mesh.normals.push_back(Vec3::UnitZ());
  mesh.texture.push_back(Vec2::Zero());
  const Mesh small = compact(mesh);
  CHECK(small.positions.size() == 24);
  CHECK(audit(small).sound());
}
