#include "topple/fracture/prism.h"

#include "side_face.h"

namespace topple::fracture {

MassProperties prism_properties(const Polygon& outline, double thickness, double density) {
  // Moments about the first corner, triangle by triangle: the integral of p p^T over a triangle 0, a, b is
  // (a a^T + b b^T + (a + b) (a + b)^T) A / 12.
  double flat = 0;
  Vec2 first = Vec2::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  for (std::size_t i = 1; i + 1 < outline.size(); ++i) {
    const Vec2 a = outline[i] - outline[0], b = outline[i + 1] - outline[0], sum = a + b;
    const double part = (a.x() * b.y() - a.y() * b.x()) / 2;
    flat += part;
    first += part * sum / 3;
    second += part / 12 * (a * a.transpose() + b * b.transpose() + sum * sum.transpose());
  }
  MassProperties result;
  result.volume = flat * thickness;
  result.mass = result.volume * density;
  const Vec2 middle = first / flat;
  const Vec2 centre = outline[0] + middle;
  result.centre = Vec3(centre.x(), centre.y(), 0);
  const Eigen::Matrix2d about = (second - flat * middle * middle.transpose()) * thickness * density;
  const double across = result.mass * thickness * thickness / 12;
  result.inertia << about(1, 1) + across, -about(0, 1), 0, -about(0, 1), about(0, 0) + across, 0, 0, 0,
      about(0, 0) + about(1, 1);
  return result;
}

Mesh prism_mesh(const Polygon& outline, const std::vector<std::array<int, 3>>& face, double thickness) {
  const std::size_t n = outline.size();
  Mesh mesh;
  mesh.positions.resize(6 * n);
  mesh.normals.resize(6 * n);
  mesh.texture.resize(6 * n);
  mesh.triangles.reserve(2 * face.size() + 2 * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t upper = 0; upper < 2; ++upper) {
      mesh.positions[2 * i + upper] = Vec3(outline[i].x(), outline[i].y(), upper ? thickness / 2 : -thickness / 2);
      mesh.normals[2 * i + upper] = Vec3(0, 0, upper ? 1 : -1);
      mesh.texture[2 * i + upper] = outline[i];
    }
  for (const auto& [a, b, c] : face) {
    mesh.triangles.push_back({2 * a + 1, 2 * b + 1, 2 * c + 1});
    mesh.triangles.push_back({2 * a, 2 * c, 2 * b});
  }
  for (std::size_t i = 0; i < n; ++i)
    for (const auto& triangle :
         write_side(mesh, static_cast<int>(2 * n + 4 * i), outline[i], outline[i + 1 < n ? i + 1 : 0], thickness))
      mesh.triangles.push_back(triangle);
  return mesh;
}

}  // namespace topple::fracture
