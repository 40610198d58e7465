#pragma once
// The mesh of what remains of a panel, changed only where the triangulation changed.
#include <array>
#include <vector>

#include "half_edges.h"
#include "topple/fracture/mesh.h"

namespace topple::fracture {

class PanelMesh {
 public:
  explicit PanelMesh(double thickness) : thickness_(thickness) {}
  /// Makes the faces of the named triangles anew, and the sides around them. `intact`: the label of what remains.
  void update(const HalfEdges& triangulation, const std::vector<int>& triangles, int intact);
  [[nodiscard]] const Mesh& mesh() const { return mesh_; }

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [thickness, mesh, faces, owners, sides, pairs, free_sides] = *this;
    auto& [positions, normals, texture, triangles] = mesh;
    archive(positions, normals, texture, triangles, faces, owners, sides, pairs, free_sides);
  }

 private:
  static constexpr int none = -1;
  /// Two faces and two for each of three sides.
  static constexpr std::size_t kFaces = 8;
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }

  void remove(int triangle);
  void add(const HalfEdges& triangulation, int triangle, int intact);
  void add_face(int triangle, std::size_t face, const std::array<int, 3>& corners);
  int corner_pair(const HalfEdges& triangulation, int vertex);
  int side_vertices();
  int new_vertices(std::size_t count);

  double thickness_;
  Mesh mesh_;
  std::vector<std::array<int, kFaces>> faces_;  ///< of each triangle: its faces' places in the mesh
  std::vector<std::array<int, 2>> owners_;      ///< of each face of the mesh: triangle and which of its faces
  std::vector<std::array<int, 3>> sides_;       ///< of each triangle: first vertex of its sides
  std::vector<int> pairs_;                      ///< of each vertex: the lower of its two mesh vertices
  std::vector<int> free_sides_;
};

}  // namespace topple::fracture
