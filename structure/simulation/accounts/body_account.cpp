#include "simulation/accounts/body_account.h"

namespace topple::structure {

void BodyAccount::start_step() {
  for (BodyMotion& one : debris_.bodies.motions()) one.step_start = scene_.world->state({one.id}).pose.position;
}

void BodyAccount::start_motion() {
  for (BodyMotion& one : debris_.bodies.motions()) one.before = scene_.world->state({one.id});
}

void BodyAccount::count_contacts() {
  contacts_.clear();
  for (const collision::Contact& contact : scene_.world->contacts()) {
    sums_.ledger.lost_in_contacts += contact.work_lost;
    if (is_recorded(contact)) contacts_.push_back(record_of(contact));
  }
  for (const auto& [id, hung] : debris_.cables)
    sums_.ledger.lost_in_contacts += scene_.world->cable_pull(hung.cable).work_lost;
}

void BodyAccount::count_bodies() {
  for (BodyMotion& one : debris_.bodies.motions()) count(one);
}

void BodyAccount::count(BodyMotion& one) {
  const collision::BodyState after = scene_.world->state({one.id});
  if (one.asleep && after.asleep) return;
  const Vec3 weight = one.mass * scene_.gravity;
  sums_.body_gravity_work += weight.dot(after.pose.position - one.step_start);
  // A body at rest is read as having no velocity at all, and does not move.
  const auto kinetic = [&](collision::BodyState state) {
    state.asleep = false;
    const Kinetic own = kinetic_energy(*one.body, state, scene_.reading());
    return own.translation + own.rotation;
  };
  collision::BodyState woken;
  woken.pose = one.before.pose;
  woken.velocity = scene_.world->velocity_when_woken({one.id});
  if (one.asleep != after.asleep) sums_.ledger.lost_in_contacts += after.asleep ? kinetic(one.before) : -kinetic(woken);
  one.asleep = after.asleep;
}

void BodyAccount::bring_ledger_up_to_date() {
  double translation = 0, rotation = 0;
  for (const auto& [id, one] : debris_.bodies) {
    const Kinetic kinetic = kinetic_energy(one, scene_.world->state(one.id), scene_.reading());
    translation += kinetic.translation;
    rotation += kinetic.rotation;
  }
  sums_.bring_up_to_date(scene_.frame->energy(), translation, rotation);
}

}  // namespace topple::structure
