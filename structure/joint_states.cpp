#include "joint_states.h"

#include <algorithm>

namespace topple::structure {

JointStates::JointStates(const Building& building, double sudden)
    : building_(building),
      sudden_(sudden),
      demand_(building.joints.size(), Vec6::Zero()),
      reference_(building.joints.size(), Vec6::Zero()),
      strength_(building.joints.size(), 1.0),
      largest_(building.joints.size(), 0.0) {}

void JointStates::set_slow_demand(JointId joint, const Vec6& demand) {
  const std::size_t j = index(joint);
  // With equal R and R0 the two stay the same to the bit.
  reference_[j] = reference_[j] == demand_[j] ? demand : Vec6(reference_[j] + (demand - demand_[j]));
  demand_[j] = demand;
}

void JointStates::lose(JointId joint) {
  demand_[index(joint)].setZero();
  reference_[index(joint)].setZero();
}

Utilisation JointStates::utilisation(JointId joint) const {
  const std::size_t j = index(joint);
  return structure::utilisation(building_.joints[j].capacity, demand_[j], strength_[j]);
}

Utilisation JointStates::check(JointId joint) {
  const std::size_t j = index(joint);
  const JointCapacity& capacity = building_.joints[j].capacity;
  const bool settled = sudden_ == 1.0 || reference_[j] == demand_[j];
  const Utilisation used = structure::utilisation(
      capacity, settled ? demand_[j] : Vec6(reference_[j] + sudden_ * (demand_[j] - reference_[j])), strength_[j]);
  largest_[j] = std::max(largest_[j], used.value);
  return used;
}

}  // namespace topple::structure
