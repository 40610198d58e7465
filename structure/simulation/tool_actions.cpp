#include "simulation/tool_actions.h"

#include <algorithm>

#include "simulation/step_clock.h"

namespace topple::structure {

ToolActions::ToolActions(Scene& the_scene, EventLog& the_log, RunningSums& the_sums, Debris& the_debris)
    : scene_(the_scene),
      log_(the_log),
      sums_(the_sums),
      debris_(the_debris),
      stiffness_factors_(the_scene.building.members.size(), 1.0) {}

void ToolActions::use() {
  for (; next_event_ < scene_.scenario.events.size() &&
         step_of(scene_.scenario.events[next_event_].at, scene_.scenario.step) <= scene_.step;
       ++next_event_)
    utilisation_at(scene_.scenario.events[next_event_].at, scene_.scenario.events[next_event_].tool);
  for (const Tool& tool : std::exchange(asked_, {})) utilisation_at(scene_.time(), tool);
  use_stages();
}

void ToolActions::utilisation_at(double instant, const Tool& tool) {
  used_at_ = instant;
  std::visit([&](const auto& one) { use(one); }, tool);
}

void ToolActions::use(const Projectile& projectile) {
  launch("projectile", projectile.from, projectile.mass, projectile.radius, projectile.velocity);
}

collision::BodyId ToolActions::launch(const std::string& kind, const Vec3& from, double mass, double radius,
                                      const Vec3& velocity) {
  Body sphere;
  sphere.name = kind + " " + std::to_string(++launched_[kind]);
  sphere.rest = sphere_mass(from, mass, radius);
  sphere.radius = radius;
  sphere.volume = 4.0 / 3.0 * M_PI * radius * radius * radius;
  sphere.bounds.add(Vec3::Constant(-radius));
  sphere.bounds.add(Vec3::Constant(radius));
  sums_.body_work_put_in += mass * velocity.squaredNorm() / 2;
  SimulationEvent& event = log_.record(SimulationEvent::Kind::tool, kind);
  event.mass = mass;
  event.position = from;
  return debris_.add(std::move(sphere), velocity, Vec3::Zero(), Vec3::Zero());
}

void ToolActions::use(const WreckingBall& ball) {
  const collision::BodyId id = launch("wrecking ball", ball.from, ball.mass, ball.radius, Vec3::Zero());
  debris_.cables[id.value] = {scene_.world->add_cable({id, ball.anchor, ball.cable}), ball.anchor};
}

void ToolActions::use(const CutTool& cut) {
  log_.record(SimulationEvent::Kind::tool, "cut");
  for (const JointId joint : cut.joints)
    if (scene_.frame->intact(joint)) scene_.frame->break_joint(joint, BreakCause::tool);
}

void ToolActions::use(const RemoveTool& remove) {
  log_.record(SimulationEvent::Kind::tool, "remove");
  for (const MemberId member : remove.members) {
    if (!scene_.frame->stands(member)) continue;
    scene_.frame->remove(member);
    debris_.lose(Part(member));
    debris_.stop_standing(Part(member));
  }
  for (const PanelId panel : remove.panels) {
    if (!scene_.frame->stands(panel)) continue;
    scene_.frame->remove(panel);
    debris_.lose(Part(panel));
    debris_.stop_standing(Part(panel));
  }
  for (const NodeId support : remove.supports) scene_.frame->remove_support(support);
}

void ToolActions::use(const ChargeTool& charge) {
  log_.record(SimulationEvent::Kind::tool, "charge").position = charge.centre;
  for (std::size_t i = 0; i < scene_.building.joints.size(); ++i) {
    const JointId joint(i);
    if (!scene_.building[joint].capacity.breakable || !scene_.frame->intact(joint)) continue;
    const double distance = (scene_.joint_position(joint) - charge.centre).norm();
    if (distance > charge.radius) continue;
    const double factor =
        charge.strength_at_centre + (charge.strength_at_radius - charge.strength_at_centre) * distance / charge.radius;
    weaken(joint, factor);
  }
}

void ToolActions::use(const GravityTool& tool) {
  log_.record(SimulationEvent::Kind::tool, "gravity");
  const VelocityReading old = scene_.reading();
  scene_.gravity = tool.gravity;
  scene_.frame->set_gravity(scene_.gravity);
  scene_.world->set_gravity(scene_.gravity);
  for (auto& [id, one] : debris_.bodies) {  // the true velocity stays
    collision::BodyState state = scene_.world->state(one.id);
    if (!state.asleep) state.velocity = scene_.reading().to_world(old.true_velocity(state.velocity));
    state.asleep = false;
    scene_.world->set_state(one.id, state);
    scene_.world->wake(one.id);
  }
}

void ToolActions::use(const LoadTool& load) {
  log_.record(SimulationEvent::Kind::tool, "load");
  for (const NodeLoad& one : load.nodes)
    if (scene_.frame->stands(one.node)) scene_.frame->add_load(one.node, one.load);
}

double ToolActions::next_instant() const {
  double next = next_event_ == scene_.scenario.events.size() ? unlimited : scene_.scenario.events[next_event_].at;
  for (const Weakening& weakening : weakenings_) next = std::min(next, weakening.next());
  return next;
}

}  // namespace topple::structure
