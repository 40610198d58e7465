#pragma once
// Closed triangle meshes as solids: cutting by planes, connected parts, mass properties.
#include <vector>

#include "topple/fracture/mesh.h"
#include "topple/fracture/prism.h"

namespace topple::fracture {

/// A plane with a side: the normal points to what is above it.
struct Plane {
  Vec3 point = Vec3::Zero();    ///< any point of it, m
  Vec3 normal = Vec3::UnitZ();  ///< of any length but zero
};

/// Both parts closed, as the mesh was: the cut faces are capped. Either may be without triangles.
struct CutSolid {
  Mesh below;  ///< where normal . (p - point) <= 0
  Mesh above;  ///< where normal . (p - point) >= 0
};

/// Cuts a closed mesh by a plane. Both parts get the same points along the cut, bit for bit, and keep normals and
/// texture coordinates of what they have of the surface; caps have the plane's normal and, as texture coordinates,
/// metres in the plane. Vertices within `tolerance` of the plane (m) count as on it and stay where they are. The mesh
/// may be of any shape, in several parts, with holes through it; cut faces are triangulated with their holes. Throws
/// std::invalid_argument for a plane or mesh that is not finite.
[[nodiscard]] CutSolid cut(const Mesh& mesh, const Plane& plane, double tolerance = 1e-9);

/// The parts of a mesh that share no position, in order of their first triangles.
[[nodiscard]] std::vector<Mesh> connected_parts(const Mesh& mesh);

/// Of the solid inside a closed mesh: sums of tetrahedra (closed form, exact but for rounding).
[[nodiscard]] MassProperties solid_properties(const Mesh& mesh, double density);

}  // namespace topple::fracture
