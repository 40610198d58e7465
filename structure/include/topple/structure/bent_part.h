#pragma once
// Members and panels bent, in files that other programs play: a rigid pose, and weights of a few ways of bending that
// all parts of one mesh share (what glTF calls morph targets). Where a member's axis runs is MemberShape's cubic and
// bulge; sections turn with it, to first order in the turns against the line between its ends.
#include <array>
#include <span>
#include <vector>

#include "topple/structure/animated_scene.h"
#include "topple/structure/shape_watcher.h"

namespace topple::structure {

/// How a part is placed and bent.
struct BentPart {
  AnimatedPose pose;   ///< of a member about its middle, in its axes; of a panel about its centre, in the building's
  BendWeights bend{};  ///< of member_bends() or panel_bends()
  /// Equal to the bit.
  bool operator==(const BentPart& other) const { return pose == other.pose && bend == other.bend; }
};

/// So far may a part be from where it is drawn, m: by half of this its place, by half its bend. Of a building of 20 m
/// on 720 pixels it is a third of one.
inline constexpr double drawn_tolerance = 0.01;

/// In the undeformed building's axes: a body's motion comes on top.
[[nodiscard]] BentPart bent_member(const Building& building, MemberId member, const MemberShape& shape);
/// `moved`: how far its corners have, m.
[[nodiscard]] BentPart bent_panel(const Building& building, PanelId panel, const std::array<Vec3, 4>& moved);

/// Even parts of a member's length in a mesh that bends.
inline constexpr int bent_segments = 8;

/// How far the corners of a panel that stands have moved, or had when it let go, m.
[[nodiscard]] std::array<Vec3, 4> moved_corners(const Building& building, PanelId panel, const StandingShapes& standing,
                                                const KeptShapes& parts);
/// The shape of a member that stands, or that it let go with.
[[nodiscard]] MemberShape drawn_shape(const Building& building, MemberId member, const StandingShapes& standing,
                                      const KeptShapes& parts);

/// How far the vertices of a member's mesh go by each way of bending, for a weight of 1. `positions`: in its axes,
/// about its middle, m. The ways: its ends turned about y, the first's, the second's (rad), its middle out along z (m);
/// its ends turned about z, its middle out along y; longer (m); twisted (rad).
[[nodiscard]] std::vector<std::vector<Vec3>> member_bends(double length, std::span<const Vec3> positions);
/// The same of a panel, or of what remains of one; `positions`: in the building's axes, about the mean of its corners.
/// The ways, along its two middle lines and its normal, m at the corners: warped; sheared; longer along each; wider at
/// one end than at the other along each.
[[nodiscard]] std::vector<std::vector<Vec3>> panel_bends(const Building& building, PanelId panel,
                                                         std::span<const Vec3> positions);

/// How much member_bends() add to each vertex's normal for a weight of 1, to first order: minus the transpose of the
/// gradient of how far places go, times the normal.
[[nodiscard]] std::vector<std::vector<Vec3>> member_bend_normals(double length, std::span<const Vec3> positions,
                                                                 std::span<const Vec3> normals);
/// The same of panel_bends().
[[nodiscard]] std::vector<std::vector<Vec3>> panel_bend_normals(const Building& building, PanelId panel,
                                                                std::span<const Vec3> positions,
                                                                std::span<const Vec3> normals);
/// Normals that turn by less than this, rad, are drawn alike: in light that is a two-hundredth of white at most.
inline constexpr double seen_turn = 0.01;
/// A normal with these weights of its ways, unit. `vertex`: index in each way.
[[nodiscard]] Vec3 bent_normal(const Vec3& normal, const std::vector<std::vector<Vec3>>& ways, const BendWeights& bend,
                               std::size_t vertex);
/// Some normal of a mesh is seen to turn between two bends.
[[nodiscard]] bool normals_turn(std::span<const Vec3> normals, const std::vector<std::vector<Vec3>>& ways,
                                const BendWeights& from, const BendWeights& to);

/// Follows one part along a run, by steps that are not seen: its pose, and its bend, stay the same to the bit until
/// they are off by the tolerance. So files hold few of them, and what is nearly straight is straight.
class SteadyPart {
 public:
  /// `rest`: undeformed. `size`: greatest distance of its points from its pose's place, m.
  SteadyPart(const BentPart& rest, double size, bool is_member);
  /// Where it is drawn, for where it is.
  const BentPart& at(const BentPart& now);

 private:
  BentPart last_;
  double size_;
  bool is_member_;
};
/// Undeformed.
[[nodiscard]] AnimatedPose rest_pose(const Building& building, MemberId member);
/// Undeformed.
[[nodiscard]] AnimatedPose rest_pose(const Building& building, PanelId panel);
/// From where it is undeformed.
[[nodiscard]] SteadyPart steady(const Building& building, MemberId member);
[[nodiscard]] SteadyPart steady(const Building& building, PanelId panel);

}  // namespace topple::structure
