#include "simulation/sweep.h"

#include <algorithm>
#include <cmath>

#include "simulation/debris/debris_settings.h"
#include "simulation/impact/impact_settings.h"

namespace topple::structure {

Sweep::Way Sweep::way_of(const collision::BodyState& state, double radius) const {
  const double dt = scene_.scenario.step;
  return {scene_.reading().true_velocity(state.velocity) * dt + scene_.gravity * dt * dt / 2,
          state.angular_velocity.norm() * dt * radius};
}

Bounds Sweep::swept_bounds(const Body& body, const collision::BodyState& state) const {
  const Mat3 turn = state.pose.orientation.toRotationMatrix();
  const Vec3 middle = state.pose.position + turn * ((body.bounds.low + body.bounds.high) / 2);
  const Vec3 half = turn.cwiseAbs() * ((body.bounds.high - body.bounds.low) / 2);
  const auto [travel, turned_by] = way_of(state, (body.bounds.high - body.bounds.low).norm() / 2);
  const Vec3 margin = half + Vec3::Constant(debris_settings.sweep_margin + turned_by);
  Bounds swept;
  for (const Vec3& at : {middle, Vec3(middle + travel)}) {
    swept.add(at - margin);
    swept.add(at + margin);
  }
  return swept;
}

/// What was seen of its surroundings holds: its swept bounds are within the room that there was. No side of them has
/// moved by more than the centre, the farthest point by the turn between, and what of travel and turn is new.
bool Sweep::stays(const BodyMotion& one, const collision::BodyState& state) const {
  const BodyMotion::Seen& seen = one.seen;
  if (!(seen.room > 0)) return false;
  const auto [travel, turned_by] = way_of(state, one.reach);
  const auto &now = state.pose.orientation.coeffs(), &then = seen.orientation.coeffs();
  // Two quaternions that are c apart lie a turn of 4 asin(c/2) < pi c apart.
  const double apart = std::sqrt(std::min((now - then).squaredNorm(), (now + then).squaredNorm()));
  const double moved = (state.pose.position - seen.position).norm() + (travel - seen.travel).norm() +
                       M_PI * apart * one.reach + std::max(0.0, turned_by - seen.turned_by) +
                       std::max(0.0, debris_.obstacles.reach() - seen.reach);
  return moved < seen.room;
}

namespace {
/// Along the axis in which they are farthest apart; not above zero when they meet.
double gap(const Bounds& a, const Bounds& b) { return (a.low - b.high).cwiseMax(b.low - a.high).maxCoeff(); }
}  // namespace

/// Parts never come to stand where none stood: what may stand around a body is looked up again only when it leaves the
/// place that was looked over.
void Sweep::approach(BodyMotion& one, const collision::BodyState& state) {
  if (stays(one, state)) return;
  Bounds swept = swept_bounds(*one.body, state);
  const double reach = debris_.obstacles.reach();  // what is looked for lies so far from where it is looked up
  swept.low.array() -= reach;
  swept.high.array() += reach;
  std::vector<Part>& near = one.body->near;
  if (!one.looked_over.holds(swept)) {
    one.looked_over = swept;
    one.looked_over.add(Vec3(swept.low - Vec3::Constant(debris_settings.look_ahead)));
    one.looked_over.add(Vec3(swept.high + Vec3::Constant(debris_settings.look_ahead)));
    near = debris_.obstacles.without_shape(one.looked_over);
  }
  if (!near.empty()) debris_.obstacles.approach(near, swept, *scene_.frame, *scene_.world);
  const auto [travel, turned_by] = way_of(state, one.reach);
  double room = (swept.low - one.looked_over.low).cwiseMin(one.looked_over.high - swept.high).minCoeff();
  for (const Part part : near) room = std::min(room, gap(swept, debris_.shapes.bounds(part)));
  one.seen = {room, state.pose.position, travel, state.pose.orientation, turned_by, reach};
}

std::vector<collision::Contact> Sweep::contacts(double dt, const collision::MovingStructure* structure) {
  for (BodyMotion& one : debris_.bodies.motions()) {
    const collision::BodyState state = scene_.world->state({one.id});
    if (!state.asleep) approach(one, state);
  }
  if (scene_.world->awake_count() == 0) return {};
  // Against the ground and each other, where one can break.
  std::vector<collision::BodyId> may_break;
  for (const std::int64_t id : debris_.bodies.composed())
    if (break_up_.may_fall_apart(collision::BodyId{id})) may_break.push_back({id});
  const collision::Sweep what = may_break.empty() ? collision::Sweep::obstacles : collision::Sweep::everything;
  return scene_.timer.engine([&] {
    return scene_.world->sweep(dt, {what, impact_settings.least_speed, may_break, structure});
  });
}

}  // namespace topple::structure
