#include "simulation/debris/resting_loads.h"

#include <algorithm>
#include <cmath>

#include "simulation/debris/debris_settings.h"
#include "simulation/debris/local_capacity.h"
#include "simulation/debris/mass_properties.h"

namespace topple::structure {

namespace {

double largest_utilisation(const StandingFrame& frame, Part part) {
  const Building& building = frame.building();
  double largest = 0;
  const int count = part.member.valid() ? 2 : 4;
  for (int i = 0; i < count; ++i) {
    const JointId id = part.member.valid() ? building.joint(part.member, i) : building.joint(part.panel, i);
    largest = std::max(largest, frame.utilisation(id).value);
  }
  return largest;
}

}  // namespace

void RestingLoads::forget_seen() {
  for (auto& [key, resting] : resting_) {
    resting.seen_force = resting.seen_point = Vec3::Zero();
    resting.seen_weight = 0;
  }
}

void RestingLoads::gather(collision::BodyId body, Part part, const Vec3& impulse, const Vec3& point, double dt) {
  if (!part.valid()) return;
  const auto [entry, made] = resting_.try_emplace(Key{body.value, part});
  Resting& resting = entry->second;
  if (made) resting.load_key = next_key_++;
  const double weight = impulse.norm() / dt;
  resting.seen_force += impulse / dt;
  resting.seen_point += weight * point;
  resting.seen_weight += weight;
}

/// As it was seen.
void RestingLoads::act(const Key& key, Resting& resting, StandingFrame& frame) {
  if (resting.seen_weight == 0) {
    if (resting.laid) frame.remove_contact_load(resting.load_key);
    resting.laid = false;
    resting.applied.setZero();
    return;
  }
  resting.applied = resting.seen_force;
  resting.applied_at = resting.seen_point / resting.seen_weight;
  frame.set_contact_load({resting.load_key, {key.part.member, key.part.panel, resting.applied_at}, resting.applied});
  resting.laid = true;
}

void RestingLoads::smooth(Resting& resting, double dt) {
  const double share = std::min(1.0, dt / debris_settings.smoothing_time);
  resting.force += share * (resting.seen_force - resting.force);
  if (resting.seen_weight == 0) return;
  const Vec3 at = resting.seen_point / resting.seen_weight;
  resting.point =
      resting.force.isZero(0) || resting.point.isZero(0) ? at : resting.point + share * (at - resting.point);
}

void RestingLoads::skip_average(Resting& resting, double weight) {
  if (!((resting.seen_force - resting.applied).norm() > debris_settings.largest_band * weight)) return;
  resting.force = resting.seen_force;
  if (resting.seen_weight > 0) resting.point = resting.seen_point / resting.seen_weight;
}

double RestingLoads::band(const StandingFrame& frame, std::span<const double> strength_factors, Part part,
                          double weight) {
  const double margin = std::max(0.0, 1 - largest_utilisation(frame, part));
  const double bearable =
      debris_settings.band_of_margin * margin * local_capacity(frame.building(), part, strength_factors);
  return std::clamp(bearable, debris_settings.smallest_band * weight, debris_settings.largest_band * weight);
}

/// True when the frame was told.
bool RestingLoads::lay_one(const Key& key, Resting& resting, StandingFrame& frame,
                           std::span<const double> strength_factors, double weight) {
  if (!resting.laid && resting.force.isZero(0)) return false;
  if (moves(frame, key.part)) return false;  // act()
  const double allowed = band(frame, strength_factors, key.part, weight);
  const double length = key.part.member.valid()
                            ? frame.building()[key.part.member].length
                            : std::sqrt(panel_volume(frame.building(), frame.building()[key.part.panel]) /
                                        frame.building()[key.part.panel].thickness);
  const bool changed = (resting.force - resting.applied).norm() > allowed;
  const bool moved = resting.laid && (resting.point - resting.applied_at).norm() > debris_settings.moved_share * length;
  const bool left = resting.laid && resting.seen_weight == 0 && resting.force.norm() < allowed;
  if (left) {
    frame.remove_contact_load(resting.load_key);
    resting.laid = false;
    resting.applied = resting.force = Vec3::Zero();
    return true;
  }
  if (!changed && !moved) return false;
  frame.set_contact_load({resting.load_key, {key.part.member, key.part.panel, resting.point}, resting.force});
  resting.applied = resting.force;
  resting.applied_at = resting.point;
  resting.laid = true;
  return true;
}

std::vector<collision::BodyId> RestingLoads::drop(std::span<const Part> parts, StandingFrame& frame) {
  std::vector<collision::BodyId> bodies;
  for (auto entry = resting_.begin(); entry != resting_.end();) {
    if (std::find(parts.begin(), parts.end(), entry->first.part) == parts.end()) {
      ++entry;
      continue;
    }
    if (entry->second.laid) frame.remove_contact_load(entry->second.load_key);
    bodies.push_back({entry->first.body});
    entry = resting_.erase(entry);
  }
  return bodies;
}

std::vector<collision::BodyId> RestingLoads::on(Part part) const {
  std::vector<collision::BodyId> bodies;
  for (const auto& [key, resting] : resting_)
    if (key.part == part) bodies.push_back({key.body});
  return bodies;
}

std::vector<RestingLoads::Kept> RestingLoads::forget(collision::BodyId body, StandingFrame& frame, bool keep) {
  std::vector<Kept> kept;
  for (auto entry = resting_.begin(); entry != resting_.end();) {
    if (entry->first.body != body.value) {
      ++entry;
      continue;
    }
    if (entry->second.laid && !keep) frame.remove_contact_load(entry->second.load_key);
    if (entry->second.laid && keep)
      kept.push_back({entry->first.part, entry->second.applied, entry->second.applied_at});
    entry = resting_.erase(entry);
  }
  return kept;
}

}  // namespace topple::structure
