#include "topple/structure/animated_scene.h"

#include <cmath>

namespace topple::structure {

/// A pose that stays is keyed where it begins and where it ends.
void AnimatedNode::pose(int frame, const AnimatedPose& now) {
  if (poses.empty()) {
    poses.emplace_back(frame, now);
    return;
  }
  const auto last = poses.back();
  if (last.second == now) return;
  if (last.first < frame - 1) poses.emplace_back(frame - 1, last.second);
  poses.emplace_back(frame, now);
}

void AnimatedNode::show(int frame, bool now) {
  if (visible.empty() && frame > 0) visible.emplace_back(0, false);
  if (visible.empty() || visible.back().second != now) visible.emplace_back(frame, now);
}

namespace {

/// Adds a flat quadrilateral whose corners go round counter-clockwise seen from outside.
void add_face(SceneMesh& mesh, const std::array<Vec3, 4>& corners) {
  const auto first = static_cast<int>(mesh.positions.size());
  const Vec3 normal = (corners[2] - corners[0]).cross(corners[3] - corners[1]).normalized();
  for (const Vec3& corner : corners) {
    mesh.positions.push_back(corner);
    mesh.normals.push_back(normal);
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

/// A six-sided solid between two quadrilaterals, `top` above `bottom`, both counter-clockwise seen from above.
void add_block(SceneMesh& mesh, const std::array<Vec3, 4>& bottom, const std::array<Vec3, 4>& top) {
  add_face(mesh, top);
  add_face(mesh, {bottom[3], bottom[2], bottom[1], bottom[0]});
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) % 4;
    add_face(mesh, {bottom[i], bottom[j], top[j], top[i]});
  }
}

}  // namespace

SceneMesh box_mesh(const Vec3& half, int material) {
  SceneMesh mesh;
  mesh.material = material;
  std::array<Vec3, 4> bottom, top;
  const std::array<std::array<double, 2>, 4> round{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  for (std::size_t i = 0; i < 4; ++i) {
    bottom[i] = Vec3(round[i][0] * half.x(), round[i][1] * half.y(), -half.z());
    top[i] = Vec3(round[i][0] * half.x(), round[i][1] * half.y(), half.z());
  }
  add_block(mesh, bottom, top);
  return mesh;
}

SceneMesh sphere_mesh(double radius, int material) {
  constexpr int rings = 12, sectors = 24;
  SceneMesh mesh;
  mesh.material = material;
  for (int r = 0; r <= rings; ++r)
    for (int s = 0; s <= sectors; ++s) {
      const double up = M_PI * r / rings, round = 2 * M_PI * s / sectors;
      const Vec3 out(std::sin(up) * std::cos(round), std::sin(up) * std::sin(round), std::cos(up));
      mesh.positions.push_back(radius * out);
      mesh.normals.push_back(out);
    }
  for (int r = 0; r < rings; ++r)
    for (int s = 0; s < sectors; ++s) {
      const int a = r * (sectors + 1) + s, b = a + sectors + 1;
      if (r + 1 < rings) mesh.triangles.push_back({a, b, b + 1});
      if (r > 0) mesh.triangles.push_back({a, b + 1, a + 1});
    }
  return mesh;
}

}  // namespace topple::structure
