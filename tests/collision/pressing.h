#pragma once
// What bodies pressed with when they came to rest, or press with now.
#include <map>
#include <utility>

#include "world_builder.h"

namespace collision_test {

class Pressing {
 public:
  /// After each step.
  void read(const World& world) {
    for (const BodyId id : world.bodies())
      if (!world.state(id).asleep) forget(id.value);
    for (const Contact& contact : world.contacts()) told_[{contact.body.value, other(contact)}] = contact;
  }
  /// N, on all that stands.
  [[nodiscard]] Vec3 on_standing() const {
    Vec3 sum = Vec3::Zero();
    for (const auto& [key, contact] : told_)
      if (contact.other.kind != Touched::Kind::body) sum += contact.impulse / kStep;
    return sum;
  }
  /// N; in balance it is the opposite of the body's weight.
  [[nodiscard]] Vec3 on_body(std::int64_t id) const {
    Vec3 sum = Vec3::Zero();
    for (const auto& [key, contact] : told_) sum += sign(contact, id) * contact.impulse / kStep;
    return sum;
  }
  /// N m, about `centre`.
  [[nodiscard]] Vec3 moment_on_body(std::int64_t id, const Vec3& centre) const {
    Vec3 sum = Vec3::Zero();
    for (const auto& [key, contact] : told_)
      sum += sign(contact, id) * (contact.moment + (contact.point - centre).cross(contact.impulse)) / kStep;
    return sum;
  }
  /// By the body and what it touches: the other body, -1 for the ground, -2 and below for obstacles.
  [[nodiscard]] const auto& all() const { return told_; }

 private:
  static std::int64_t other(const Contact& contact) {
    if (contact.other.kind == Touched::Kind::body) return contact.other.body.value;
    return contact.other.kind == Touched::Kind::ground ? -1 : -2 - contact.other.obstacle.value;
  }
  static double sign(const Contact& contact, std::int64_t id) {
    if (contact.body.value == id) return -1;
    return contact.other.kind == Touched::Kind::body && contact.other.body.value == id ? 1 : 0;
  }
  void forget(std::int64_t id) {
    std::erase_if(told_, [&](const auto& entry) { return entry.first.first == id || entry.first.second == id; });
  }
  std::map<std::pair<std::int64_t, std::int64_t>, Contact> told_;
};

}  // namespace collision_test
