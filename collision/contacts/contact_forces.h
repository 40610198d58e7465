#pragma once
// Forces between bodies, averaged over several steps of the solver, and how far they differ from those with which a
// resting body was in balance when it was put to rest.
#include <span>
#include <vector>

#include "topple/collision/world.h"

namespace topple::collision {

/// Two solids by kind and id, lower first: bodies before obstacles before the ground.
struct SolidPair {
  std::int64_t body = -1;
  Touched::Kind kind = Touched::Kind::ground;
  std::int64_t other = -1;
  auto operator<=>(const SolidPair&) const = default;
};
template <class Archive>
void serialize(Archive& archive, SolidPair& of) {
  auto& [body, kind, other] = of;
  archive(body, kind, other);
}

/// Force in N and its moment about the origin in N m, global axes.
struct Wrench {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  Wrench& operator+=(const Wrench& more) {
    force += more.force;
    moment += more.moment;
    return *this;
  }
  friend Wrench operator-(const Wrench& a, const Wrench& b) { return {a.force - b.force, a.moment - b.moment}; }
  friend Wrench operator*(double factor, const Wrench& a) { return {factor * a.force, factor * a.moment}; }
};

class ContactForces {
 public:
  /// Time over which forces are averaged, s: longer than the solver's chatter, shorter than a heap takes to shift.
  static constexpr double smoothing_time = 0.25;
  /// N: what has come down to this is gone.
  static constexpr double nothing = 1;

  struct Pair {
    SolidPair who;
    Wrench on_other;       ///< what the body does to the other, averaged
    Wrench trusted_by[2];  ///< what it was when the body, or the other, was taken to rest
  };

  /// `contacts`: of the last step, of all bodies that were awake in it, in order of ids. `awake(pair)`: whether one of
  /// the two moves (what others press with stays as it is). `held(pair)`: whether one is held still.
  template <class Awake, class Held>
  void read(std::span<const Contact> contacts, double dt, const Awake& awake, const Held& held);
  /// The bodies for which `is_taken(id)` are taken to rest under what presses on them now.
  template <class Taken>
  void trust(const Taken& is_taken);
  void forget(Touched::Kind kind, std::int64_t id);
  [[nodiscard]] std::span<const Pair> pairs() const { return pairs_; }

 private:
  std::vector<Pair> pairs_, next_;  ///< in order of who
};

template <class Awake, class Held>
void ContactForces::read(std::span<const Contact> contacts, double dt, const Awake& awake, const Held& held) {
  const double share = std::min(1.0, dt / smoothing_time);
  next_.clear();
  auto old = pairs_.begin();
  const auto keep_old = [&] {
    if (awake(old->who)) old->on_other = {};  // they touch no more
    if (old->on_other.force.norm() > nothing || held(old->who)) next_.push_back(*old);
    ++old;
  };
  for (std::size_t i = 0; i < contacts.size();) {
    const auto pair_of = [](const Contact& contact) {
      const bool two = contact.other.kind == Touched::Kind::body;
      return SolidPair{contact.body.value, contact.other.kind,
                       two ? contact.other.body.value : contact.other.obstacle.value};
    };
    const SolidPair who = pair_of(contacts[i]);
    Wrench now;
    for (; i < contacts.size() && pair_of(contacts[i]) == who; ++i)
      now += {contacts[i].impulse / dt, contacts[i].point.cross(contacts[i].impulse) / dt};
    while (old != pairs_.end() && old->who < who) keep_old();
    Pair& pair = next_.emplace_back();
    if (old != pairs_.end() && old->who == who) pair = *old++;
    pair.who = who;
    pair.on_other = (1 - share) * pair.on_other;
    pair.on_other += share * now;
  }
  while (old != pairs_.end()) keep_old();
  pairs_.swap(next_);
}

template <class Taken>
void ContactForces::trust(const Taken& is_taken) {
  for (Pair& pair : pairs_) {
    if (is_taken(pair.who.body)) pair.trusted_by[0] = pair.on_other;
    if (pair.who.kind == Touched::Kind::body && is_taken(pair.who.other)) pair.trusted_by[1] = pair.on_other;
  }
}

}  // namespace topple::collision
