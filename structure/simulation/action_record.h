#pragma once
// What was done to a simulation from outside, in order: all that a snapshot needs. Capacities that a host gives are
// part of it.
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "model/index_of.h"
#include "simulation/scene.h"

namespace topple::structure {

class ActionRecord {
 public:
  /// `scene` must outlive it.
  explicit ActionRecord(Scene& scene) : scene_(scene) {}

  void add(const Tool& tool) { all_.push_back({scene_.step, tool}); }
  void add(const HostContact& contact) { all_.push_back({scene_.step, contact}); }
  /// Gives joints of the building other capacities, and remembers those that they had at the start.
  void give(std::span<const std::pair<JointId, JointCapacity>> capacities);

  [[nodiscard]] const std::vector<Snapshot::Action>& all() const { return all_; }
  [[nodiscard]] Building building_at_start() const;

  /// With the capacities that the building's joints have now: the frame is to be loaded after them.
  template <class Archive>
  void serialize(Archive& archive) {
    auto& [scene, all, given] = *this;
    archive(all, given);
    for (const auto& [joint, at_start] : given) archive(scene.building.joints[index_of(joint)].capacity);
  }

 private:
  Scene& scene_;
  std::vector<Snapshot::Action> all_;
  std::map<JointId, JointCapacity> given_;  ///< of joints that were given others, as the building had them
};

/// Throws InputError where an action names parts that the building does not have: what another building would refuse by
/// a crash is refused by its name.
void require_parts(const Building& building, const Snapshot::Action& action);

}  // namespace topple::structure
