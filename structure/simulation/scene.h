#pragma once
// What a simulation is about, as all its parts see it: the building and the scenario, what stands, the collision world,
// and the step that runs.
#include <memory>
#include <vector>

#include "simulation/accounts/stage_timer.h"
#include "simulation/debris/body.h"
#include "topple/structure/simulation.h"

namespace topple::structure {

struct Scene {
  /// Throws InputError for a building that cannot stand under the scenario.
  Scene(Building the_building, Scenario the_scenario, SimulationOptions the_options);

  Building building;
  Scenario scenario;
  SimulationOptions options;
  CombinationId combination;  ///< of its loads
  Vec3 gravity;               ///< m/s2, global axes
  std::unique_ptr<StandingFrame> frame;
  std::unique_ptr<collision::World> world;
  std::vector<double> strength_factors;  ///< per joint
  std::int64_t step = 0;                 ///< number of the step that runs or was last
  StageTimer timer;

  /// At the end of the step, s.
  [[nodiscard]] double time() const { return static_cast<double>(step) * scenario.step; }
  /// What stands moves.
  [[nodiscard]] bool sways() const { return scenario.standing == StandingRule::dynamics; }
  [[nodiscard]] VelocityReading reading() const { return {gravity * scenario.step / 2}; }
  [[nodiscard]] bool stands(Part part) const {
    return part.member.valid() ? frame->stands(part.member) : frame->stands(part.panel);
  }
  /// In the undeformed building: the rigid end of a member's joint, the middle of a panel's edge.
  [[nodiscard]] Vec3 joint_position(JointId joint) const;
};

/// Frame and world write their own (StandingFrame::save_state(), World::save_state()), and of the building changes what
/// was done to it (ActionRecord). Times are this run's own.
template <class Archive>
void serialize(Archive& archive, Scene& of) {
  auto& [building, scenario, options, combination, gravity, frame, world, strength_factors, step, timer] = of;
  archive(gravity, strength_factors, step);
}

}  // namespace topple::structure
