#pragma once
// Local axes of members and panels, as the model format defines them.
#include <array>
#include <optional>

#include "topple/structure/building.h"

namespace topple::structure::formats {

/// Rows x, y, z of a member along `along` (not zero). `up` lies in the local x-z plane; none: global z, and global x
/// when the horizontal projection is below 1e-6 of the length. `roll` turns y and z right-handed about x. None: `up` is
/// within 1e-6 rad of the axis.
[[nodiscard]] std::optional<Mat3> member_axes(const Vec3& along, const std::optional<Vec3>& up, double roll);

/// Largest warp of a panel. Shells are meshed on the warped surface (MacNeal and Harder's twisted beam); what is one
/// element, or load alone, counts as plane.
inline constexpr double largest_warp = 0.01, largest_warp_of_shells = 0.1;

/// What a panel's four corners make.
struct PanelGeometry {
  Mat3 axes = Mat3::Identity();  ///< rows: x from node 1 to 2, y, z normal by the right-hand rule around the nodes
  double warp = 0;               ///< distance between the two diagonals over the length of the longer one
  bool convex = false;           ///< the corners go round a convex quadrilateral with an area
};
[[nodiscard]] PanelGeometry panel_geometry(const std::array<Vec3, 4>& corners);

/// Empty, or what is wrong with an opening in the panel's axes from corner 1: a polygon with an area that does not
/// cross itself and lies within the panel.
[[nodiscard]] std::string opening_fault(const std::vector<Vec2>& opening, const std::array<Vec2, 4>& outline);

}  // namespace topple::structure::formats
