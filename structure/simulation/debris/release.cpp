// Release: what lost its hold on the frame becomes rigid bodies with true mass, centre and inertia.
#include <algorithm>

#include "simulation/debris/debris_settings.h"
#include "simulation/debris/momentum.h"
#include "simulation/simulation_state.h"

namespace topple::structure {

namespace {

std::string name_of(const Building& building, const Detached& part) {
  if (!part.members.empty()) return building[part.members.front()].name;
  if (!part.panels.empty()) return building[part.panels.front()].name;
  return building[part.nodes.front()].name;
}

bool belongs(const Detached& part, Part one) {
  const auto has = [](const auto& list, auto id) { return std::find(list.begin(), list.end(), id) != list.end(); };
  return one.member.valid() ? has(part.members, one.member) : has(part.panels, one.panel);
}
}  // namespace

/// What lies where its body was dropped goes on weighing, and falls with what it lies on.
void Simulation::State::freeze(const std::vector<RestingLoads::Kept>& lying) {
  const double g = scene.gravity.norm();
  if (g == 0) return;
  for (const RestingLoads::Kept& one : lying)
    if (const double mass = one.force.dot(scene.gravity) / (g * g); mass > 0)
      frozen.push_back({one.on, point_mass(one.point, mass)});
}

/// A part too small to be a body comes down on what stands under it, and its weight stays there.
void Simulation::State::leave_weight(const MassProperties& rest) {
  const double g = scene.gravity.norm();
  if (g == 0) return;
  const Vec3 down = scene.gravity / g;
  Part under;
  double nearest = unlimited;
  for (std::size_t i = 0; i < part_count(scene.building); ++i) {
    const Part part = part_of_number(scene.building, static_cast<std::int64_t>(i));
    if (!scene.stands(part)) continue;
    const auto distance = shapes.ray(part, rest.centre, down);
    if (!distance || *distance >= nearest) continue;
    nearest = *distance;
    under = part;
  }
  if (!under.valid()) return;
  const RestingLoads::Kept weight{under, rest.mass * scene.gravity, rest.centre + nearest * down};
  resting.lay_for_good(weight, *scene.frame);
  freeze({weight});
}

void Simulation::State::parts_are_gone(std::span<const Part> parts) {
  for (const Part& part : parts) scene.timer.engine([&] { obstacles.remove(part, *scene.world); });
  for (const collision::BodyId lying : resting.drop(parts, *scene.frame))
    if (bodies.contains(lying.value)) scene.world->wake(lying);
}

void Simulation::State::release() {
  for (Detached& part : scene.frame->take_detached()) {
    // Of a panel that is broken out altogether nothing is left to leave.
    std::erase_if(part.panels, [&](PanelId panel) {
      const BrokenPanel* left = broken_panel(panel);
      return left && left->hulls().empty();
    });
    release(part);
  }
  hang_on_what_left();
  drop_loose_pieces();
  keep_limit();
}

Body Simulation::State::describe(const Detached& part) const {
  Body one;
  one.name = name_of(scene.building, part);
  one.members = part.members;
  one.panels = part.panels;
  one.nodes = part.nodes;
  one.rest = masses.of(part);
  for (const Frozen& lying : frozen)
    if (belongs(part, lying.on)) one.rest.add(lying.mass);
  for (const MemberId member : part.members) {
    one.volume += member_volume(scene.building, scene.building[member]);
    one.bounds.add(shapes.bounds(Part(member)));
  }
  for (const PanelId panel : part.panels) {
    const BrokenPanel* left = broken_panel(panel);
    one.volume += left ? left->volume() : panel_volume(scene.building, scene.building[panel]);
    one.bounds.add(shapes.bounds(Part(panel)));
  }
  if (part.members.empty() && part.panels.empty()) {
    one.radius = debris_settings.node_radius;
    one.rest = sphere_mass(one.rest.centre, one.rest.mass, debris_settings.node_radius);
    one.volume =
        4.0 / 3.0 * M_PI * debris_settings.node_radius * debris_settings.node_radius * debris_settings.node_radius;
    one.bounds.low = one.rest.centre - Vec3::Constant(debris_settings.node_radius);
    one.bounds.high = one.rest.centre + Vec3::Constant(debris_settings.node_radius);
  }
  one.bounds.low -= one.rest.centre;
  one.bounds.high -= one.rest.centre;
  return one;
}

void Simulation::State::release(const Detached& part) {
  if (part.members.empty() && part.panels.empty() && part.nodes.empty()) return;
  if (part.cut) return release_in_two(part);
  if (part.members.empty() && part.panels.empty() && masses.of(part).mass <= 0) return;  // a bare node
  Body one = describe(part);
  Vec3 displacement = Vec3::Zero();
  for (const NodeId node : part.nodes) displacement += scene.frame->displacement(node).head<3>();
  if (!part.nodes.empty()) displacement /= static_cast<double>(part.nodes.size());
  if (displacement.norm() > debris_settings.largest_start)
    displacement *= debris_settings.largest_start / displacement.norm();
  Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();
  if (part.motion) {
    displacement = part.motion->displacement;
    velocity = part.motion->momentum / one.rest.mass;
    spin = one.rest.inertia.inverse() * (part.motion->angular - one.rest.centre.cross(part.motion->momentum));
    sums.kinetic_released += (part.motion->momentum.dot(velocity) + spin.dot(one.rest.inertia * spin)) / 2;
  }
  std::vector<Part> gone(part.members.begin(), part.members.end());
  for (const PanelId panel : part.panels) gone.emplace_back(panel);
  parts_are_gone(gone);

  if (part.mechanism) log.record(SimulationEvent::Kind::mechanism, one.name).mass = one.rest.mass;
  const bool small = one.volume < scene.scenario.debris.smallest_volume;
  SimulationEvent& event =
      log.record(small ? SimulationEvent::Kind::limited : SimulationEvent::Kind::detached, one.name);
  event.members = one.members;
  event.panels = one.panels;
  event.mass = one.rest.mass;
  event.position = one.rest.centre + displacement;
  const std::int64_t nowhere = -2;
  if (small) {
    for (const MemberId member : part.members) body_of_part[static_cast<std::size_t>(member.index)] = nowhere;
    for (const PanelId panel : part.panels)
      body_of_part[static_cast<std::size_t>(part_number(scene.building, Part(panel)))] = nowhere;
    sums.ledger.removed += (one.rest.mass * velocity.squaredNorm() + spin.dot(one.rest.inertia * spin)) / 2;
    leave_weight(one.rest);
    return;
  }
  const bool breaks =
      breakable_of(one).valid() && std::any_of(release_impulses.begin(), release_impulses.end(),
                                               [&](const ReleaseImpulse& k) { return was_struck(k, one); });
  if (breaks) {
    shatter_struck(add_body(std::move(one), velocity, spin, displacement));
    return;
  }
  apply_release_impulses(one, velocity, spin);
  const std::vector<collision::BodyId> passing = breakers_of(one);
  const collision::BodyId id = add_body(std::move(one), velocity, spin, displacement);
  check_momentum(bodies.at(id.value), part.motion);
  hang_on(part.hinges, id);
  collision::Touched broken;
  broken.kind = collision::Touched::Kind::body;
  broken.body = id;
  for (const collision::BodyId by : passing) pass(by, broken);
}

/// True when an impact of this step broke this body off.
bool Simulation::State::was_struck(const ReleaseImpulse& given, const Body& one) {
  return given.part.member.valid()
             ? std::binary_search(one.members.begin(), one.members.end(), given.part.member)
             : std::find(one.panels.begin(), one.panels.end(), given.part.panel) != one.panels.end();
}

/// Bodies that go on through what they broke off.
std::vector<collision::BodyId> Simulation::State::breakers_of(const Body& one) const {
  std::vector<collision::BodyId> passing;
  for (const ReleaseImpulse& given : release_impulses)
    if (was_struck(given, one) && bodies.contains(given.by.value)) passing.push_back(given.by);
  return passing;
}

/// A part that an impact broke off takes the momentum of the share of the structure that moved with the body.
void Simulation::State::apply_release_impulses(const Body& one, Vec3& velocity, Vec3& spin) {
  for (const ReleaseImpulse& given : release_impulses) {
    if (!was_struck(given, one)) continue;
    const Vec3 r = given.point - one.rest.centre;
    const Mat3 inverse = one.rest.inertia.inverse();
    const double size = given.impulse.norm();
    if (size == 0) continue;
    const Vec3 n = given.impulse / size;
    const double mass = effective_mass(one.rest.mass, inverse, r, n);
    const Vec3 impulse = std::min(size, mass * given.speed) * n;
    velocity += impulse / one.rest.mass;
    spin += inverse * r.cross(impulse);
    sums.ledger.lost_in_impacts -= impulse.squaredNorm() / mass / 2;
  }
}

/// All the momentum that the world's body has must be what it left with, and what release impulses gave it.
void Simulation::State::check_momentum(const Body& one, const std::optional<Detached::Motion>& motion) {
  collision::BodyState state = scene.world->state(one.id);
  state.velocity = scene.reading().true_velocity(state.velocity);
  Momentum measured{state.pose.position}, given{state.pose.position};
  measured.add(one, state);
  if (motion) {
    given.add_impulse(motion->momentum, state.pose.position);
    given.add_turn(motion->angular - one.rest.centre.cross(motion->momentum));
  }
  const Mat3 inverse = one.rest.inertia.inverse();
  for (const ReleaseImpulse& given_impulse : release_impulses)
    if (was_struck(given_impulse, one)) {
      const double size = given_impulse.impulse.norm();
      if (size == 0) continue;
      const Vec3 r = given_impulse.point - one.rest.centre, n = given_impulse.impulse / size;
      const Vec3 impulse = std::min(size, effective_mass(one.rest.mass, inverse, r, n) * given_impulse.speed) * n;
      given.add_impulse(impulse, state.pose.position + r);
    }
  sums.ledger.momentum_error = std::max(sums.ledger.momentum_error, measured.error(given));
}

void Simulation::State::pass(collision::BodyId id, const collision::Touched& other) {
  scene.timer.engine([&] { scene.world->ignore_until_separated(id, other); });
}

collision::BodyId Simulation::State::add_body(Body one, const Vec3& velocity, const Vec3& spin,
                                              const Vec3& displacement) {
  collision::BodyState state;
  state.pose.position = one.rest.centre + displacement;
  state.velocity = scene.reading().to_world(velocity);
  state.angular_velocity = spin;
  return add_body(std::move(one), state);
}

/// `state` as the collision world reads it.
collision::BodyId Simulation::State::add_body(Body one, const collision::BodyState& state) {
  collision::BodyDescription description;
  if (one.radius > 0) {
    collision::ConvexPart sphere;
    sphere.kind = collision::ConvexPart::Kind::sphere;
    sphere.half_extents = Vec3::Constant(one.radius);
    description.parts = {sphere};
  }
  if (!one.hull.empty()) {
    collision::ConvexPart hull;
    hull.kind = collision::ConvexPart::Kind::hull;
    hull.points = one.hull;
    description.parts = {hull};
  }
  const auto add_shapes = [&](Part part) {
    for (collision::ConvexPart& convex : shapes.parts(part, one.rest.centre))
      description.parts.push_back(std::move(convex));
  };
  for (const MemberId member : one.members) add_shapes(Part(member));
  for (const PanelId panel : one.panels) add_shapes(Part(panel));
  description.mass = one.rest.mass;
  description.inertia = one.rest.inertia;
  description.pose = state.pose;
  description.velocity = state.velocity;
  description.angular_velocity = state.angular_velocity;
  description.friction = scene.scenario.debris.friction;
  description.restitution = scene.scenario.debris.restitution;
  one.id = scene.timer.engine([&] { return scene.world->add_body(description); });
  for (const MemberId member : one.members) body_of_part[static_cast<std::size_t>(member.index)] = one.id.value;
  for (const PanelId panel : one.panels)
    body_of_part[static_cast<std::size_t>(part_number(scene.building, Part(panel)))] = one.id.value;
  const collision::BodyId id = one.id;
  bodies.add(id.value, std::move(one));
  bodies.motion(id.value).step_start = state.pose.position;
  return id;
}

void Simulation::State::remove_body(collision::BodyId id, bool keep_weight) {
  const auto found = bodies.find(id.value);
  const Kinetic kinetic = kinetic_energy(found->second, scene.world->state(id), scene.reading());
  sums.ledger.removed += kinetic.translation + kinetic.rotation;
  for (std::int64_t& of_part : body_of_part)
    if (of_part == id.value) of_part = -2;
  freeze(resting.forget(id, *scene.frame, keep_weight));
  (void)take_off(id);
  scene.timer.engine([&] { scene.world->remove_body(id); });
  free_segments.erase(id.value);
  cables.erase(id.value);
  bodies.erase(id.value);
}

/// Above the limit of bodies, sleeping ones are dropped, the smallest first and of equals the oldest. Their weight
/// stays where it lies.
void Simulation::State::keep_limit() {
  if (!scene.scenario.debris.limit) return;
  const auto limit = static_cast<std::size_t>(std::max(0, *scene.scenario.debris.limit));
  if (bodies.size() <= limit) return;
  std::vector<std::pair<double, std::int64_t>> sleeping;
  for (const auto& [id, one] : bodies)
    if (scene.world->state(one.id).asleep) sleeping.emplace_back(one.volume, id);
  std::sort(sleeping.begin(), sleeping.end());
  for (const auto& [volume, id] : sleeping) {
    if (bodies.size() <= limit) return;
    const Body& one = bodies.at(id);
    SimulationEvent& event = log.record(SimulationEvent::Kind::limited, one.name);
    event.members = one.members;
    event.panels = one.panels;
    event.mass = one.rest.mass;
    event.position = scene.world->state(one.id).pose.position;
    remove_body({id}, true);
  }
}

}  // namespace topple::structure
