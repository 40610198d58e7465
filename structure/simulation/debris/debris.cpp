#include "simulation/debris/debris.h"

#include <algorithm>
#include <cmath>

#include "model/index_of.h"

namespace topple::structure {

Debris::Debris(Scene& the_scene)
    : scene(the_scene),
      masses(scene.building, scene.combination, *scene.frame),
      shapes(scene.building),
      grid(scene.building, shapes),
      obstacles(scene.building, shapes, grid, scene.scenario.debris.friction, scene.scenario.debris.restitution,
                scene.sways()),
      body_of_part(part_count(scene.building), -1) {}

Body* Debris::find(collision::BodyId id) {
  const auto found = bodies.find(id.value);
  return found == bodies.end() ? nullptr : &found->second;
}
const Body* Debris::find(collision::BodyId id) const {
  const auto found = bodies.find(id.value);
  return found == bodies.end() ? nullptr : &found->second;
}

std::int64_t Debris::body_of(Part part) const {
  return body_of_part[static_cast<std::size_t>(part_number(scene.building, part))];
}

void Debris::remove(collision::BodyId id) {
  scene.timer.engine([&] { scene.world->remove_body(id); });
  cables.erase(id.value);
  bodies.erase(id.value);
}

void Debris::pass(collision::BodyId id, collision::BodyId other) {
  collision::Touched touched;
  touched.kind = collision::Touched::Kind::body;
  touched.body = other;
  pass(id, touched);
}

void Debris::renew_shape(Part part) {
  scene.timer.engine([&] { obstacles.renew(part, *scene.world); });
  for (const collision::BodyId lying : resting.on(part))
    if (bodies.contains(lying.value)) scene.world->wake(lying);
}

collision::BodyId Debris::add(Body one, const Vec3& velocity, const Vec3& spin, const Vec3& displacement) {
  collision::Pose pose;
  pose.position = one.rest.centre + displacement;
  return add(std::move(one), velocity, spin, pose);
}

collision::BodyId Debris::add(Body one, const Vec3& velocity, const Vec3& spin, const collision::Pose& pose) {
  collision::BodyState state;
  state.pose = pose;
  state.velocity = scene.reading().to_world(velocity);
  state.angular_velocity = spin;
  return add(std::move(one), state);
}

collision::BodyId Debris::add(Body one, const collision::BodyState& state) {
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
  for (const MemberId member : one.members) body_of_part[index_of(member)] = one.id.value;
  for (const PanelId panel : one.panels)
    body_of_part[static_cast<std::size_t>(part_number(scene.building, Part(panel)))] = one.id.value;
  const collision::BodyId id = one.id;
  bodies.add(id.value, std::move(one));
  bodies.motion(id.value).step_start = state.pose.position;
  return id;
}

void Debris::pass(collision::BodyId id, const collision::Touched& other) {
  scene.timer.engine([&] { scene.world->ignore_until_separated(id, other); });
}

collision::BodyId Debris::body_with(const ContactPlace& place) const {
  if (place.member.valid()) return {std::max<std::int64_t>(-1, body_of_part[index_of(place.member)])};
  for (const auto& [id, one] : bodies)
    if (std::find(one.nodes.begin(), one.nodes.end(), place.node) != one.nodes.end()) return {id};
  return {};
}

Mat3 Debris::rotation(collision::BodyId id) const {
  return id.value < 0 ? Mat3(Mat3::Identity()) : scene.world->state(id).pose.orientation.toRotationMatrix();
}

std::int64_t Debris::body_of(JointId joint) const {
  const Joint& own = scene.building[joint];
  const Part part = own.member.valid() ? Part(own.member) : Part(own.panel);
  return body_of_part[static_cast<std::size_t>(part_number(scene.building, part))];
}

std::string Debris::name(collision::BodyId body, std::int64_t part_tag) const {
  if (part_tag >= 0) return part_name(scene.building, part_of_number(scene.building, part_tag));
  const auto found = bodies.find(body.value);
  return found == bodies.end() ? std::string() : found->second.name;
}

void Debris::stop_standing(std::span<const Part> parts) {
  for (const Part& part : parts) scene.timer.engine([&] { obstacles.remove(part, *scene.world); });
  for (const collision::BodyId lying : resting.drop(parts, *scene.frame))
    if (bodies.contains(lying.value)) scene.world->wake(lying);
}

void Debris::freeze(const std::vector<RestingLoads::Kept>& lying) {
  const double g = scene.gravity.norm();
  if (g == 0) return;
  for (const RestingLoads::Kept& one : lying)
    if (const double mass = one.force.dot(scene.gravity) / (g * g); mass > 0)
      frozen.push_back({one.on, point_mass(one.point, mass)});
}

void Debris::leave_weight(const MassProperties& rest) {
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

}  // namespace topple::structure
