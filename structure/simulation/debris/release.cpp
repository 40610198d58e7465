#include "simulation/debris/release.h"

#include <algorithm>

#include "simulation/debris/debris_settings.h"
#include "simulation/debris/momentum.h"
#include "simulation/debris/moved_pose.h"

namespace topple::structure {

void Release::release() {
  for (Detached& part : scene.frame->extract_detached()) {
    // Of a panel that is broken out altogether nothing is left to leave.
    std::erase_if(part.panels, [&](PanelId panel) {
      const BrokenPanel* left = panels.broken(panel);
      return left && left->hulls().empty();
    });
    release(part);
  }
  hinges.hang_on_what_left();
  standing_fracture.drop_loose_pieces();
  keep_limit();
}

/// What left in motion goes on where it was.
PartMotion Release::displacement_of(const Detached& part) const {
  PartMotion moved;
  if (part.motion) {
    moved.moved = part.motion->displacement;
    moved.turned = part.motion->turned;
    return moved;
  }
  for (const NodeId node : part.nodes) moved.moved += scene.frame->displacement(node).head<3>();
  if (!part.nodes.empty()) moved.moved /= static_cast<double>(part.nodes.size());
  if (moved.moved.norm() > debris_settings.largest_start)
    moved.moved *= debris_settings.largest_start / moved.moved.norm();
  return moved;
}

void Release::release(const Detached& part) {
  if (part.members.empty() && part.panels.empty() && part.nodes.empty()) return;
  if (part.cut) return release_in_two(part);
  if (part.members.empty() && part.panels.empty() && debris.masses.of(part).mass <= 0) return;  // a bare node
  Body one = break_up.describe(part);
  const collision::Pose pose = moved_pose(one.rest.centre, displacement_of(part));
  Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();
  const Mat3 inertia = world_inertia(one, pose.orientation);
  if (part.motion) {
    velocity = part.motion->momentum / one.rest.mass;
    spin = inertia.inverse() * (part.motion->angular - one.rest.centre.cross(part.motion->momentum));
    sums.kinetic_released += (part.motion->momentum.dot(velocity) + spin.dot(inertia * spin)) / 2;
  }
  std::vector<Part> gone(part.members.begin(), part.members.end());
  for (const PanelId panel : part.panels) gone.emplace_back(panel);
  debris.stop_standing(gone);

  if (part.mechanism) log.record(SimulationEvent::Kind::mechanism, one.name).mass = one.rest.mass;
  const bool small = one.volume < scene.scenario.debris.smallest_volume;
  SimulationEvent& event =
      log.record(small ? SimulationEvent::Kind::limited : SimulationEvent::Kind::detached, one.name);
  event.members = one.members;
  event.panels = one.panels;
  event.mass = one.rest.mass;
  event.position = pose.position;
  if (small) {
    for (const MemberId member : part.members) debris.lose(Part(member));
    for (const PanelId panel : part.panels) debris.lose(Part(panel));
    sums.ledger.removed += (one.rest.mass * velocity.squaredNorm() + spin.dot(inertia * spin)) / 2;
    debris.leave_weight(one.rest);
    return;
  }
  const bool breaks = panels.breakable_of(one).valid() && release_impulses.first_on(one) != nullptr;
  if (breaks) {
    debris_fracture.shatter_struck(debris.add(std::move(one), velocity, spin, pose));
    return;
  }
  release_impulses.apply(one, velocity, spin, sums.ledger);
  const std::vector<collision::BodyId> passing = release_impulses.breakers_of(one, debris.bodies);
  const collision::BodyId id = debris.add(std::move(one), velocity, spin, pose);
  check_momentum(debris.bodies.at(id.value), part.motion);
  hinges.hang_on(part.hinges, id);
  for (const collision::BodyId by : passing) debris.pass(by, id);
}

/// All the momentum that the world's body has must be what it left with, and what release impulses gave it.
void Release::check_momentum(const Body& one, const std::optional<Detached::Motion>& motion) {
  collision::BodyState state = scene.world->state(one.id);
  state.velocity = scene.reading().true_velocity(state.velocity);
  Momentum measured{state.pose.position}, given{state.pose.position};
  measured.add(one, state);
  if (motion) {
    given.add_impulse(motion->momentum, state.pose.position);
    given.add_turn(motion->angular - one.rest.centre.cross(motion->momentum));
  }
  release_impulses.add_to(given, one, state.pose.position);
  sums.ledger.momentum_error = std::max(sums.ledger.momentum_error, measured.error(given));
}

void Release::remove_body(collision::BodyId id, bool keep_weight) {
  const auto found = debris.bodies.find(id.value);
  const Kinetic kinetic = kinetic_energy(found->second, scene.world->state(id), scene.reading());
  sums.ledger.removed += kinetic.translation + kinetic.rotation;
  for (std::int64_t& of_part : debris.body_of_part)
    if (of_part == id.value) of_part = -2;
  debris.freeze(debris.resting.forget(id, *scene.frame, keep_weight));
  (void)hinges.unhook(id);
  scene.timer.engine([&] { scene.world->remove_body(id); });
  break_up.forget(id);
  debris.cables.erase(id.value);
  debris.bodies.erase(id.value);
}

void Release::keep_limit() {
  if (!scene.scenario.debris.limit) return;
  const auto limit = static_cast<std::size_t>(std::max(0, *scene.scenario.debris.limit));
  if (debris.bodies.size() <= limit) return;
  std::vector<std::pair<double, std::int64_t>> sleeping;
  for (const auto& [id, one] : debris.bodies)
    if (scene.world->state(one.id).asleep) sleeping.emplace_back(one.volume, id);
  std::sort(sleeping.begin(), sleeping.end());
  for (const auto& [volume, id] : sleeping) {
    if (debris.bodies.size() <= limit) return;
    const Body& one = debris.bodies.at(id);
    SimulationEvent& event = log.record(SimulationEvent::Kind::limited, one.name);
    event.members = one.members;
    event.panels = one.panels;
    event.mass = one.rest.mass;
    event.position = scene.world->state(one.id).pose.position;
    remove_body({id}, true);
  }
}

}  // namespace topple::structure
