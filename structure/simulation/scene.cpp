#include "simulation/scene.h"

#include <algorithm>

#include "topple/solver/thread_pool.h"
#include "topple/structure/error.h"

namespace topple::structure {

namespace {

double ground_height(const Building& building, const Scenario& scenario) {
  if (scenario.ground) return *scenario.ground;
  double lowest = unlimited;
  for (const NodeSupport& support : building.supports) lowest = std::min(lowest, building[support.node].position.z());
  for (const EdgeSupport& support : building.edge_supports)
    for (const NodeId node : building[support.panel].nodes) lowest = std::min(lowest, building[node].position.z());
  return lowest < unlimited ? lowest : 0;
}

CombinationId combination_of(const Building& building, const Scenario& scenario) {
  if (scenario.combination) return *scenario.combination;
  if (building.combinations.size() == 1) return CombinationId(0u);
  throw InputError(scenario.file + ": combination: missing; the model has several and needs one to be named");
}

/// What moves has no factor of a sudden loss.
FailureRules rules_of(const Scenario& scenario) {
  FailureRules rules = scenario.failure;
  if (scenario.standing == StandingRule::dynamics) rules.sudden = 1;
  return rules;
}

}  // namespace

Scene::Scene(Building the_building, Scenario the_scenario, SimulationOptions the_options)
    : building(std::move(the_building)),
      scenario(std::move(the_scenario)),
      options(std::move(the_options)),
      combination(combination_of(building, scenario)),
      gravity(0, 0, -building.gravity),
      frame(std::make_unique<StandingFrame>(building, combination, rules_of(scenario), options.threads)),
      world(options.make_world ? options.make_world() : collision::make_bullet_world()),
      strength_factors(building.joints.size(), 1.0) {
  world->set_gravity(gravity);
  if (options.threads > 1) {
    const auto pool = std::make_shared<solver::ThreadPool>(options.threads);  // copies of the world have it as well
    world->set_parallel_for([pool](std::size_t count, const auto& work) { pool->run(count, work); }, pool->threads());
  }
  world->set_ground(ground_height(building, scenario), scenario.debris.friction, scenario.debris.restitution);
}

Vec3 Scene::joint_position(JointId id) const {
  const Joint& joint = building[id];
  if (joint.member.valid()) {
    const Member& member = building[joint.member];
    const auto end = static_cast<std::size_t>(joint.end);
    return building[member.nodes[end]].position + member.offsets[end];
  }
  const Panel& panel = building[joint.panel];
  return (building[panel.nodes[static_cast<std::size_t>(joint.end)]].position +
          building[panel.nodes[static_cast<std::size_t>((joint.end + 1) % 4)]].position) /
         2;
}

}  // namespace topple::structure
