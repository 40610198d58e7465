#pragma once
// What carries supports that lie above the ground, so that no building is seen to hang in the air. Drawn alone: nothing
// of it acts, and nothing lands on it.
#include <glm/vec3.hpp>
#include <vector>

#include "renderer/shapes/mesh.h"
#include "topple/structure/building.h"

namespace topple::viewer {

/// A square pillar.
struct Pier {
  std::size_t support = 0;  ///< index into Building::supports
  glm::dvec3 foot{0};       ///< middle of its base, on the ground; global, m
  double width = 0, height = 0;
};
/// For each support that bears downwards and lies above the ground (a height, m), unless a member goes down from
/// there, which is seen to carry it. They end below the members that lie on them.
[[nodiscard]] std::vector<Pier> piers_of(const structure::Building& building, double ground);

/// Of width and height 1, on the origin.
[[nodiscard]] Mesh pier_mesh();

}  // namespace topple::viewer
