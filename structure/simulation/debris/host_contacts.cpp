// Contacts of bodies that the host owns. For the length of its impact such a body is one like any other; then it leaves
// again and its change of momentum is handed back.
#include "simulation/call_checks.h"
#include "simulation/debris/debris_settings.h"
#include "simulation/simulation_state.h"

namespace topple::structure {

namespace {

Vec3 point_velocity(const HostContact& contact) {
  return contact.velocity + contact.angular_velocity.cross(contact.point - contact.centre);
}

}  // namespace

void Simulation::touch(const HostContact& contact) {
  require_contact(state_->scene.building, contact);
  state_->touches.push_back(contact);
  state_->actions.push_back({state_->scene.step, contact});
}

std::span<const HostImpulse> Simulation::host_impulses() const { return state_->host_impulses; }

void Simulation::State::strike_by_host() {
  host_impulses.clear();
  for (const HostContact& contact : std::exchange(touches, {})) {
    HostImpulse felt;
    felt.key = contact.key;
    felt.speed_in = felt.speed_out = point_velocity(contact).dot(contact.normal);
    const Part part = contact.member.valid() ? Part(contact.member) : Part(contact.panel);
    if (felt.speed_in > 0) {
      if (!part.valid())
        push_debris(contact, felt);
      else if (scene.stands(part))
        strike_by_host(contact, part, felt);
    }
    host_impulses.push_back(felt);
  }
}

void Simulation::State::strike_by_host(const HostContact& contact, Part part, HostImpulse& felt) {
  Body guest;
  guest.name = "host " + std::to_string(contact.key);
  guest.rest.mass = contact.mass;
  guest.rest.centre = contact.centre;
  guest.rest.inertia = contact.inertia;
  guest.radius = debris_settings.stand_in_radius;
  const collision::BodyId id = debris.add(std::move(guest), contact.velocity, contact.angular_velocity, Vec3::Zero());
  debris.obstacles.approach(debris.shapes.bounds(part), *scene.frame, *scene.world);

  collision::Contact touch;
  touch.body = id;
  touch.other.kind = collision::Touched::Kind::obstacle;
  touch.other.obstacle = debris.obstacles.obstacle_of(part);
  touch.point = contact.point;
  touch.normal = contact.normal;
  touch.approach_speed = felt.speed_in;
  const auto now = [&] {
    collision::BodyState state = scene.world->state(id);
    state.velocity = scene.reading().true_velocity(state.velocity);
    return state;
  };
  const Body& striking = debris.bodies.at(id.value);
  const Kinetic before = kinetic_energy(striking, scene.world->state(id), scene.reading());
  scene.sways() ? body_impacts.strike_all({touch}) : standing_impacts.strike_all({touch});
  const collision::BodyState after = now();
  const Kinetic left = kinetic_energy(striking, scene.world->state(id), scene.reading());
  sums.body_work_put_in += before.translation + before.rotation - left.translation - left.rotation;
  felt.impulse = contact.mass * (after.velocity - contact.velocity);
  felt.speed_out = (after.velocity + after.angular_velocity.cross(contact.point - contact.centre)).dot(contact.normal);
  felt.through = !scene.stands(part);
  debris.remove(id);
  struck.erase(id.value);
}

/// Two rigid bodies: the impulse that leaves them apart with the scenario's restitution (Newton's law of impact).
void Simulation::State::push_debris(const HostContact& contact, HostImpulse& felt) {
  const Body* one = debris.find(contact.body);
  if (!one) return;
  const collision::BodyState state = scene.world->state(contact.body);
  const Vec3 arm = contact.point - state.pose.position, own_arm = contact.point - contact.centre;
  const Vec3 velocity = state.asleep
                            ? Vec3(Vec3::Zero())
                            : Vec3(scene.reading().true_velocity(state.velocity) + state.angular_velocity.cross(arm));
  const double closing = felt.speed_in - velocity.dot(contact.normal);
  if (closing <= 0) return;
  const Mat3 inverse = world_inertia(*one, state.pose.orientation).inverse();
  const double debris_mass = effective_mass(one->rest.mass, inverse, arm, contact.normal);
  const double own_mass = effective_mass(contact.mass, contact.inertia.inverse(), own_arm, contact.normal);
  const double reduced = own_mass * debris_mass / (own_mass + debris_mass), e = scene.scenario.impact.restitution;
  const double size = (1 + e) * reduced * closing;
  scene.world->apply_impulse(contact.body, size * contact.normal, contact.point);
  felt.impulse = -size * contact.normal;
  felt.speed_out = felt.speed_in - size / own_mass;
  const double lost = reduced * closing * closing * (1 - e * e) / 2;
  sums.ledger.lost_in_impacts += lost;
  sums.body_work_put_in += own_mass * (felt.speed_in * felt.speed_in - felt.speed_out * felt.speed_out) / 2;
}

}  // namespace topple::structure
