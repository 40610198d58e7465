#pragma once
// Ductile joints of what stands and moves, in an impact: each hinge holds its capacity while it turns, unloads as soon
// as it would turn back, and keeps the angle.
//
// Between two events all is linear. With f the forces at the places and in the modes of the law of impact (impact.h), C
// the compliance, S the moments at the hinges by unit forces, H by how much they fall for a unit of turning, and M0
// what they are without the impact, the coordinates and the moments are
//   x = C f + S' t,   M = M0 + S f - H t,
// t the plastic rotations of the impact. Hinges that hold m while they turn have t = H^-1 (M0 + S f - m): C grows by S'
// H^-1 S, the unloaded places lie S' H^-1 (M0 - m) further on, and no force and no place jumps. S stands in both lines
// by the reciprocal theorem.
// Source: plastic rotations as imposed distortions, from event to event (M. Jirasek and Z. P. Bazant, Inelastic
// Analysis of Structures, 2002).
#include <Eigen/Core>
#include <vector>

#include "simulation/impact/body_impact.h"
#include "simulation/impact/struck_joints.h"

namespace topple::structure {

class YieldingJoints {
 public:
  /// The hinges of the struck side as it is now, with what those of the same joints have turned by in this impact; none
  /// turns. Nothing unless what is struck stands and moves.
  void find_hinges(const BodyImpact& impact);
  [[nodiscard]] bool any() const { return !hinges_.empty(); }
  /// Of this joint.
  [[nodiscard]] bool has(JointId joint) const;
  /// One of them turns.
  [[nodiscard]] bool turning() const;

  // In this state.
  [[nodiscard]] Eigen::MatrixXd compliance() const;  ///< of the law of impact
  [[nodiscard]] Eigen::VectorXd unloaded() const;    ///< by how much each coordinate is further on
  /// What joints bear, in the order of the struck side's demands: without forces, and for a unit of each.
  void add_to(std::size_t joint, StruckJoint& struck) const;
  /// At 1 a hinge comes to its capacity, has turned too far, or would turn back: then see next().
  [[nodiscard]] double use(const Eigen::VectorXd& force, const Eigen::VectorXd& rate) const;
  /// The largest moment of one that does not turn, over what it holds at.
  [[nodiscard]] double largest_moment(const Eigen::VectorXd& force) const;

  /// Hinges turn as far as these forces turn them.
  void turn(const Eigen::VectorXd& force);
  /// At an event, after turn(): those that have turned too far; when there are none, others begin to turn or turn no
  /// more.
  [[nodiscard]] std::vector<JointBreak> next(const Eigen::VectorXd& force, const Eigen::VectorXd& rate);
  /// All hold.
  void hold();
  /// So many events that they go round in circles.
  [[nodiscard]] bool worn_out() const;

  /// All that turned in this impact, and what they took.
  [[nodiscard]] std::vector<StandingFrame::ImpactTurn> turns() const;
  /// What is left of the rotations with the struck nodes where they are, as substeps take them up: no more than leaves
  /// each hinge within its capacity.
  [[nodiscard]] std::vector<StandingFrame::ImpactTurn> left() const;
  /// J: what those dissipate, and their strain with the nodes held.
  [[nodiscard]] double work(const std::vector<StandingFrame::ImpactTurn>& turns) const;

 private:
  struct Hinge {
    JointId joint;
    int axis = 4;
    double capacity = 0, limit = 0, before = 0, stiffness = 0, alone = 0;
    double starts_at = 0;   ///< N m of either sign, from where on it turns
    double turned = 0;      ///< rad, in this impact
    double dissipated = 0;  ///< J
    double holds = 0;       ///< N m, while it turns; 0: it does not
    double from = 0;        ///< rad, when it began to
  };
  [[nodiscard]] std::vector<Eigen::Index> turning_now() const;
  [[nodiscard]] Eigen::VectorXd turned_now() const;
  /// Of those that turn: their rotations without forces, and for a unit of each.
  void solve();
  [[nodiscard]] Eigen::VectorXd rotations(const Eigen::VectorXd& force) const;
  [[nodiscard]] Eigen::VectorXd moments(const Eigen::VectorXd& force) const;

  std::vector<Hinge> hinges_;
  Eigen::MatrixXd elastic_;                                          ///< C
  Eigen::MatrixXd by_force_;                                         ///< S
  Eigen::MatrixXd by_turn_;                                          ///< H
  Eigen::MatrixXd held_;                                             ///< the same with all nodes held
  std::vector<Eigen::Matrix<double, 6, Eigen::Dynamic>> on_joints_;  ///< as ImpactSide::hinge_demands
  // As it is between two events: t = constant_ + slope_ f.
  Eigen::VectorXd constant_;
  Eigen::MatrixXd slope_;
  int events_ = 0;
};

}  // namespace topple::structure
