#include "body_balances.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace topple::bench {

namespace {

using collision::BodyState, collision::Contact, collision::Touched, collision::World;
using Eigen::Matrix3d, Eigen::Vector3d;

Vector3d spin_momentum(const Matrix3d& inertia, const BodyState& state) {
  const Matrix3d turn = state.pose.orientation.toRotationMatrix();
  return turn * (inertia * (turn.transpose() * state.angular_velocity));
}

/// The bodies that meet there.
bool all_asleep(const Contact& contact, const World& world) {
  return world.state(contact.body).asleep &&
         (contact.other.kind != Touched::Kind::body || world.state(contact.other.body).asleep);
}

}  // namespace

void Residuals::add(double force, double moment) {
  worst_force = std::max(worst_force, force);
  worst_moment = std::max(worst_moment, moment);
  squares_force += force * force;
  squares_moment += moment * moment;
  ++count;
}

double Residuals::rms_force() const { return count > 0 ? std::sqrt(squares_force / static_cast<double>(count)) : 0; }
double Residuals::rms_moment() const { return count > 0 ? std::sqrt(squares_moment / static_cast<double>(count)) : 0; }

void BodyBalances::begin_step(const DebrisRun& run, const World& world) {
  while (bodies_.size() < run.bodies().size()) {
    const FallingSolid& falls = scene_.falling[bodies_.size()];
    const ConvexSolid& shape = scene_.shapes[falls.shape];
    Body made;
    made.mass = falls.density * shape.volume;
    made.weight = made.mass * kDebrisGravity;
    made.reach = shape.reach;
    made.inertia = falls.density * shape.inertia;
    bodies_.push_back(made);
  }
  double motion = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    Body& body = bodies_[i];
    const BodyState state = world.state(run.bodies()[i]);
    body.was_awake = !state.asleep;
    body.position = state.pose.position;
    body.momentum = body.mass * state.velocity;
    body.spin_momentum = spin_momentum(body.inertia, state);
    motion += body.momentum.norm();
  }
  most_motion_ = std::max(most_motion_, motion);
  follow_angular_momentum();
}

void BodyBalances::follow_angular_momentum() {
  if (scene_.gravity || scene_.ground || !scene_.standing.empty()) return;
  Vector3d sum = Vector3d::Zero();
  double scale = 0;
  for (const Body& body : bodies_) {
    sum += body.position.cross(body.momentum) + body.spin_momentum;
    scale += body.position.norm() * body.momentum.norm();
  }
  if (!angular_begun_) {
    angular_begun_ = sum;
    angular_scale_ = scale;
  }
  if (angular_scale_ > 0) lost_angular_ = std::max(lost_angular_, (sum - *angular_begun_).norm() / angular_scale_);
}

/// What a contact did to its bodies, by their numbers: handles count up from 0 as bodies are added.
void BodyBalances::add_told(const Contact& contact, std::vector<Body>& bodies) const {
  const auto add = [&](std::int64_t id, double sign) {
    Body& body = bodies[static_cast<std::size_t>(id)];
    body.told += sign * contact.impulse;
    body.told_moment += sign * (contact.moment + (contact.point - body.position).cross(contact.impulse));
  };
  add(contact.body.value, -1);
  if (contact.other.kind == Touched::Kind::body) add(contact.other.body.value, 1);
}

void BodyBalances::end_step(const DebrisRun& run, const World& world) {
  const Vector3d gravity(0, 0, scene_.gravity ? -kDebrisGravity : 0);
  for (Body& body : bodies_) body.told = body.told_moment = Vector3d::Zero();
  for (const Contact& contact : world.contacts()) add_told(contact, bodies_);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    Body& body = bodies_[i];
    const BodyState state = world.state(run.bodies()[i]);
    if (!body.was_awake || state.asleep) {
      body.steps = 0;
      body.force = body.moment = Vector3d::Zero();
      continue;
    }
    const Vector3d lost = body.mass * state.velocity - body.momentum - body.mass * kDebrisStep * gravity - body.told;
    body.force += lost;
    // About where its centre was when the step began, which is fixed in space; gravity acts there, as velocities are
    // stored.
    body.moment += (state.pose.position - body.position).cross(body.mass * state.velocity) +
                   spin_momentum(body.inertia, state) - body.spin_momentum - body.told_moment;
    unaccounted_ += lost;
    if (++body.steps < kWindow) continue;
    const double pressed = body.weight * kWindow * kDebrisStep;
    awake_.add(body.force.norm() / pressed, body.moment.norm() / (pressed * body.reach));
    body.steps = 0;
    body.force = body.moment = Vector3d::Zero();
  }
  lost_momentum_ = std::max(lost_momentum_, unaccounted_.norm());
  keep_pressing(world);
}

void BodyBalances::keep(const Contact& contact) {
  const Touched& other = contact.other;
  const std::int64_t number = other.kind == Touched::Kind::body       ? other.body.value
                              : other.kind == Touched::Kind::obstacle ? other.obstacle.value
                                                                      : -1;
  pressing_[{contact.body.value, contact.part_tag, static_cast<std::int64_t>(other.kind), number, other.part_tag}] =
      contact;
}

/// A world may tell what bodies rest with in the step in which they fall asleep, or nothing then: the step before, in
/// which they were awake, told what they press with.
void BodyBalances::keep_pressing(const World& world) {
  std::erase_if(pressing_, [&](const auto& entry) { return !all_asleep(entry.second, world); });
  std::set<std::int64_t> told;
  for (const Contact& contact : world.contacts()) {
    if (!all_asleep(contact, world)) continue;
    keep(contact);
    told.insert(contact.body.value);
    if (contact.other.kind == Touched::Kind::body) told.insert(contact.other.body.value);
  }
  for (const Contact& contact : before_) {
    const bool again = told.contains(contact.body.value) ||
                       (contact.other.kind == Touched::Kind::body && told.contains(contact.other.body.value));
    if (!again && all_asleep(contact, world)) keep(contact);
  }
  before_.assign(world.contacts().begin(), world.contacts().end());
}

Residuals BodyBalances::asleep(const DebrisRun& run, const World& world) const {
  std::vector<Body> bodies = bodies_;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    bodies[i].told = bodies[i].told_moment = Vector3d::Zero();
    bodies[i].position = world.state(run.bodies()[i]).pose.position;
  }
  for (const auto& [key, contact] : pressing_) add_told(contact, bodies);
  for (const Contact& contact : world.contacts())  // with what is awake
    if (!all_asleep(contact, world)) add_told(contact, bodies);
  Residuals found;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!world.state(run.bodies()[i]).asleep) continue;
    const Body& body = bodies[i];
    const double pressed = body.weight * kDebrisStep;
    const Vector3d up(0, 0, scene_.gravity ? 1 : 0);
    found.add((body.told - pressed * up).norm() / pressed, body.told_moment.norm() / (pressed * body.reach));
  }
  return found;
}

}  // namespace topple::bench
