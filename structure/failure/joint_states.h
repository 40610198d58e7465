#pragma once
// What each joint bears and how close it is to failing, in flat arrays: the static demand R, the reference R0 (the last
// state in which nothing broke), and the check at R0 + f (R - R0) after a sudden loss.
#include <algorithm>
#include <map>
#include <vector>

#include "model/index_of.h"
#include "topple/structure/building.h"
#include "topple/structure/joint_check.h"

namespace topple::structure {

class JointStates {
 public:
  JointStates(const Building& building, double sudden);

  /// Static demand as solved now.
  void set_demand(JointId joint, const Vec6& demand) {
    if (demand_[index(joint)] == demand) return;
    demand_[index(joint)] = demand;
    forget(joint);
  }
  /// Static demand that came on slowly: the reference moves along with it.
  void set_slow_demand(JointId joint, const Vec6& demand);
  /// R0 moves by `part` of the way to R.
  void move_reference(JointId joint, double part) {
    Vec6& from = reference_[index(joint)];
    from += part * (demand_[index(joint)] - from);
    forget(joint);
  }
  /// The joint transmits nothing from now on.
  void lose(JointId joint);
  /// The building's capacity of this joint is another one.
  void capacity_changed(JointId joint);
  void set_strength(JointId joint, double factor) {
    strength_[index(joint)] = factor;
    forget(joint);
  }

  [[nodiscard]] const Vec6& demand(JointId joint) const { return demand_[index(joint)]; }
  [[nodiscard]] const Vec6& reference(JointId joint) const { return reference_[index(joint)]; }
  /// Of a demand. Ductile senses count up to 1: they hold at their capacity and break by turning too far.
  [[nodiscard]] Utilisation used(JointId joint, const Vec6& demand) const;
  /// The capacity in the senses that break at once.
  [[nodiscard]] const JointCapacity& brittle_capacity(JointId joint) const;
  void remember(JointId joint, double utilisation) {
    largest_[index(joint)] = std::max(largest_[index(joint)], utilisation);
  }
  [[nodiscard]] double strength(JointId joint) const { return strength_[index(joint)]; }
  /// Of the static demand.
  [[nodiscard]] Utilisation utilisation(JointId joint) const;
  /// Of the demand that counts for breaking. Found anew only when that or the capacity changed.
  [[nodiscard]] const Utilisation& amplified(JointId joint) const;
  /// The same; remembers the largest.
  [[nodiscard]] Utilisation check(JointId joint);
  [[nodiscard]] double largest(JointId joint) const { return largest_[index(joint)]; }
  /// Nothing broke around this joint: R becomes R0. False when it was so already.
  bool accept(JointId joint) {
    if (reference_[index(joint)] == demand_[index(joint)]) return false;
    reference_[index(joint)] = demand_[index(joint)];
    forget(joint);
    return true;
  }

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [building, sudden, demand, reference, strength, largest, brittle, amplified, amplified_known] = *this;
    archive(demand, reference, strength, largest, brittle, amplified, amplified_known);
  }

 private:
  static std::size_t index(JointId joint) { return index_of(joint); }
  void forget(JointId joint) { amplified_known_[index(joint)] = 0; }

  const Building& building_;
  double sudden_;
  std::vector<Vec6> demand_, reference_;
  std::vector<double> strength_, largest_;
  std::map<JointId, JointCapacity> brittle_;  ///< of ductile joints
  mutable std::vector<Utilisation> amplified_;
  mutable std::vector<char> amplified_known_;
};

}  // namespace topple::structure
