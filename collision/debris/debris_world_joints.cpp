// Hinges and cables: made and taken away, and what they pulled with.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "debris/debris_world.h"

namespace topple::collision {

namespace {
/// Share of its length by which a body may be given farther away than its cable reaches: what a decimal number rounds.
constexpr double rounded_off = 1e-3;
}  // namespace

HingeId DebrisWorld::add_hinge(const HingeDescription& description) {
  const std::string name = "hinge " + std::to_string(next_hinge_);
  if (!description.point.allFinite() || !description.axes.isUnitary(1e-9) || description.axes.determinant() < 0) {
    throw std::invalid_argument(name + ": its point must be finite and its axes a rotation");
  }
  if (std::none_of(description.held.begin(), description.held.end(), [](bool held) { return held; })) {
    throw std::invalid_argument(name + ": it holds nothing; at least one component must be held");
  }
  DebrisBody& held_body = scene_.body(description.body.value);
  DebrisBody* other = description.other ? &scene_.body(description.other->value) : nullptr;
  if (other == &held_body)
    throw std::invalid_argument(name + ": it joins body " + std::to_string(held_body.id) + " to itself");
  const DebrisObstacle* on = description.holder ? &scene_.obstacle(description.holder->value) : nullptr;
  if (other && on)
    throw std::invalid_argument(name + ": it joins body " + std::to_string(held_body.id) + " to body " +
                                std::to_string(other->id) + " and to an obstacle; accepted is one of the two");
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
  if (on) {
    const Eigen::Quaterniond back = on->pose.orientation.conjugate();
    made->holder = on->id;
    made->point_on_holder = back * (description.point - on->pose.position);
    made->axes_on_holder = back * axes;
  }
  held_body.hinges.insert(next_hinge_);
  if (other) other->hinges.insert(next_hinge_);
  scene_.wake_up(held_body);
  if (other) scene_.wake_up(*other);
  scene_.hinges.emplace(next_hinge_, std::move(made));
  return {next_hinge_++};
}

void DebrisWorld::remove_hinge(HingeId id) {
  const DebrisHinge& gone = scene_.hinge(id.value);
  for (const std::int64_t end : {gone.body, gone.other}) {
    if (end < 0) continue;
    scene_.body(end).hinges.erase(id.value);
    wake({end});
  }
  scene_.hinges.erase(id.value);
}

void DebrisWorld::wake_hung_at(const DebrisObstacle& holder) {
  for (auto& [id, hinge] : scene_.hinges)
    if (hinge->holder == holder.id) scene_.wake_up(scene_.body(hinge->body));
}

/// They hold on where they are, fixed in space.
void DebrisWorld::let_go_of(const DebrisObstacle& holder) {
  for (auto& [id, hinge] : scene_.hinges) {
    if (hinge->holder != holder.id) continue;
    hinge->holder = -1;
    hinge->pulled = false;
    hinge->impulse = hinge->angular_impulse = Vec3::Zero();
    hinge->rows.point_in_holder = holder.pose * hinge->point_on_holder;
    hinge->rows.axes_in_holder = holder.pose.orientation * hinge->axes_on_holder;
  }
}

double DebrisWorld::hinge_work_lost(HingeId id) const {
  const DebrisHinge& asked = scene_.hinge(id.value);
  return scene_.body(asked.body).asleep ? 0 : asked.work_lost;
}

Eigen::Matrix<double, 6, 1> DebrisWorld::hinge_force(HingeId id) const { return scene_.hinge(id.value).force; }

CableId DebrisWorld::add_cable(const CableDescription& description) {
  const std::string name = "cable " + std::to_string(next_cable_);
  DebrisBody& hung = scene_.body(description.body.value);
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
  scene_.wake_up(hung);
  scene_.cables.emplace(next_cable_, std::move(made));
  return {next_cable_++};
}

void DebrisWorld::remove_cable(CableId id) {
  DebrisBody& hung = scene_.body(scene_.cable(id.value).body);
  hung.cables.erase(id.value);
  scene_.wake_up(hung);
  scene_.cables.erase(id.value);
}

CablePull DebrisWorld::cable_pull(CableId id) const {
  const DebrisCable& asked = scene_.cable(id.value);
  CablePull pull = asked.pull;
  if (scene_.body(asked.body).asleep) pull.work_lost = 0;  // it hangs as it did
  return pull;
}

}  // namespace topple::collision
