#include "simulation/host_contacts.h"

#include <utility>

#include "simulation/debris/debris_settings.h"

namespace topple::structure {

namespace {

Vec3 point_velocity(const HostContact& contact) {
  return contact.velocity + contact.angular_velocity.cross(contact.point - contact.centre);
}

}  // namespace

void HostContacts::strike_all() {
  impulses_.clear();
  for (const HostContact& contact : std::exchange(waiting_, {})) {
    HostImpulse felt;
    felt.key = contact.key;
    felt.speed_in = felt.speed_out = point_velocity(contact).dot(contact.normal);
    const Part part = contact.member.valid() ? Part(contact.member) : Part(contact.panel);
    if (felt.speed_in > 0) {
      if (!part.valid())
        push_debris(contact, felt);
      else if (to_.scene.stands(part))
        strike(contact, part, felt);
    }
    impulses_.push_back(felt);
  }
}

void HostContacts::strike(const HostContact& contact, Part part, HostImpulse& felt) {
  Body guest;
  guest.name = "host " + std::to_string(contact.key);
  guest.rest.mass = contact.mass;
  guest.rest.centre = contact.centre;
  guest.rest.inertia = contact.inertia;
  guest.radius = debris_settings.stand_in_radius;
  const collision::BodyId id =
      to_.debris.add(std::move(guest), contact.velocity, contact.angular_velocity, Vec3::Zero());
  to_.debris.obstacles.approach(to_.debris.shapes.bounds(part), *to_.scene.frame, *to_.scene.world);

  collision::Contact touch;
  touch.body = id;
  touch.other.kind = collision::Touched::Kind::obstacle;
  touch.other.obstacle = to_.debris.obstacles.obstacle_of(part);
  touch.point = contact.point;
  touch.normal = contact.normal;
  touch.approach_speed = felt.speed_in;
  const auto now = [&] {
    collision::BodyState state = to_.scene.world->state(id);
    state.velocity = to_.scene.reading().true_velocity(state.velocity);
    return state;
  };
  const Body& striking = to_.debris.bodies.at(id.value);
  const Kinetic before = kinetic_energy(striking, to_.scene.world->state(id), to_.scene.reading());
  to_.scene.sways() ? to_.body_impacts.strike_all({touch}, to_.scene.scenario.step / to_.scene.frame->substeps())
                    : to_.standing_impacts.strike_all({touch});
  const collision::BodyState after = now();
  const Kinetic left = kinetic_energy(striking, to_.scene.world->state(id), to_.scene.reading());
  to_.sums.body_work_put_in += before.translation + before.rotation - left.translation - left.rotation;
  felt.impulse = contact.mass * (after.velocity - contact.velocity);
  felt.speed_out = (after.velocity + after.angular_velocity.cross(contact.point - contact.centre)).dot(contact.normal);
  felt.through = !to_.scene.stands(part);
  to_.debris.remove(id);
  to_.struck.erase(id.value);
}

/// Two rigid bodies: the impulse that leaves them apart with the scenario's restitution (Newton's law of impact).
void HostContacts::push_debris(const HostContact& contact, HostImpulse& felt) {
  const Body* one = to_.debris.find(contact.body);
  if (!one) return;
  const collision::BodyState state = to_.scene.world->state(contact.body);
  const Vec3 arm = contact.point - state.pose.position, own_arm = contact.point - contact.centre;
  const Vec3 velocity =
      state.asleep ? Vec3(Vec3::Zero())
                   : Vec3(to_.scene.reading().true_velocity(state.velocity) + state.angular_velocity.cross(arm));
  const double closing = felt.speed_in - velocity.dot(contact.normal);
  if (closing <= 0) return;
  const Mat3 inverse = world_inertia(*one, state.pose.orientation).inverse();
  const double debris_mass = effective_mass(one->rest.mass, inverse, arm, contact.normal);
  const double own_mass = effective_mass(contact.mass, contact.inertia.inverse(), own_arm, contact.normal);
  const double reduced = own_mass * debris_mass / (own_mass + debris_mass), e = to_.scene.scenario.impact.restitution;
  const double size = (1 + e) * reduced * closing;
  to_.scene.world->apply_impulse(contact.body, size * contact.normal, contact.point);
  felt.impulse = -size * contact.normal;
  felt.speed_out = felt.speed_in - size / own_mass;
  const double lost = reduced * closing * closing * (1 - e * e) / 2;
  to_.sums.ledger.lost_in_impacts += lost;
  to_.sums.body_work_put_in += own_mass * (felt.speed_in * felt.speed_in - felt.speed_out * felt.speed_out) / 2;
}

}  // namespace topple::structure
