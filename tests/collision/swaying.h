#pragma once
// A structure that moves beside a world: some of its obstacles sway, and give way to what touches them.
#include <functional>
#include <map>
#include <utility>

#include "world_builder.h"

namespace collision_test {

class Swaying final : public MovingStructure {
 public:
  bool sways = false;
  std::function<void()> within_step;  ///< is called once, as the structure moves on
  Vec3 told = Vec3::Zero();           ///< impulses so far, N s

  void hold(ObstacleId obstacle, const Pose& home) { held_[obstacle.value].home = home; }
  void let_go(ObstacleId obstacle) { held_.erase(obstacle.value); }

  [[nodiscard]] std::optional<ObstacleMotion> motion(ObstacleId obstacle) override { return motion_of(obstacle); }
  [[nodiscard]] std::optional<ObstaclePath> path(ObstacleId obstacle) const override {
    const std::optional<ObstacleMotion> now = motion_of(obstacle);
    return now ? std::optional(now->path()) : std::nullopt;
  }

  void advance(double dt, std::span<const Contact> contacts, std::span<const HingePull> pulls) override {
    std::map<std::int64_t, Vec3> pushed;
    const auto push = [&](ObstacleId on, const Vec3& impulse) {
      pushed.try_emplace(on.value, Vec3::Zero()).first->second += impulse;
      told += impulse;
    };
    for (const Contact& contact : contacts)
      if (contact.other.kind == Touched::Kind::obstacle) push(contact.other.obstacle, contact.impulse);
    for (const HingePull& pull : pulls) push(pull.holder, pull.impulse);
    for (auto& [id, held] : held_) {
      const auto found = pushed.find(id);
      held.force = (found == pushed.end() ? Vec3::Zero() : found->second) / dt;
      held.acceleration = held.accelerates();
      held.speed += held.acceleration * dt;
      held.way += held.speed * dt;
    }
    time_ += dt;
    if (const auto call = std::exchange(within_step, nullptr)) call();
  }

 private:
  [[nodiscard]] std::optional<ObstacleMotion> motion_of(ObstacleId obstacle) const {
    const auto found = held_.find(obstacle.value);
    if (!sways || found == held_.end() || obstacle.value % 3 == 0) return std::nullopt;
    const Held& held = found->second;
    ObstacleMotion motion;
    motion.pose = held.home;
    motion.pose.position += held.way + Vec3(amplitude * std::sin(rate * time_), 0, 0);
    motion.velocity = held.speed + Vec3(amplitude * rate * std::cos(rate * time_), 0, 0);
    motion.acceleration = held.accelerates() - Vec3(amplitude * rate * rate * std::sin(rate * time_), 0, 0);
    motion.last_acceleration = held.acceleration - Vec3(amplitude * rate * rate * std::sin(rate * time_), 0, 0);
    motion.mass = mass / 2;
    motion.inertia = mass * Mat3::Identity();
    return motion;
  }
  static constexpr double mass = 3000, amplitude = 0.02, rate = 6, stiffness = 400;  // kg, m, 1/s, 1/s2
  struct Held {
    Pose home;
    Vec3 way = Vec3::Zero(), speed = Vec3::Zero();
    Vec3 force = Vec3::Zero(), acceleration = Vec3::Zero();  ///< in the last part of a step
    [[nodiscard]] Vec3 accelerates() const { return force / mass - stiffness * way - 2 * std::sqrt(stiffness) * speed; }
  };
  std::map<std::int64_t, Held> held_;
  double time_ = 0;
};

}  // namespace collision_test
