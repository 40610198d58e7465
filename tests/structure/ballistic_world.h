#pragma once
// A collision world for tests: bodies fly freely and touch obstacles as spheres touch boxes; nothing rests, nothing
// bounces by itself. It records what it was asked to do.
#include <algorithm>
#include <map>
#include <stdexcept>

#include "topple/collision/world.h"

namespace topple::test {

class BallisticWorld : public collision::World {
 public:
  using Vec3 = collision::Vec3;
  int steps = 0, sweeps = 0;
  [[nodiscard]] std::size_t obstacle_count() const { return obstacles_.size(); }

  void set_gravity(const Vec3& value) override { gravity_ = value; }
  void set_ground(double, double, double) override {}
  collision::BodyId add_body(const collision::BodyDescription& description) override {
    const collision::BodyId id{next_++};
    bodies_[id.value] = {description, {description.pose, description.velocity, description.angular_velocity, false}};
    order_.push_back(id);
    return id;
  }
  void remove_body(collision::BodyId id) override {
    bodies_.erase(id.value);
    std::erase(order_, id);
  }
  collision::ObstacleId add_obstacle(const collision::ObstacleDescription& description) override {
    const collision::ObstacleId id{next_++};
    obstacles_[id.value] = description;
    return id;
  }
  void remove_obstacle(collision::ObstacleId id) override { obstacles_.erase(id.value); }
  void move_obstacle(collision::ObstacleId, const collision::Pose&) override {}
  collision::HingeId add_hinge(const collision::HingeDescription&) override {
    throw std::logic_error("no hinges here");
  }
  void remove_hinge(collision::HingeId) override {}
  [[nodiscard]] double hinge_work_lost(collision::HingeId) const override { return 0; }
  [[nodiscard]] Eigen::Matrix<double, 6, 1> hinge_force(collision::HingeId) const override {
    return Eigen::Matrix<double, 6, 1>::Zero();
  }
  collision::CableId add_cable(const collision::CableDescription&) override {
    throw std::logic_error("no cables here");
  }
  void remove_cable(collision::CableId) override {}
  [[nodiscard]] collision::CablePull cable_pull(collision::CableId) const override { return {}; }
  [[nodiscard]] collision::BodyState state(collision::BodyId id) const override { return bodies_.at(id.value).state; }
  void set_state(collision::BodyId id, const collision::BodyState& state) override {
    bodies_.at(id.value).state = state;
  }
  void apply_impulse(collision::BodyId id, const Vec3& impulse, const Vec3&) override {
    Flying& body = bodies_.at(id.value);
    body.state.velocity += impulse / body.description.mass;
  }
  void wake(collision::BodyId) override {}
  void ignore_until_separated(collision::BodyId, const collision::Touched&) override {}
  [[nodiscard]] std::span<const collision::BodyId> bodies() const override { return order_; }
  [[nodiscard]] std::size_t awake_count() const override { return bodies_.size(); }

  std::vector<collision::Contact> sweep(double dt, const collision::SweepOptions&) override {
    ++sweeps;
    std::vector<collision::Contact> found;
    for (const auto& [id, body] : bodies_)
      for (const auto& [other, obstacle] : obstacles_) touch(id, body, other, obstacle, dt, found);
    std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
    return found;
  }
  void step(double dt) override {
    ++steps;
    for (auto& [id, body] : bodies_) {
      body.state.velocity += gravity_ * dt;
      body.state.pose.position += body.state.velocity * dt;
    }
  }
  [[nodiscard]] std::span<const collision::Contact> contacts() const override { return {}; }
  [[nodiscard]] std::optional<collision::RayHit> ray_cast(const Vec3&, const Vec3&) const override { return {}; }
  [[nodiscard]] std::vector<collision::ObstacleId> obstacles_in(const Vec3&, const Vec3&) const override { return {}; }

 private:
  struct Flying {
    collision::BodyDescription description;
    collision::BodyState state;
  };

  static Vec3 nearest(const collision::ObstacleDescription& obstacle, const Vec3& point) {
    const collision::ConvexPart& part = obstacle.parts.front();
    const Eigen::Quaterniond turn = obstacle.pose.orientation * part.pose.orientation;
    const Vec3 centre = obstacle.pose * part.pose.position;
    Vec3 half = part.half_extents;
    if (part.kind == collision::ConvexPart::Kind::hull)
      for (const Vec3& corner : part.points) half = half.cwiseMax(corner.cwiseAbs());
    const Vec3 local = turn.conjugate() * (point - centre);
    return centre + turn * local.cwiseMax(-half).cwiseMin(half);
  }

  /// First time at which the sphere's surface meets the box: steps of a thousandth, then halving.
  void touch(std::int64_t id, const Flying& body, std::int64_t other, const collision::ObstacleDescription& obstacle,
             double dt, std::vector<collision::Contact>& found) const {
    const double radius = body.description.parts.front().half_extents.x();
    const Vec3 velocity = body.state.velocity + gravity_ * dt / 2;
    const auto at = [&](double t) -> Vec3 { return body.state.pose.position + velocity * t + gravity_ * t * t / 2; };
    const auto gap = [&](double t) { return (at(t) - nearest(obstacle, at(t))).norm() - radius; };
    if (gap(0) <= 0) return;
    for (int i = 1; i <= 1000; ++i) {
      double low = dt * (i - 1) / 1000, high = dt * i / 1000;
      if (gap(high) > 0) continue;
      while (high - low > 1e-14) (gap((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
      collision::Contact contact;
      contact.body = {id};
      contact.other.kind = collision::Touched::Kind::obstacle;
      contact.other.obstacle = {other};
      contact.point = nearest(obstacle, at(low));
      contact.normal = (contact.point - at(low)).normalized();
      contact.time = low;
      contact.approach_speed = (velocity + gravity_ * low).dot(contact.normal);
      found.push_back(contact);
      return;
    }
  }

  Vec3 gravity_ = Vec3::Zero();
  std::int64_t next_ = 0;
  std::map<std::int64_t, Flying> bodies_;
  std::map<std::int64_t, collision::ObstacleDescription> obstacles_;
  std::vector<collision::BodyId> order_;
};

}  // namespace topple::test
