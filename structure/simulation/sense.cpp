// Sense: shapes are made for what awake bodies may reach in this step, then the collision world sweeps.
#include "simulation/simulation_state.h"

namespace topple::structure {

namespace {
/// Room around a body's swept bounds, m: what its shapes' skins and a step's turn may add.
constexpr double sense_margin = 0.25;
/// Room around that which is looked over with it, m: a body that lies or rolls stays in it, one that falls for some
/// steps.
constexpr double look_ahead = 1;
}  // namespace

Bounds Simulation::State::swept_bounds(const Body& body, const collision::BodyState& state) const {
  const double dt = scenario.step;
  const Mat3 turn = state.pose.orientation.toRotationMatrix();
  const Vec3 middle = state.pose.position + turn * ((body.bounds.low + body.bounds.high) / 2);
  const Vec3 half = turn.cwiseAbs() * ((body.bounds.high - body.bounds.low) / 2);
  const double turned_by = state.angular_velocity.norm() * dt * (body.bounds.high - body.bounds.low).norm() / 2;
  const Vec3 margin = half + Vec3::Constant(sense_margin + turned_by);
  const Vec3 travel = reading().true_velocity(state.velocity) * dt + gravity * dt * dt / 2;
  Bounds swept;
  for (const Vec3& at : {middle, Vec3(middle + travel)}) {
    swept.add(at - margin);
    swept.add(at + margin);
  }
  return swept;
}

/// However it is turned, its swept bounds are within what was looked over: most bodies need no more.
bool Simulation::State::stays(const BodyMotion& one, const collision::BodyState& state) const {
  const double dt = scenario.step;
  const double turned_by = state.angular_velocity.norm() * dt * one.reach;
  const Vec3 margin = Vec3::Constant(one.reach + sense_margin + turned_by);
  const Vec3& from = state.pose.position;
  const Vec3 to = from + reading().true_velocity(state.velocity) * dt + gravity * dt * dt / 2;
  return one.looked_over.holds({from.cwiseMin(to) - margin, from.cwiseMax(to) + margin});
}

/// Parts never come to stand where none stood: what may stand around a body is looked up again only when it leaves the
/// place that was looked over.
void Simulation::State::approach(BodyMotion& one, const collision::BodyState& state) {
  if (!one.near_any && stays(one, state)) return;
  const Bounds swept = swept_bounds(*one.body, state);
  std::vector<Part>& near = one.body->near;
  if (!one.looked_over.holds(swept)) {
    one.looked_over = swept;
    one.looked_over.add(Vec3(swept.low - Vec3::Constant(look_ahead)));
    one.looked_over.add(Vec3(swept.high + Vec3::Constant(look_ahead)));
    near = obstacles.without_shape(one.looked_over);
  }
  if (!near.empty()) obstacles.approach(near, swept, *frame, *world);
  one.near_any = !near.empty();
}

std::vector<collision::Contact> Simulation::State::sense() {
  struck.clear();
  knocks.clear();
  for (BodyMotion& one : bodies.motions()) {
    const collision::BodyState state = world->state({one.id});
    one.step_start = state.pose.position;
    if (!state.asleep) approach(one, state);
  }
  if (world->awake_count() == 0) return {};
  return timer.engine([&] { return world->sweep(scenario.step, collision::Sweep::obstacles); });
}

}  // namespace topple::structure
