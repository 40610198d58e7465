#pragma once
// Triangle meshes of pieces, and the audit that every mesh of this library passes.
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "topple/fracture/polygon.h"

namespace topple::fracture {

using Vec3 = Eigen::Vector3d;

/// Triangles go counter-clockwise seen from outside. Vertices are shared by triangles of one smooth face only, so that
/// each has one normal; where faces meet at an edge, vertices with equal positions lie on each other, bit for bit.
struct Mesh {
  std::vector<Vec3> positions;                ///< m
  std::vector<Vec3> normals;                  ///< unit, outwards
  std::vector<Vec2> texture;                  ///< texture coordinates
  std::vector<std::array<int, 3>> triangles;  ///< three vertices each, counter-clockwise from outside
};

/// What audit() finds wrong in a mesh.
struct MeshAudit {
  /// Edges (between positions) that are not used as often in one direction as in the other: holes, wrongly turned
  /// triangles, vertices in the middle of another triangle's edge.
  std::size_t open_edges = 0;
  /// Edges used more than once in each direction: the solid touches itself there. Allowed, and no hole.
  std::size_t touching_edges = 0;
  std::size_t degenerate_triangles = 0;  ///< lower than the smallest height allowed
  std::size_t wrong_normals = 0;         ///< a triangle's corner whose normal is not unit or not the triangle's
  double volume = 0;                     ///< m3; negative when the mesh is inside out
  double area = 0;                       ///< of the surface, m2
  /// Closed, without degenerate triangles or wrong normals, and not inside out.
  [[nodiscard]] bool sound() const {
    return open_edges == 0 && degenerate_triangles == 0 && wrong_normals == 0 && volume > 0;
  }
  /// What is wrong, in words, for messages.
  [[nodiscard]] std::string text() const;
};

/// `smooth`: normals may differ from their triangle's by up to a right angle instead of 1e-3 rad.
/// `least_height`: of a triangle over its longest edge, m.
[[nodiscard]] MeshAudit audit(const Mesh& mesh, double least_height = 1e-9, bool smooth = false);

/// The mesh without vertices that no triangle uses.
[[nodiscard]] Mesh compact(const Mesh& mesh);

}  // namespace topple::fracture
