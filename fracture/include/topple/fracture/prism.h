#pragma once
// A flat piece of a panel as a solid: volume, centre, inertia, mesh. Panel axes: x and y in its plane, z across, the
// middle plane at z = 0.
#include <Eigen/Core>
#include <array>
#include <vector>

#include "topple/fracture/mesh.h"
#include "topple/fracture/polygon.h"

namespace topple::fracture {

/// What the motion of a rigid body of even density depends on.
struct MassProperties {
  double volume = 0;                                  ///< m3
  double mass = 0;                                    ///< kg
  Vec3 centre = Vec3::Zero();                         ///< m
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about the centre, panel axes, kg m2
};

/// Of a straight prism over a simple polygon, by the closed form of the polygon's moments.
[[nodiscard]] MassProperties prism_properties(const Polygon& outline, double thickness, double density);

/// The closed mesh of a prism whose faces consist of the given triangles (corners of `outline`, counter-clockwise).
/// Texture coordinates are the position in the panel, m: (x, y) on the faces, on the sides the coordinate along the
/// side's direction and z. They do not depend on the piece, so that a picture on the panel stays where it was.
[[nodiscard]] Mesh prism_mesh(const Polygon& outline, const std::vector<std::array<int, 3>>& face, double thickness);

}  // namespace topple::fracture
