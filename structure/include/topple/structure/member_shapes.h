#pragma once
// How members are bent, from the analysis: not as their nodes turn, but as their own ends do, behind hinges that
// yielded, releases and broken joints, and sagging between them under what they bear.
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "topple/structure/simulation.h"

namespace topple::structure {

/// A displacement and a turn: m and rad, global axes.
using Displacement = Eigen::Matrix<float, 6, 1>;

/// The axis runs as a cubic between its ends, and from there by 16 s^2 (1 - s)^2 `bulge` at the share s of its length:
/// exact under loads that are spread evenly.
struct MemberShape {
  std::array<Displacement, 2> ends{Displacement::Zero(), Displacement::Zero()};  ///< of its axis at its ends
  Eigen::Vector3f bulge = Eigen::Vector3f::Zero();                               ///< m, global axes
};

/// Shapes of those members whose nodes alone do not tell them.
struct MemberShapes {
  std::vector<std::int32_t> place;  ///< per member: index in `known`, or -1; empty: none is known
  std::vector<MemberShape> known;   ///< those that are
  /// Null: its nodes tell it.
  [[nodiscard]] const MemberShape* find(std::size_t member) const {
    return member < place.size() && place[member] >= 0 ? &known[static_cast<std::size_t>(place[member])] : nullptr;
  }
};

/// Buildings of more members have the shapes of those alone that yielded, hang by one joint, or are jointed by springs
/// or pins: between stiff nodes all others look straight, and reading them takes longer than a step.
inline constexpr std::size_t all_shapes_up_to = 1000;

/// Of a member that stands, by what it bears now and these displacements of its nodes.
[[nodiscard]] MemberShape member_shape(const StandingFrame& frame, const Building& building, MemberId member,
                                       std::span<const Displacement> displacements);
/// Of all that stand and have one of their own. `yielded`: per member, whether a joint of it ever did.
[[nodiscard]] std::shared_ptr<const MemberShapes> read_member_shapes(const StandingFrame& frame,
                                                                     const Building& building,
                                                                     const std::vector<bool>& yielded,
                                                                     std::span<const Displacement> displacements);
/// As its nodes alone tell it.
[[nodiscard]] MemberShape shape_of_nodes(const Building& building, MemberId member,
                                         std::span<const Displacement> displacements);

/// The rigid motion that comes nearest to displacements of points, by least squares: what is left is how they are bent.
class NearestMotion {
 public:
  /// `at`: where it was in the undeformed building.
  void add(const Eigen::Vector3d& at, const Displacement& moved);
  /// After all were added, once.
  void solve();
  /// What is left of the displacement of this point.
  [[nodiscard]] Displacement beside(const Eigen::Vector3d& at, const Displacement& moved) const;

 private:
  struct Point {
    Eigen::Vector3d at, moved, turned;
  };
  std::vector<Point> points_;
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero(), moved_ = Eigen::Vector3d::Zero(), turn_ = Eigen::Vector3d::Zero();
};

}  // namespace topple::structure
