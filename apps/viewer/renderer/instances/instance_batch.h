#pragma once
// What the graphics card draws many of: members, panels and rigid shapes, by batches that share a mesh.
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "renderer/shapes/mesh.h"
#include "renderer/shapes/palette.h"

namespace topple::viewer {

/// Positions are relative to SceneInstances::origin().
struct MemberInstance {
  glm::vec3 first_end;
  glm::vec4 rotation;  ///< quaternion x, y, z, w: member axes to global
  float length;
  glm::vec3 displacement1, rotation1, displacement2, rotation2;  ///< of the two ends, global, scaled
  glm::vec3 bulge;        ///< of the middle beside that, global, scaled; the ends keep their turns
  Rgba base, end1, end2;  ///< base: with its material as alpha (looks.h), or 255
};
struct PanelInstance {
  glm::vec3 corner[4];
  float thickness;
  Rgba base, edge[4];  ///< of edges in the view of materials: cracks, by their alpha
  glm::vec3 rest[3];   ///< corners 1, 2 and 4 in the undeformed building
};
struct RigidInstance {
  glm::vec3 position;
  glm::vec4 rotation;
  glm::vec3 scale;
  Rgba colour;
  glm::vec3 rest{0};  ///< where the mesh's origin was in the undeformed building
};

/// Instances that share a mesh. The first `standing` of them change rarely.
template <class Instance>
struct InstanceBatch {
  Mesh mesh;
  std::vector<Mesh> coarse;  ///< simpler ones of the same, each coarser than the one before; none: too few to need any
  std::vector<Instance> instances;
  std::size_t standing = 0;
  std::uint64_t revision = 0;       ///< counts changes of the standing ones
  std::uint64_t mesh_revision = 0;  ///< counts changes of the mesh's vertices, whose number stays
};

}  // namespace topple::viewer
