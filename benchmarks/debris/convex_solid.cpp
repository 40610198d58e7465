#include "convex_solid.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace topple::bench {

namespace {

using Eigen::Matrix3d, Eigen::Vector3d;
using Faces = std::vector<std::vector<std::size_t>>;  // corners of each, anticlockwise seen from outside

/// Volume, first and second moments of the tetrahedra between the origin and the triangles of the faces.
struct Moments {
  double volume = 0;
  Vector3d first = Vector3d::Zero();
  Matrix3d second = Matrix3d::Zero();
};

Moments moments(const std::vector<Vector3d>& corners, const Faces& faces) {
  Moments sum;
  for (const auto& face : faces)
    for (std::size_t i = 2; i < face.size(); ++i) {
      Matrix3d edges;
      edges << corners[face[0]], corners[face[i - 1]], corners[face[i]];
      const double volume = edges.determinant() / 6;
      const Vector3d whole = edges.rowwise().sum();
      sum.volume += volume;
      sum.first += volume / 4 * whole;
      sum.second += volume / 20 * (edges * edges.transpose() + whole * whole.transpose());
    }
  return sum;
}

void add_direction(std::vector<Vector3d>& known, const Vector3d& along) {
  const Vector3d unit = along.normalized();
  const bool seen =
      std::any_of(known.begin(), known.end(), [&](const Vector3d& other) { return unit.cross(other).norm() < 1e-9; });
  if (!seen) known.push_back(unit);
}

ConvexSolid solid(std::vector<Vector3d> corners, const Faces& faces) {
  const Moments about_origin = moments(corners, faces);
  for (Vector3d& corner : corners) corner -= about_origin.first / about_origin.volume;
  const Moments own = moments(corners, faces);
  ConvexSolid made;
  made.volume = own.volume;
  made.inertia = own.second.trace() * Matrix3d::Identity() - own.second;
  for (const auto& face : faces) {
    add_direction(made.normals, (corners[face[1]] - corners[face[0]]).cross(corners[face[2]] - corners[face[1]]));
    for (std::size_t i = 0; i < face.size(); ++i)
      add_direction(made.edges, corners[face[(i + 1) % face.size()]] - corners[face[i]]);
  }
  for (const Vector3d& corner : corners) made.reach = std::max(made.reach, corner.norm());
  made.corners = std::move(corners);
  return made;
}

}  // namespace

ConvexSolid frustum(const std::vector<Eigen::Vector2d>& base, double thick, double taper) {
  const std::size_t count = base.size();
  std::vector<Vector3d> corners;
  for (const double share : {1.0, taper})
    for (const Eigen::Vector2d& corner : base)
      corners.emplace_back(share * corner.x(), share * corner.y(), corners.size() < count ? 0 : thick);
  Faces faces(2);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t next = (i + 1) % count;
    faces[0].push_back(count - 1 - i);
    faces[1].push_back(count + i);
    faces.push_back({i, next, count + next, count + i});
  }
  return solid(std::move(corners), faces);
}

ConvexSolid box_solid(const Eigen::Vector3d& half) {
  const double x = half.x(), y = half.y();
  ConvexSolid made = frustum({{-x, -y}, {x, -y}, {x, y}, {-x, y}}, 2 * half.z(), 1);
  made.box = true;
  made.half = half;
  return made;
}

}  // namespace topple::bench
