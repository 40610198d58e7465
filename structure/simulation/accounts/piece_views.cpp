#include "simulation/accounts/piece_views.h"

#include <algorithm>

namespace topple::structure {

namespace {

/// What of a body does not change while it is there.
BodyView view_of(const Body& one) {
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

}  // namespace

void PieceViews::update() {
  std::vector<std::int64_t> before;
  before.reserve(views_.size());
  for (const BodyView& view : views_) before.push_back(view.id.value);
  view_bodies();
  record_changes(before);
}

/// Both lists are in order of id; those of bodies that stay are written over.
void PieceViews::view_bodies() {
  const std::span<const BodyMotion> motions = debris_.bodies.motions();
  const auto same_id = [](const BodyView& view, const BodyMotion& one) { return view.id.value == one.id; };
  if (!std::equal(views_.begin(), views_.end(), motions.begin(), motions.end(), same_id)) {
    std::vector<BodyView> now;
    now.reserve(motions.size());
    auto old = views_.begin();
    for (const BodyMotion& one : motions) {
      while (old != views_.end() && old->id.value < one.id) ++old;
      const bool stays = old != views_.end() && old->id.value == one.id;
      now.push_back(stays ? std::move(*old) : view_of(*one.body));
    }
    views_ = std::move(now);
  }
  if (poses_.use_count() > 1) poses_ = std::make_shared<std::vector<double>>();  // a host holds the last ones
  poses_->clear();
  poses_->reserve(7 * views_.size());
  for (BodyView& view : views_) {
    const collision::BodyState state = scene_.world->state(view.id);
    view.pose = state.pose;
    view.asleep = state.asleep;
    const Vec3& at = state.pose.position;
    const Eigen::Vector4d turn = state.pose.orientation.coeffs();
    poses_->insert(poses_->end(), {at.x(), at.y(), at.z(), turn[0], turn[1], turn[2], turn[3]});
    if (debris_.cables.empty() && !view.cable_anchor) continue;
    const auto hung = debris_.cables.find(view.id.value);
    view.cable_anchor = hung != debris_.cables.end() ? std::optional(hung->second.anchor) : std::nullopt;
  }
}

/// Both lists of bodies are in order of id.
void PieceViews::record_changes(std::span<const std::int64_t> before) {
  auto old = before.begin();
  for (const BodyView& view : views_) {
    for (; old != before.end() && *old < view.id.value; ++old) changes_.gone.push_back(*old);
    if (old != before.end() && *old == view.id.value)
      ++old;
    else
      changes_.made.push_back(view.id.value);
    if (!view.asleep) changes_.moved.push_back(view.id.value);
  }
  for (; old != before.end(); ++old) changes_.gone.push_back(*old);
}

}  // namespace topple::structure
