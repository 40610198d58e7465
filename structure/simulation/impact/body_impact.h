#pragma once
// One impact under way between a body and what it comes upon: places, both sides, and how what stands and moves follows
// the push by the modes of its struck nodes.
#include <array>
#include <vector>

#include "simulation/debris/body.h"
#include "simulation/impact/free_segment.h"
#include "simulation/impact/rigid_mobility.h"
#include "topple/structure/standing_frame.h"

namespace topple::structure {

struct ImpactSide {
  collision::BodyId id;  ///< -1: the ground, or a part that stands
  Part standing;         ///< valid: that part
  double time = 0;       ///< of the impact, since the body's state
  RigidMotion motion;    ///< at the instant, true velocities
  collision::Pose pose;  ///< at the instant
  bool slept = false;
  std::vector<std::int64_t> tags;  ///< of the part that each place is on; -1: none of the building's
  FreeSegment::Flexibility flexibility;
  std::vector<std::pair<JointId, Vec6>> borne;  ///< by its joints without the impact
  /// Of what stands and moves.
  bool held = false;
  StandingFrame::HeldResponse response;
  std::vector<int> modes;           ///< of its nodes, that the push moves
  Eigen::VectorXd mode_compliance;  ///< theirs
  /// In the order of `flexibility.demands`: by a unit of each of those modes' forces.
  std::vector<Eigen::Matrix<double, 6, Eigen::Dynamic>> mode_demands;
  /// In the order of `flexibility.demands`: for 1 rad that each of `response.hinges` turns more, under the same forces
  /// at the places and in the modes.
  std::vector<Eigen::Matrix<double, 6, Eigen::Dynamic>> hinge_demands;
};

/// An impact under way. Side 0 is the body of the contact, side 1 what it comes upon.
struct BodyImpact {
  std::vector<ImpactPlace> places;
  std::array<ImpactSide, 2> sides;
  Eigen::MatrixXd compliance;

  [[nodiscard]] Eigen::MatrixXd mobility_of_both() const {
    return mobility(sides[0].motion, places) +
           (sides[1].held ? sides[1].response.mobility : mobility(sides[1].motion, places));
  }
  [[nodiscard]] Eigen::VectorXd closing() const {
    const Eigen::VectorXd speeds = closing_speeds(sides[0].motion, sides[1].motion, places);
    return sides[1].held ? Eigen::VectorXd(speeds - sides[1].response.speed) : speeds;
  }
  /// Of the law: places, and behind them the modes that the push moves.
  [[nodiscard]] Eigen::MatrixXd followed_mobility() const;
  [[nodiscard]] Eigen::MatrixXd followed_compliance() const;
  void follow();
  void keep(const std::vector<int>& kept);
  void give(const Eigen::VectorXd& impulses);
};

/// How far the modes of the struck nodes have moved, or how fast they move, when what is struck is another after a
/// break: `moved` is of `before`.
[[nodiscard]] Eigen::VectorXd carried_over(const ImpactSide& before, const Eigen::VectorXd& moved,
                                           const ImpactSide& now);

/// Which places give way in ways of their own, in their order: of two that are one, the first.
[[nodiscard]] std::vector<int> independent_places(const Eigen::MatrixXd& compliance);

}  // namespace topple::structure
