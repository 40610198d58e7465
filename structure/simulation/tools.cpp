// Tools: what a scenario's events or a person do to the building.
#include <algorithm>

#include "simulation/call_checks.h"
#include "simulation/simulation_state.h"
#include "simulation/step_clock.h"

namespace topple::structure {

void Simulation::set_capacities(std::span<const std::pair<JointId, JointCapacity>> capacities) {
  require_capacities(state_->scene.building, capacities);
  state_->actions.push_back({state_->scene.step, CapacityChange{{capacities.begin(), capacities.end()}}});
  for (const auto& [joint, capacity] : capacities) {
    JointCapacity& own = state_->scene.building.joints[static_cast<std::size_t>(joint.index)].capacity;
    state_->given_capacities.try_emplace(joint, own);
    const JointCapacity before = std::exchange(own, capacity);
    // Hinges are made where a ductile sense has a capacity from the start; one that gets it later breaks at once.
    for (std::size_t sense = 0; sense < 7; ++sense)
      if (before.value[sense] == unlimited) own.ductility[sense] = 0;
    state_->scene.frame->capacity_changed(joint);
  }
}

void Simulation::State::use_tools() {
  for (; next_event < scene.scenario.events.size() &&
         step_of(scene.scenario.events[next_event].at, scene.scenario.step) <= scene.step;
       ++next_event)
    use_at(scene.scenario.events[next_event].at, scene.scenario.events[next_event].tool);
  for (const Tool& tool : std::exchange(asked, {})) use_at(scene.time(), tool);
  use_stages();
}

void Simulation::State::use_at(double instant, const Tool& tool) {
  used_at = instant;
  std::visit([&](const auto& one) { use(one); }, tool);
}

void Simulation::State::use(const Projectile& projectile) {
  launch("projectile", projectile.from, projectile.mass, projectile.radius, projectile.velocity);
}

collision::BodyId Simulation::State::launch(const std::string& kind, const Vec3& from, double mass, double radius,
                                            const Vec3& velocity) {
  Body sphere;
  sphere.name = kind + " " + std::to_string(++launched[kind]);
  sphere.rest = sphere_mass(from, mass, radius);
  sphere.radius = radius;
  sphere.volume = 4.0 / 3.0 * M_PI * radius * radius * radius;
  sphere.bounds.add(Vec3::Constant(-radius));
  sphere.bounds.add(Vec3::Constant(radius));
  sums.body_work_put_in += mass * velocity.squaredNorm() / 2;
  SimulationEvent& event = log.record(SimulationEvent::Kind::tool, kind);
  event.mass = mass;
  event.position = from;
  return debris.add(std::move(sphere), velocity, Vec3::Zero(), Vec3::Zero());
}

void Simulation::State::use(const WreckingBall& ball) {
  const collision::BodyId id = launch("wrecking ball", ball.from, ball.mass, ball.radius, Vec3::Zero());
  debris.cables[id.value] = {scene.world->add_cable({id, ball.anchor, ball.cable}), ball.anchor};
}

void Simulation::State::use(const CutTool& cut) {
  log.record(SimulationEvent::Kind::tool, "cut");
  for (const JointId joint : cut.joints)
    if (scene.frame->intact(joint)) scene.frame->break_joint(joint, BreakCause::tool);
}

void Simulation::State::use(const RemoveTool& remove) {
  log.record(SimulationEvent::Kind::tool, "remove");
  for (const MemberId member : remove.members) {
    if (!scene.frame->stands(member)) continue;
    scene.frame->remove(member);
    debris.lose(Part(member));
    debris.stop_standing(Part(member));
  }
  for (const PanelId panel : remove.panels) {
    if (!scene.frame->stands(panel)) continue;
    scene.frame->remove(panel);
    debris.lose(Part(panel));
    debris.stop_standing(Part(panel));
  }
  for (const NodeId support : remove.supports) scene.frame->remove_support(support);
}

void Simulation::State::use(const ChargeTool& charge) {
  log.record(SimulationEvent::Kind::tool, "charge").position = charge.centre;
  for (std::size_t i = 0; i < scene.building.joints.size(); ++i) {
    const JointId joint(i);
    if (!scene.building[joint].capacity.breakable || !scene.frame->intact(joint)) continue;
    const double distance = (scene.joint_position(joint) - charge.centre).norm();
    if (distance > charge.radius) continue;
    const double factor =
        charge.strength_at_centre + (charge.strength_at_radius - charge.strength_at_centre) * distance / charge.radius;
    weaken(joint, factor);
  }
}

void Simulation::State::use(const GravityTool& tool) {
  log.record(SimulationEvent::Kind::tool, "gravity");
  const VelocityReading old = scene.reading();
  scene.gravity = tool.gravity;
  scene.frame->set_gravity(scene.gravity);
  scene.world->set_gravity(scene.gravity);
  for (auto& [id, one] : debris.bodies) {  // the true velocity stays
    collision::BodyState state = scene.world->state(one.id);
    if (!state.asleep) state.velocity = scene.reading().to_world(old.true_velocity(state.velocity));
    state.asleep = false;
    scene.world->set_state(one.id, state);
    scene.world->wake(one.id);
  }
}

void Simulation::State::use(const LoadTool& load) {
  log.record(SimulationEvent::Kind::tool, "load");
  for (const NodeLoad& one : load.nodes)
    if (scene.frame->stands(one.node)) scene.frame->add_load(one.node, one.load);
}

}  // namespace topple::structure
