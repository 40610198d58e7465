#pragma once
// What the sudden loss of a member does: each by an exact low-rank update of one base factor.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "topple/solver/reanalysis.h"
#include "topple/structure/building.h"
#include "topple/structure/joint_check.h"
#include "topple/structure/motion.h"

namespace topple::structure {

/// Each member is lost alone. `named` ones keep their whole state, those of `each` only what is worst.
struct LossRequest {
  std::vector<MemberId> named;  ///< told in full
  std::vector<MemberId> each;   ///< told in short
  /// f of R0 + f (R1 - R0): 2 is the peak of an undamped elastic system, 1 the static state.
  double sudden = 2;
  MotionRequest motion;  ///< each loss through time as well, where a static state is left
  /// Whether there is a loss to compute.
  [[nodiscard]] bool any() const { return !named.empty() || !each.empty(); }
};

/// The state R0 + f (R1 - R0) after a loss, before anything else breaks, under one combination. SI.
struct LossState {
  CombinationId combination;  ///< under whose loads
  /// Empty when it stands; else what moves, in words, and the motion of the nodes that take part, most first.
  std::string mechanism;
  std::vector<std::pair<NodeId, Vec6>> motion;  ///< per node, global; largest translation 1
  std::vector<MemberId> loose;                  ///< members that can move by themselves
  // What follows is there when it stands.
  JointId worst;            ///< not valid when no joint that is left has a capacity
  Utilisation utilisation;  ///< of `worst`
  /// Only for a named loss: every node, every member and breakable joint that is left.
  std::vector<Vec6> displacements;
  std::vector<std::pair<MemberId, solver::Vec12>> end_forces;  ///< what the nodes do to each, member axes
  std::vector<std::pair<JointId, Utilisation>> joints;         ///< of each that has a capacity
  std::optional<MotionResult> dynamic;                         ///< through time, where that was asked for

  /// No mechanism.
  [[nodiscard]] bool stands() const { return mechanism.empty(); }
  /// It stands, and no joint that is left is over capacity.
  [[nodiscard]] bool survives() const { return stands() && utilisation.value <= 1; }
};

/// One member's loss under all combinations.
struct MemberLoss {
  MemberId member;                ///< that is lost
  bool named = false;             ///< its states hold everything
  std::vector<LossState> states;  ///< one for each combination
};

/// What find_losses() returns.
struct LossResult {
  std::vector<MemberLoss> losses;       ///< mechanisms first, then by the worst utilisation
  solver::ReanalysisCounters counters;  ///< how the states were solved
};

/// Throws InputError for what losses do not go with: members of one sign, settlements, edges of shells that give,
/// heated membranes and shells.
[[nodiscard]] LossResult find_losses(const Building& building, const std::vector<CombinationId>& combinations,
                                     const LossRequest& request, const solver::AnalysisOptions& options);

}  // namespace topple::structure
