#include "debris/ignored_pairs.h"

#include <stdexcept>
#include <utility>

#include "contacts/part_contacts.h"
#include "debris/body_sweep.h"

namespace topple::collision {

namespace {

bool separated(const Solid& first, const Solid& second) {
  const auto &a = static_cast<const TouchingSolid&>(first), &b = static_cast<const TouchingSolid&>(second);
  for (const PartShape& shape : a.shapes)
    for (const PartShape& other : b.shapes) {
      if (!DebrisScene::bounds_of(shape, a.at).meets(DebrisScene::bounds_of(other, b.at))) continue;
      SeparatingAxis axis;
      Manifold manifold;
      collide(shape, a.at, other, b.at, 0, axis, manifold);
      if (manifold.count > 0) return false;
    }
  return true;
}

}  // namespace

const Solid& IgnoredPairs::solid(const SolidPair& pair) const {
  if (pair.kind == Touched::Kind::body) return scene_.body(pair.other);
  return scene_.obstacle(pair.other);
}

void IgnoredPairs::begin_step(double dt) {
  std::erase_if(released_, [&](const auto& one) { return one.second + 1 < scene_.step_number; });
  release(dt, true);
}

void IgnoredPairs::add(BodyId id, const Touched& other) {
  if (other.kind == Touched::Kind::ground)
    throw std::invalid_argument("the ground cannot be ignored; accepted: a body, an obstacle");
  SolidPair pair{id.value, other.kind, other.kind == Touched::Kind::body ? other.body.value : other.obstacle.value};
  static_cast<void>(scene_.body(pair.body));
  static_cast<void>(solid(pair));
  if (pair.kind == Touched::Kind::body) {
    if (pair.body == pair.other)
      throw std::invalid_argument("body " + std::to_string(pair.body) + " cannot ignore itself");
    if (pair.body > pair.other) std::swap(pair.body, pair.other);
  }
  // Told in every step (what hangs on a hinge and turns beside what holds it), it is ignored in every step: contacts
  // push before parts touch.
  const auto released = released_.find(pair);
  const bool again = released != released_.end() && released->second + 1 >= scene_.step_number;
  const auto [entry, made] = ignored_.try_emplace(pair, again);
  if (made)
    ignore(pair, true);
  else
    entry->second = true;
}

void IgnoredPairs::ignore(const SolidPair& pair, bool ignored) {
  scene_.body(pair.body).ignored += ignored ? 1 : -1;
  if (pair.kind == Touched::Kind::body) scene_.body(pair.other).ignored += ignored ? 1 : -1;
}

bool IgnoredPairs::ignores(const Solid& first, const Solid& second) const {
  if (static_cast<const DebrisBody&>(first).ignored == 0 || second.kind == Touched::Kind::ground) return false;
  return ignored_.contains({first.id, second.kind, second.id});
}

void IgnoredPairs::forget(Touched::Kind kind, std::int64_t id) {
  for (auto pair = ignored_.begin(); pair != ignored_.end();) {
    const SolidPair& who = pair->first;
    const bool names = (who.kind == kind && who.other == id) || (kind == Touched::Kind::body && who.body == id);
    if (names) ignore(who, false);
    pair = names ? ignored_.erase(pair) : std::next(pair);
  }
}

/// `about_to_step`: what was told again is ignored in the step that begins now, and after that if it is told once more.
void IgnoredPairs::release(double dt, bool about_to_step) {
  for (auto pair = ignored_.begin(); pair != ignored_.end();) {
    const SolidPair& who = pair->first;
    const DebrisBody& first = scene_.body(who.body);
    const Solid& other = solid(who);
    const bool other_moves = who.kind == Touched::Kind::body && !static_cast<const DebrisBody&>(other).asleep;
    const bool moves = !first.asleep || other_moves;
    const bool kept = pair->second;
    if (about_to_step) pair->second = false;
    const bool apart = !kept && moves && separated(first, other) && !still_to_pass(scene_, first, other, dt);
    if (apart) {
      ignore(who, false);
      released_[who] = scene_.step_number;
    }
    pair = apart ? ignored_.erase(pair) : std::next(pair);
  }
}

}  // namespace topple::collision
