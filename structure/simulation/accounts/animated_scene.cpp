#include "topple/structure/animated_scene.h"

#include <cmath>

namespace topple::structure {

namespace {

/// What stays is keyed where it begins and where it ends.
template <class Value>
void add_key(std::vector<std::pair<int, Value>>& keys, int frame, const Value& now) {
  if (keys.empty()) {
    keys.emplace_back(frame, now);
    return;
  }
  const auto last = keys.back();
  if (last.second == now) return;
  if (last.first < frame - 1) keys.emplace_back(frame - 1, last.second);
  keys.emplace_back(frame, now);
}

}  // namespace

void AnimatedNode::pose(int frame, const AnimatedPose& now) { add_key(poses, frame, now); }

void AnimatedNode::bend(int frame, const BendWeights& now) {
  constexpr BendWeights straight{};
  if (bends.empty() && now == straight) return;
  if (bends.empty() && frame > 0) bends.emplace_back(0, straight);
  add_key(bends, frame, now);
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

}  // namespace

SceneMesh box_mesh(const Vec3& half, int material, int segments) {
  SceneMesh mesh;
  mesh.material = material;
  // Its corners at a place along x, round it counter-clockwise seen from +x.
  const auto round = [&](int place) {
    const double x = half.x() * (2.0 * place / segments - 1);
    return std::array<Vec3, 4>{Vec3(x, -half.y(), -half.z()), Vec3(x, half.y(), -half.z()), Vec3(x, half.y(), half.z()),
                               Vec3(x, -half.y(), half.z())};
  };
  const auto first = round(0), last = round(segments);
  add_face(mesh, {first[3], first[2], first[1], first[0]});
  add_face(mesh, last);
  for (int k = 0; k < segments; ++k) {
    const auto here = round(k), there = round(k + 1);
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t j = (i + 1) % 4;
      add_face(mesh, {here[i], here[j], there[j], there[i]});
    }
  }
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
