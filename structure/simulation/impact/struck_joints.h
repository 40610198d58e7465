#pragma once
// The joints that an impact may break: demands are linear in its forces.
#include <Eigen/Core>
#include <span>
#include <vector>

#include "topple/structure/joint_check.h"
#include "topple/structure/standing_frame.h"

namespace topple::structure {

struct StruckJoint {
  JointId joint;
  const JointCapacity* capacity = nullptr;
  double strength = 1;                            ///< factor on the capacity
  Vec6 demand = Vec6::Zero();                     ///< without the impact
  Eigen::Matrix<double, 6, Eigen::Dynamic> step;  ///< for each newton at each place
  /// Hinges turn: its demand is none that it ever bears without the impact, and may be over its capacity.
  bool with_hinges = false;
};

class StruckJoints {
 public:
  StruckJoints() = default;
  /// Those of `all` that may come to their capacity under forces up to `most`, one for each place, N. A joint's
  /// utilisation is convex, so that it is at most the sum of those of its parts: nearly all are told by that. Joints
  /// over capacity without the impact are left out: they are not its doing.
  /// Forces of the last `bound` places may have either sign.
  StruckJoints(std::vector<StruckJoint> all, const Eigen::VectorXd& most, int bound = 0);

  [[nodiscard]] bool empty() const { return joints_.empty(); }
  /// The largest utilisation under these forces: exact from 1 on, below it at least what it is.
  [[nodiscard]] double utilisation(const Eigen::VectorXd& force) const;
  /// Those that fail under these forces: the most used, and all that are within 1e-6 (relative) of it: symmetric ones
  /// differ by rounding only. In order of id.
  [[nodiscard]] std::vector<JointBreak> failing(const Eigen::VectorXd& force) const;

 private:
  std::vector<StruckJoint> joints_;
  Eigen::VectorXd now_;     ///< utilisations without the impact
  Eigen::MatrixXd slopes_;  ///< and what a newton at each place adds at most
};

}  // namespace topple::structure
