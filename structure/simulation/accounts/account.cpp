// Move and book: the collision world integrates what is awake; then energies, events and counters.
#include <algorithm>

#include "simulation/simulation_state.h"
#include "simulation/step_clock.h"

namespace topple::structure {

void Simulation::State::move() {
  for (BodyMotion& one : debris.bodies.motions()) one.before = scene.world->state({one.id});
  if (scene.world->awake_count() == 0) return;
  scene.timer.engine([&] { scene.world->step(scene.scenario.step); });
  watch_overlaps();
  ++sums.counters.collision_steps;
}

void Simulation::State::account() {
  account_contacts();
  hinges.pull();
  for (BodyMotion& one : debris.bodies.motions()) account_body(one);
  auto next = debris.bodies.motions().begin();  // asked for in order of id
  debris.resting.read(contact_records, debris.obstacles, scene.scenario.step, [&](collision::BodyId id) {
    while (next != debris.bodies.motions().end() && next->id < id.value) ++next;
    return next != debris.bodies.motions().end() && next->id == id.value && !scene.world->state(id).asleep;
  });
  shatter_landed();
  const std::map<PanelId, PanelImpact> impacts = impacts_on_panels();
  break_up_landed();
  crumble(impacts);
  keep_limit();  // some may have fallen asleep
  update_views();
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

/// What of a body does not change while it is there.
BodyView Simulation::State::view_of(const Body& one) const {
  BodyView view;
  view.id = one.id;
  view.name = one.name;
  view.rest_centre = one.rest.centre;
  view.mass = one.rest.mass;
  view.radius = one.radius;
  view.members = one.members;
  view.panels = one.panels;
  view.chunk = one.mesh;
  view.chunk_of = one.chunk_of;
  return view;
}

/// Both lists are in order of id; those of bodies that stay are written over.
void Simulation::State::update_views() {
  std::vector<std::int64_t> before;
  before.reserve(views.size());
  for (const BodyView& view : views) before.push_back(view.id.value);
  const std::span<const BodyMotion> motions = debris.bodies.motions();
  const auto same_id = [](std::int64_t id, const BodyMotion& one) { return id == one.id; };
  if (!std::equal(before.begin(), before.end(), motions.begin(), motions.end(), same_id)) {
    std::vector<BodyView> now;
    now.reserve(motions.size());
    auto old = views.begin();
    for (const BodyMotion& one : motions) {
      while (old != views.end() && old->id.value < one.id) ++old;
      const bool stays = old != views.end() && old->id.value == one.id;
      now.push_back(stays ? std::move(*old) : view_of(*one.body));
    }
    views = std::move(now);
  }
  if (poses.use_count() > 1) poses = std::make_shared<std::vector<double>>();  // a host holds the last ones
  poses->clear();
  poses->reserve(7 * views.size());
  for (BodyView& view : views) {
    const collision::BodyState state = scene.world->state(view.id);
    view.pose = state.pose;
    view.asleep = state.asleep;
    const Vec3& at = state.pose.position;
    const Eigen::Vector4d turn = state.pose.orientation.coeffs();
    poses->insert(poses->end(), {at.x(), at.y(), at.z(), turn[0], turn[1], turn[2], turn[3]});
    if (debris.cables.empty() && !view.cable_anchor) continue;
    const auto hung = debris.cables.find(view.id.value);
    view.cable_anchor = hung != debris.cables.end() ? std::optional(hung->second.anchor) : std::nullopt;
  }
  record_changes(before);
}

/// Both lists of bodies are in order of id.
void Simulation::State::record_changes(std::span<const std::int64_t> before) {
  auto old = before.begin();
  for (const BodyView& view : views) {
    for (; old != before.end() && *old < view.id.value; ++old) changes.gone.push_back(*old);
    if (old != before.end() && *old == view.id.value)
      ++old;
    else
      changes.made.push_back(view.id.value);
    if (!view.asleep) changes.moved.push_back(view.id.value);
  }
  for (; old != before.end(); ++old) changes.gone.push_back(*old);
}

bool Simulation::State::rests() const {
  return scene.step > 0 && scene.world->awake_count() == 0 && !scene.frame->pending() && asked.empty() &&
         touches.empty() && next_instant() == unlimited;
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
