#include "failure/joint_states.h"

#include <algorithm>

namespace topple::structure {

JointStates::JointStates(const Building& building, double sudden)
    : building_(building),
      sudden_(sudden),
      demand_(building.joints.size(), Vec6::Zero()),
      reference_(building.joints.size(), Vec6::Zero()),
      strength_(building.joints.size(), 1.0),
      largest_(building.joints.size(), 0.0),
      amplified_(building.joints.size()),
      amplified_known_(building.joints.size(), 0) {
  for (std::size_t j = 0; j < building.joints.size(); ++j) capacity_changed(JointId(j));
}

void JointStates::capacity_changed(JointId joint) {
  forget(joint);
  const JointCapacity& all = building_[joint].capacity;
  JointCapacity brittle = all;
  for (std::size_t sense = 0; sense < brittle.value.size(); ++sense)
    if (brittle.ductility[sense] > 0) brittle.value[sense] = unlimited;
  brittle_.erase(joint);
  if (brittle.value != all.value) brittle_.emplace(joint, brittle);
}

const JointCapacity& JointStates::brittle_capacity(JointId joint) const {
  const auto found = brittle_.find(joint);
  return found == brittle_.end() ? building_[joint].capacity : found->second;
}

Utilisation JointStates::used(JointId joint, const Vec6& demand) const {
  const std::size_t j = index(joint);
  const Utilisation all = structure::utilisation(building_.joints[j].capacity, demand, strength_[j]);
  const auto found = brittle_.find(joint);
  if (found == brittle_.end() || !(all.value > 1)) return all;
  const Utilisation brittle = structure::utilisation(found->second, demand, strength_[j]);
  if (brittle.value >= 1) return brittle;
  Utilisation held = all;
  held.value = 1;
  return held;
}

void JointStates::set_slow_demand(JointId joint, const Vec6& demand) {
  const std::size_t j = index(joint);
  // With equal R and R0 the two stay the same to the bit.
  reference_[j] = reference_[j] == demand_[j] ? demand : Vec6(reference_[j] + (demand - demand_[j]));
  demand_[j] = demand;
  forget(joint);
}

void JointStates::lose(JointId joint) {
  demand_[index(joint)].setZero();
  reference_[index(joint)].setZero();
  forget(joint);
}

Utilisation JointStates::utilisation(JointId joint) const { return used(joint, demand_[index(joint)]); }

const Utilisation& JointStates::amplified(JointId joint) const {
  const std::size_t j = index(joint);
  if (amplified_known_[j] != 0) return amplified_[j];
  const bool settled = sudden_ == 1.0 || reference_[j] == demand_[j];
  amplified_known_[j] = 1;
  return amplified_[j] =
             used(joint, settled ? demand_[j] : Vec6(reference_[j] + sudden_ * (demand_[j] - reference_[j])));
}

Utilisation JointStates::check(JointId joint) {
  const Utilisation now = amplified(joint);
  remember(joint, now.value);
  return now;
}

}  // namespace topple::structure
