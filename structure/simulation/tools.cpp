// Tools: what a scenario's events or a person do to the building.
#include <algorithm>

#include "simulation/call_checks.h"
#include "simulation/simulation_state.h"
#include "simulation/step_clock.h"

namespace topple::structure {

void Simulation::set_capacities(std::span<const std::pair<JointId, JointCapacity>> capacities) {
  require_capacities(state_->building, capacities);
  state_->actions.push_back({state_->step, CapacityChange{{capacities.begin(), capacities.end()}}});
  for (const auto& [joint, capacity] : capacities) {
    JointCapacity& own = state_->building.joints[static_cast<std::size_t>(joint.index)].capacity;
    state_->given_capacities.try_emplace(joint, own);
    const JointCapacity before = std::exchange(own, capacity);
    // Hinges are made where a ductile sense has a capacity from the start; one that gets it later breaks at once.
    for (std::size_t sense = 0; sense < 7; ++sense)
      if (before.value[sense] == unlimited) own.ductility[sense] = 0;
    state_->frame->capacity_changed(joint);
  }
}

void Simulation::State::use_tools() {
  for (; next_event < scenario.events.size() && step_of(scenario.events[next_event].at, scenario.step) <= step;
       ++next_event)
    use_at(scenario.events[next_event].at, scenario.events[next_event].tool);
  for (const Tool& tool : std::exchange(asked, {})) use_at(time(), tool);
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
  body_work_put_in += mass * velocity.squaredNorm() / 2;
  SimulationEvent& event = record(SimulationEvent::Kind::tool, kind);
  event.mass = mass;
  event.position = from;
  return add_body(std::move(sphere), velocity, Vec3::Zero(), Vec3::Zero());
}

void Simulation::State::use(const WreckingBall& ball) {
  const collision::BodyId id = launch("wrecking ball", ball.from, ball.mass, ball.radius, Vec3::Zero());
  cables[id.value] = {world->add_cable({id, ball.anchor, ball.cable}), ball.anchor};
}

void Simulation::State::use(const CutTool& cut) {
  record(SimulationEvent::Kind::tool, "cut");
  for (const JointId joint : cut.joints)
    if (frame->intact(joint)) frame->break_joint(joint, BreakCause::tool);
}

void Simulation::State::use(const RemoveTool& remove) {
  record(SimulationEvent::Kind::tool, "remove");
  for (const MemberId member : remove.members) {
    if (!frame->stands(member)) continue;
    frame->remove(member);
    body_of_part[static_cast<std::size_t>(member.index)] = -2;
    part_is_gone(Part(member));
  }
  for (const PanelId panel : remove.panels) {
    if (!frame->stands(panel)) continue;
    frame->remove(panel);
    body_of_part[static_cast<std::size_t>(part_number(building, Part(panel)))] = -2;
    part_is_gone(Part(panel));
  }
  for (const NodeId support : remove.supports) frame->remove_support(support);
}

void Simulation::State::use(const ChargeTool& charge) {
  record(SimulationEvent::Kind::tool, "charge").position = charge.centre;
  for (std::size_t i = 0; i < building.joints.size(); ++i) {
    const JointId joint(i);
    if (!building[joint].capacity.breakable || !frame->intact(joint)) continue;
    const double distance = (joint_position(joint) - charge.centre).norm();
    if (distance > charge.radius) continue;
    const double factor =
        charge.strength_at_centre + (charge.strength_at_radius - charge.strength_at_centre) * distance / charge.radius;
    weaken(joint, factor);
  }
}

void Simulation::State::use(const GravityTool& tool) {
  record(SimulationEvent::Kind::tool, "gravity");
  const VelocityReading old = reading();
  gravity = tool.gravity;
  frame->set_gravity(gravity);
  world->set_gravity(gravity);
  for (auto& [id, one] : bodies) {  // the true velocity stays
    collision::BodyState state = world->state(one.id);
    if (!state.asleep) state.velocity = reading().to_world(old.true_velocity(state.velocity));
    state.asleep = false;
    world->set_state(one.id, state);
    world->wake(one.id);
  }
}

void Simulation::State::use(const LoadTool& load) {
  record(SimulationEvent::Kind::tool, "load");
  for (const NodeLoad& one : load.nodes)
    if (frame->stands(one.node)) frame->add_load(one.node, one.load);
}

}  // namespace topple::structure
