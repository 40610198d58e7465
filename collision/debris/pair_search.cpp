#include "debris/pair_search.h"

#include <algorithm>
#include <cmath>

#include "contacts/pair_contacts.h"
#include "debris/passing_pairs.h"

namespace topple::collision {

namespace {
/// For which a piece of a loop is worth being handed on.
constexpr std::size_t kBodies = 32, kDuePairs = 8, kPairsScanned = 256, kMoved = 8;
}  // namespace

void PairSearch::update_bounds(double dt) {
  for (const BodyId id : scene_.order) {
    DebrisBody& one = scene_.body(id.value);
    if (one.asleep) continue;
    const Vec3 way = (one.velocity + scene_.gravity * dt) * dt;
    const double spin = one.spin.norm() * dt;
    for (std::size_t i = 0; i < one.parts.size(); ++i) {
      Box3 bounds = scene_.bounds_of(one.shapes[i], one.at);
      const Vec3 out = Vec3::Constant(scene_.settings.margin + std::min(1.0, spin) * one.parts[i].reach);
      bounds.low += way.cwiseMin(0) - out;
      bounds.high += way.cwiseMax(0) + out;
      scene_.pairs.move(one.colliders[i], bounds, scene_.settings.fat + way.norm());
    }
  }
}

/// Of all pairs those for which `is_chosen`, in order.
template <class Choice>
void PairSearch::choose(const Choice& is_chosen, std::vector<std::uint32_t>& chosen) {
  const std::vector<std::uint32_t>& order = scene_.pairs.order();
  chosen_.resize(order.size());
  region_.each(order.size(), kPairsScanned, [&](std::size_t i) {
    if (i + 4 * kAhead < order.size()) __builtin_prefetch(&scene_.pairs.ends(order[i + 4 * kAhead]));
    chosen_[i] = is_chosen(scene_.pairs.ends(order[i])) ? 1 : 0;
  });
  chosen.clear();
  for (std::size_t i = 0; i < order.size(); ++i)
    if (chosen_[i] != 0) chosen.push_back(order[i]);
}

void PairSearch::find_near() {
  if (!scene_.pairs.changed()) return;
  choose([&](const PairEnds& ends) { return scene_.pairs.is_far(ends); }, far_);
  scene_.pairs.drop(far_);
  region_.each(scene_.pairs.moved_count(), kMoved, [&](std::size_t i) { scene_.pairs.seek(i); });
  scene_.pairs.take_found();
}

/// No point of a body comes farther in the step than this: by its contacts it may lose its speed, but what pushes it
/// comes with that much itself.
void PairSearch::note_ways(double dt) {
  const Vec3 half_kick = scene_.gravity * (dt / 2);
  const auto note = [&](DebrisBody& one) {
    one.add_way();
    const double straight = one.asleep ? 0 : (one.velocity + half_kick).norm() * dt;
    const double spin = one.asleep ? 0 : one.spin.norm() * dt;
    for (std::size_t i = 0; i < one.parts.size(); ++i)
      scene_.pairs.note_way(one.colliders[i], one.gone, straight + spin * one.parts[i].reach, !one.asleep);
  };
  region_.each(scene_.order.size(), kBodies, [&](std::size_t i) { note(scene_.body(scene_.order[i].value)); });
}

/// m: how near they are looked at. What could come together within the step is a contact already. Two that fly side by
/// side may: the one in front is stopped in this step, and the one behind goes on.
double PairSearch::margin_of(const Collider& a, const Collider& b) const {
  return std::max(scene_.settings.margin, a.way + b.way);
}

/// Whether its two may have come together or apart since they were last looked at.
bool PairSearch::is_due(const PairEnds& ends) const {
  const Collider &a = scene_.pairs.collider(ends.first), &b = scene_.pairs.collider(ends.second);
  return (a.moves || b.moves) && a.gone + b.gone + margin_of(a, b) >= ends.free_until;
}

void PairSearch::seek(std::uint32_t index) {
  PairEnds& ends = scene_.pairs.ends(index);
  const Collider &a = scene_.pairs.collider(ends.first), &b = scene_.pairs.collider(ends.second);
  const bool far = ends.second != NearPairs::ground && !a.tight.meets(b.tight);
  if (far || (ignored_.any() && ignored_.ignores(*a.solid, *b.solid))) {
    if (!ends.touches) return;
    NearPair& parted = scene_.pairs.pair(index);
    if (far) parted.sought = false;
    parted.manifold.count = 0;
    ends.touches = false;
    return;
  }
  NearPair& pair = scene_.pairs.pair(index);
  PairMotion motion;
  const auto shape = [](const Collider& of) {
    return &static_cast<const TouchingSolid*>(of.solid)->shapes[static_cast<std::size_t>(of.part)];
  };
  motion.first = shape(a);
  motion.second = ends.second == NearPairs::ground ? nullptr : shape(b);
  motion.first_at = &DebrisScene::placement(*a.solid);
  motion.second_at = &DebrisScene::placement(*b.solid);
  motion.margin = margin_of(a, b);
  motion.ground_height = scene_.ground.height;
  ends.free_until = a.gone + b.gone + update_contacts(pair, motion, scene_.settings.kept, scene_.settings.matched);
  ends.touches = pair.manifold.count > 0;
}

/// Each pair by itself. Few of those that are near are due.
void PairSearch::seek_contacts(double dt) {
  choose([&](const PairEnds& ends) { return is_due(ends); }, due_);
  region_.each(due_.size(), kDuePairs, [&](std::size_t i) {
    if (i + kAhead < due_.size()) prefetch_lines(scene_.pairs.pair(due_[i + kAhead]));
    seek(due_[i]);
    clear_if_passing(scene_, due_[i], dt);
  });
}

void PairSearch::find_touching() {
  choose([](const PairEnds& ends) { return ends.touches; }, scene_.touching);
}

}  // namespace topple::collision
