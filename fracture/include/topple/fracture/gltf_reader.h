#pragma once
// Triangle meshes of glTF 2.0 files.
#include <string>
#include <vector>

#include "topple/fracture/mesh.h"

namespace topple::fracture {

/// A mesh with the name of the glTF node that has it.
struct NamedMesh {
  std::string name;  ///< of its node
  Mesh mesh;         ///< in the scene's frame, z up
};

/// Every node of the file's scene that has a mesh of triangles, where the scene places it, turned from y up to z up.
/// Primitives of one mesh become one; normals and texture coordinates that are missing are made (flat; zero). Throws
/// std::runtime_error that says what is wrong with the file.
[[nodiscard]] std::vector<NamedMesh> read_gltf(const std::string& file);

}  // namespace topple::fracture
