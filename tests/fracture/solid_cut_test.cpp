// Solids cut by planes: both parts closed, nothing lost, whatever the shape.
#include "topple/fracture/solid_cut.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

using namespace topple::fracture;

namespace {

Mesh box(const Vec2& lower, const Vec2& upper, double thickness) {
  return prism_mesh({lower, Vec2(upper.x(), lower.y()), upper, Vec2(lower.x(), upper.y())}, {{0, 1, 2}, {0, 2, 3}},
                    thickness);
}

/// A ring of n x m quadrilaterals around the z axis: its cut by most planes has two loops, one inside the other or
/// apart.
Mesh torus(double radius, double tube, int n, int m) {
  Mesh mesh;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const double u = 2 * std::numbers::pi * i / n, v = 2 * std::numbers::pi * j / m;
      const Vec3 out(std::cos(u), std::sin(u), 0);
      mesh.normals.push_back(std::cos(v) * out + std::sin(v) * Vec3::UnitZ());
      mesh.positions.push_back(radius * out + tube * mesh.normals.back());
      mesh.texture.emplace_back(u, v);
    }
  const auto at = [&](int i, int j) { return i % n * m + j % m; };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

void check_closed(const Mesh& mesh) {
  if (mesh.triangles.empty()) return;
  const MeshAudit found = audit(mesh, 0, true);
  INFO(found.text());
  CHECK(found.open_edges == 0);
  CHECK(found.volume > 0);
}

}  // namespace

TEST_CASE("a box cut in the middle gives two boxes with caps") {
  const CutSolid parts = cut(box(Vec2(0, 0), Vec2(4, 1), 0.5), {Vec3(1, 0, 0), Vec3(2, 0, 0)});
  CHECK(audit(parts.below).sound());
  CHECK(audit(parts.above).sound());
  CHECK(audit(parts.below).volume == Approx(0.5).epsilon(1e-14));
  CHECK(audit(parts.above).volume == Approx(1.5).epsilon(1e-14));
  CHECK(audit(parts.below).area == Approx(2 * (1 + 0.5 + 0.5)).epsilon(1e-14));  // 1 x 1 x 0.5
}

TEST_CASE("planes through faces, edges and corners, and planes that miss, lose nothing") {
  const Mesh whole = box(Vec2(0, 0), Vec2(4, 1), 0.5);
  const Vec3 normals[] = {Vec3::UnitX(), -Vec3::UnitX(), Vec3::UnitZ(), Vec3(1, 4, 0), Vec3(1, 1, 1), Vec3(1, -4, 0)};
  const Vec3 points[] = {Vec3(0, 0, 0), Vec3(4, 0, 0.25), Vec3(4, 1, -0.25), Vec3(9, 0, 0), Vec3(0, 1, 0.25)};
  for (const Vec3& normal : normals)
    for (const Vec3& point : points) {
      const CutSolid parts = cut(whole, {point, normal});
      check_closed(parts.below);
      check_closed(parts.above);
      CHECK(audit(parts.below).volume + audit(parts.above).volume == Approx(2).epsilon(1e-13));
    }
}

TEST_CASE("a ring cut across has two cut faces, cut along its axis' plane a face with a hole") {
  const Mesh ring = torus(2, 0.5, 48, 24);
  const double whole = audit(ring, 0, true).volume;
  const CutSolid across = cut(ring, {Vec3(0.01, 0, 0), Vec3::UnitX()});
  check_closed(across.below);
  check_closed(across.above);
  CHECK(audit(across.below, 0, true).volume + audit(across.above, 0, true).volume == Approx(whole).epsilon(1e-13));
  const CutSolid flat = cut(ring, {Vec3(0, 0, 0.1), Vec3::UnitZ()});
  check_closed(flat.below);
  check_closed(flat.above);
  // The flat cap is an annulus: its area by Pappus, to the chords of 48 and 24 sides.
  double cap = 0;
  for (const auto& t : flat.below.triangles) {
    const auto at = [&](std::size_t i) { return flat.below.positions[static_cast<std::size_t>(t[i])]; };
    if (flat.below.normals[static_cast<std::size_t>(t[0])] == Vec3::UnitZ() && std::abs(at(0).z() - 0.1) < 1e-9 &&
        std::abs(at(1).z() - 0.1) < 1e-9 && std::abs(at(2).z() - 0.1) < 1e-9)
      cap += (at(1) - at(0)).cross(at(2) - at(0)).norm() / 2;
  }
  CHECK(cap == Approx(2 * std::numbers::pi * 2 * 2 * std::sqrt(0.25 - 0.01)).epsilon(0.02));
}

