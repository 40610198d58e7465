#pragma once
// Meshes as files that other programs read.
#include <string>
#include <utility>
#include <vector>

#include "topple/fracture/mesh.h"

namespace topple::fracture {

/// The node of a mesh in a file.
struct MeshFileInfo {
  std::string name;  ///< of the node
  Vec3 origin =
      Vec3::Zero();  ///< where the node stands; positions are written relative to it, which keeps their digits
  std::vector<std::pair<std::string, double>> extras;  ///< numbers for the node, such as mass
};

/// glTF 2.0 in its binary form: one node, one mesh, 32-bit floats. Axes are written as they are; the second texture
/// coordinate runs downwards there and is written as 1 - v.
[[nodiscard]] std::string glb_text(const Mesh& mesh, const MeshFileInfo& info);
/// One of several meshes in a file: its node stands at `info.origin`, turned by a quaternion x, y, z, w.
struct PlacedMesh {
  const Mesh* mesh = nullptr;            ///< not owned; must outlive the call
  MeshFileInfo info;                     ///< its node
  Eigen::Vector4d rotation{0, 0, 0, 1};  ///< unit quaternion x, y, z, w
};
/// The same with a node for each mesh, all under one node that turns z up to glTF's y up. Positions are written as they
/// are, about the node. Meshes without triangles are left out.
[[nodiscard]] std::string glb_text(const std::vector<PlacedMesh>& meshes);
/// Wavefront OBJ: positions, texture coordinates, normals, faces; with all digits, so that reading it gives the same
/// numbers.
[[nodiscard]] std::string obj_text(const Mesh& mesh, const std::string& name);

}  // namespace topple::fracture
