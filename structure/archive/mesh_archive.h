#pragma once
// Meshes as bytes (solver/archive/state_archive.h).
#include "topple/fracture/mesh.h"

namespace topple::fracture {

template <class Archive>
void serialize(Archive& archive, Mesh& mesh) {
  auto& [positions, normals, texture, triangles] = mesh;
  archive(positions, normals, texture, triangles);
}

}  // namespace topple::fracture
