#pragma once
// What each joint bears and how close it is to failing, in flat arrays: the static demand R, the reference R0 (the last
// state in which nothing broke), and the check at R0 + f (R - R0) after a sudden loss.
#include <vector>

#include "topple/structure/building.h"
#include "topple/structure/joint_check.h"

namespace topple::structure {

class JointStates {
 public:
  JointStates(const Building& building, double sudden);

  /// Static demand as solved now.
  void set_demand(JointId joint, const Vec6& demand) { demand_[index(joint)] = demand; }
  /// Static demand that came on slowly: the reference moves along with it.
  void set_slow_demand(JointId joint, const Vec6& demand);
  /// The joint transmits nothing from now on.
  void lose(JointId joint);
  void set_strength(JointId joint, double factor) { strength_[index(joint)] = factor; }

  [[nodiscard]] const Vec6& demand(JointId joint) const { return demand_[index(joint)]; }
  [[nodiscard]] double strength(JointId joint) const { return strength_[index(joint)]; }
  /// Of the static demand.
  [[nodiscard]] Utilisation utilisation(JointId joint) const;
  /// Of the demand that counts for breaking; remembers the largest.
  [[nodiscard]] Utilisation check(JointId joint);
  [[nodiscard]] double largest(JointId joint) const { return largest_[index(joint)]; }
  /// Nothing broke around this joint: R becomes R0.
  void accept(JointId joint) { reference_[index(joint)] = demand_[index(joint)]; }

 private:
  static std::size_t index(JointId joint) { return static_cast<std::size_t>(joint.index); }

  const Building& building_;
  double sudden_;
  std::vector<Vec6> demand_, reference_;
  std::vector<double> strength_, largest_;
};

}  // namespace topple::structure
