// Hinges and cables: made, taken away, and what they pulled with.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "debris/debris_world.h"

namespace topple::collision {

namespace {
/// Share of its length by which a body may be given farther away than its cable reaches: what a decimal number rounds.
constexpr double rounded_off = 1e-3;
/// A ball this near to its plumb line (m) may come to rest.
constexpr double plumb = 0.02;
}  // namespace

HingeId DebrisWorld::add_hinge(const HingeDescription& description) {
  const std::string name = "hinge " + std::to_string(next_hinge_);
  if (!description.point.allFinite() || !description.axes.isUnitary(1e-9) || description.axes.determinant() < 0) {
    throw std::invalid_argument(name + ": its point must be finite and its axes a rotation");
  }
  if (std::none_of(description.held.begin(), description.held.end(), [](bool held) { return held; })) {
    throw std::invalid_argument(name + ": it holds nothing; at least one component must be held");
  }
  DebrisBody& held_body = body(description.body.value);
  DebrisBody* other = description.other ? &body(description.other->value) : nullptr;
  if (other == &held_body)
    throw std::invalid_argument(name + ": it joins body " + std::to_string(held_body.id) + " to itself");
  auto made = std::make_unique<DebrisHinge>();
  made->body = held_body.id;
  made->other = other ? other->id : -1;
  HingeRows& rows = made->rows;
  rows.held = description.held;
  const Mat3 axes = description.axes.transpose();  // columns
  const Placement holder = other ? other->at : Placement{};
  rows.point_in_body = held_body.at.turn.transpose() * (description.point - held_body.at.position);
  rows.point_in_holder = holder.turn.transpose() * (description.point - holder.position);
  rows.axes_in_body = held_body.at.turn.transpose() * axes;
  rows.axes_in_holder = holder.turn.transpose() * axes;
  held_body.hinges.insert(next_hinge_);
  if (other) other->hinges.insert(next_hinge_);
  wake_up(held_body);
  if (other) wake_up(*other);
  hinges_.emplace(next_hinge_, std::move(made));
  return {next_hinge_++};
}

void DebrisWorld::remove_hinge(HingeId id) {
  const DebrisHinge& gone = hinge(id.value);
  for (const std::int64_t end : {gone.body, gone.other}) {
    if (end < 0) continue;
    body(end).hinges.erase(id.value);
    wake({end});
  }
  hinges_.erase(id.value);
}

double DebrisWorld::hinge_work_lost(HingeId id) const {
  const DebrisHinge& asked = hinge(id.value);
  return body(asked.body).asleep ? 0 : asked.work_lost;
}

Eigen::Matrix<double, 6, 1> DebrisWorld::hinge_force(HingeId id) const { return hinge(id.value).force; }

CableId DebrisWorld::add_cable(const CableDescription& description) {
  const std::string name = "cable " + std::to_string(next_cable_);
  DebrisBody& hung = body(description.body.value);
  if (!description.anchor.allFinite() || !(description.length > 0) || !std::isfinite(description.length))
    throw std::invalid_argument(name + ": its anchor must be finite and its length above zero");
  const double away = (hung.at.position - description.anchor).norm();
  if (away > (1 + rounded_off) * description.length)
    throw std::invalid_argument(name + ": the body is " + std::to_string(away) + " m from its anchor; it is " +
                                std::to_string(description.length) + " m long");
  auto made = std::make_unique<DebrisCable>();
  made->body = hung.id;
  made->row.anchor = description.anchor;
  made->row.length = description.length;
  hung.cables.insert(next_cable_);
  wake_up(hung);
  cables_.emplace(next_cable_, std::move(made));
  return {next_cable_++};
}

void DebrisWorld::remove_cable(CableId id) {
  DebrisBody& hung = body(cable(id.value).body);
  hung.cables.erase(id.value);
  wake_up(hung);
  cables_.erase(id.value);
}

CablePull DebrisWorld::cable_pull(CableId id) const {
  const DebrisCable& asked = cable(id.value);
  CablePull pull = asked.pull;
  if (body(asked.body).asleep) pull.work_lost = 0;  // it hangs as it did
  return pull;
}

/// Of the bodies that moved, means over the parts of the step: what sleeps pulls as it did.
void DebrisWorld::read_joints(std::span<Island* const> islands, double dt) {
  for (const Island* island : islands) {
    for (DebrisHinge* hinge : island->hinges) {
      const HingeRows& rows = hinge->rows;
      const Mat3 axes = (solver_.body(rows.holder).at.turn * rows.axes_in_holder).transpose();
      hinge->force.head<3>() -= axes * rows.force_total / (dt * parts_);
      hinge->force.tail<3>() -= axes * rows.moment_total / (dt * parts_);
    }
    for (DebrisCable* cable : island->cables) cable->pull.tension += cable->row.pulled / (dt * parts_);
  }
}

/// A ball at the end of its swing is slow and seems to go nowhere, but does not rest.
bool DebrisWorld::swings(const DebrisBody& one) const {
  if (one.cables.empty()) return false;
  const bool touches = std::any_of(contacts_.begin(), contacts_.end(), [&](const Contact& contact) {
    return contact.body.value == one.id || contact.other.body.value == one.id;
  });
  if (touches) return false;
  const Vec3 down = gravity_.isZero(0) ? Vec3(0, 0, -1) : Vec3(gravity_.normalized());
  return std::any_of(one.cables.begin(), one.cables.end(), [&](std::int64_t id) {
    const Vec3 arm = one.at.position - cable(id).row.anchor;
    return (arm - down * down.dot(arm)).norm() > plumb;
  });
}

}  // namespace topple::collision
