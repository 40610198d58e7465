// Move and book: the collision world integrates what is awake; then energies, events and counters.
#include <algorithm>

#include "simulation/simulation_state.h"
#include "simulation/step_clock.h"

namespace topple::structure {

void Simulation::State::move() {
  for (BodyMotion& one : debris.bodies.motions()) one.before = scene.world->state({one.id});
  const double dt = scene.scenario.step;
  const bool together = scene.frame->in_motion();
  if (scene.world->awake_count() == 0 && !together) return;
  scene.timer.engine(
      [&] { together ? scene.world->step(dt, scene.frame->substeps(), *moving_parts) : scene.world->step(dt); });
  watch_overlaps();
  ++sums.counters.collision_steps;
}

void Simulation::State::account() {
  account_contacts();
  if (scene.frame->has_detached()) release();  // at the end of its motion
  hinges.pull();
  for (BodyMotion& one : debris.bodies.motions()) account_body(one);
  auto next = debris.bodies.motions().begin();  // asked for in order of id
  debris.resting.read(contact_records, debris.obstacles, scene.scenario.step, [&](collision::BodyId id) {
    while (next != debris.bodies.motions().end() && next->id < id.value) ++next;
    return next != debris.bodies.motions().end() && next->id == id.value && !scene.world->state(id).asleep;
  });
  if (debris_fracture.shatter_landed(contact_records)) keep_limit();
  const auto impacts = debris_fracture.impacts_on_panels(contact_records);
  break_up.break_landed(contact_records);
  debris_fracture.crumble(impacts);
  keep_limit();  // some may have fallen asleep
  views.update();
}

/// The collision world measures what each contact took from the bodies, in the same reading of velocities.
void Simulation::State::account_contacts() {
  contact_records.clear();
  for (const collision::Contact& contact : scene.world->contacts()) {
    sums.ledger.lost_in_contacts += contact.work_lost;
    if (is_felt(contact)) contact_records.push_back(felt(contact));
  }
  for (const auto& [id, hung] : debris.cables)
    sums.ledger.lost_in_contacts += scene.world->cable_pull(hung.cable).work_lost;
}

void Simulation::State::account_body(BodyMotion& one) {
  const collision::BodyState after = scene.world->state({one.id});
  if (one.asleep && after.asleep) return;
  const Vec3 weight = one.mass * scene.gravity;
  sums.body_gravity_work += weight.dot(after.pose.position - one.step_start);
  if (one.asleep != after.asleep) {  // a body at rest is read as having no velocity at all, and does not move
    collision::BodyState awake = one.before;
    awake.asleep = false;
    const Kinetic kinetic = kinetic_energy(*one.body, awake, scene.reading());
    sums.ledger.lost_in_contacts += (after.asleep ? 1 : -1) * (kinetic.translation + kinetic.rotation);
    one.asleep = after.asleep;
  }
}

bool Simulation::State::rests() const {
  return scene.step > 0 && scene.world->awake_count() == 0 && !scene.frame->pending() && !tools.asked() &&
         touches.empty() && tools.next_instant() == unlimited;
}

bool Simulation::State::finished() const {
  return scene.step >= step_of(scene.scenario.duration, scene.scenario.step) || (scene.scenario.until_rest && rests());
}

void Simulation::State::record_rest_and_end() {
  const bool resting_now = rests();
  if (resting_now && !was_at_rest) log.record(SimulationEvent::Kind::at_rest, "");
  was_at_rest = resting_now;
  if (done_told || !finished()) return;
  done_told = true;
  log.record(SimulationEvent::Kind::done, "");
}

/// Brings the ledger's entries that are states, not sums, up to date.
void Simulation::State::account_now() {
  double translation = 0, rotation = 0;
  for (const auto& [id, one] : debris.bodies) {
    const Kinetic kinetic = kinetic_energy(one, scene.world->state(one.id), scene.reading());
    translation += kinetic.translation;
    rotation += kinetic.rotation;
  }
  sums.bring_up_to_date(scene.frame->energy(), translation, rotation);
}

}  // namespace topple::structure