TEST_CASE("random planes cut a solid again and again without loss") {
  std::mt19937 random(2);
  const auto number = [&] { return 2.0 * (random() % 10007) / 10007 - 1; };
  for (int k = 0; k < 12; ++k) {
    const Mesh ring = torus(2, 0.7, 20, 11);
    const double whole = audit(ring, 0, true).volume;
    std::vector<Mesh> pieces{ring};
    for (int cuts = 0; cuts < 6; ++cuts) {
      const Plane plane{Vec3(number(), number(), number() / 3), Vec3(number(), number(), number())};
      std::vector<Mesh> next;
      for (const Mesh& piece : pieces) {
        const CutSolid parts = cut(piece, plane);
        for (const Mesh* part : {&parts.below, &parts.above})
          if (!part->triangles.empty()) next.push_back(*part);
      }
      pieces = std::move(next);
    }
    double sum = 0;
    std::size_t parts = 0;
    for (const Mesh& piece : pieces) {
      check_closed(piece);
      for (const Mesh& part : connected_parts(piece)) {
        sum += solid_properties(part, 1).volume;
        ++parts;
      }
    }
    CHECK(parts >= pieces.size());
    CHECK(sum == Approx(whole).epsilon(1e-12));
  }
}

TEST_CASE("connected parts are told apart, and each has its own mass properties") {
  Mesh two = box(Vec2(0, 0), Vec2(1, 1), 0.5);
  const Mesh other = box(Vec2(3, 0), Vec2(5, 1), 0.5);
  const int shift = static_cast<int>(two.positions.size());
  two.positions.insert(two.positions.end(), other.positions.begin(), other.positions.end());
  two.normals.insert(two.normals.end(), other.normals.begin(), other.normals.end());
  two.texture.insert(two.texture.end(), other.texture.begin(), other.texture.end());
  for (const auto& t : other.triangles) two.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  const std::vector<Mesh> parts = connected_parts(two);
  REQUIRE(parts.size() == 2);
  CHECK(solid_properties(parts[0], 1000).mass == Approx(500).epsilon(1e-14));
  const MassProperties p = solid_properties(parts[1], 1000);
  const MassProperties expected = prism_properties({Vec2(3, 0), Vec2(5, 0), Vec2(5, 1), Vec2(3, 1)}, 0.5, 1000);
  CHECK(p.volume == Approx(expected.volume).epsilon(1e-14));
  CHECK((p.centre - expected.centre).norm() < 1e-14);
  CHECK((p.inertia - expected.inertia).norm() < 1e-12 * expected.inertia.norm());
}

TEST_CASE("texture and normals of the surface are kept, those of new points lie between") {
  const CutSolid parts = cut(box(Vec2(0, 0), Vec2(4, 1), 0.5), {Vec3(1.3, 0, 0), Vec3(1, 0.2, 0)});
  for (const Mesh* part : {&parts.below, &parts.above})
    for (std::size_t i = 0; i < part->positions.size(); ++i)
      if (std::abs(part->normals[i].z()) > 0.5)
        CHECK((part->texture[i] - part->positions[i].head<2>()).norm() < 1e-14);  // as prism_mesh lays it
}
