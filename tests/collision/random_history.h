#pragma once
// Worlds to which the same happens, by chance: bodies of all kinds, obstacles that sway, joints and pairs that are
// ignored come, change and go; gravity turns; heaps come to rest and are woken.
#include <catch2/catch.hpp>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "swaying.h"

namespace collision_test {

/// A world and the structure that moves beside it.
struct Beside {
  std::unique_ptr<World> world;
  Swaying structure;
};

/// What a world saves.
[[nodiscard]] std::string saved(const World& world);

class RandomHistory {
 public:
  /// Begins with a heap that falls on obstacles and ground.
  explicit RandomHistory(unsigned seed);
  /// One more, which is as the first is now.
  void add(std::unique_ptr<World> world) { all_.push_back({std::move(world), all_.front().structure}); }
  /// All but the first.
  void drop_others() { all_.resize(1); }
  [[nodiscard]] World& first() { return *all_.front().world; }
  /// Calls and a step; what is asked of one world and another is the same to the bit.
  void go_on();
  /// A call.
  void change();
  /// All that worlds tell and save.
  void require_alike();
  [[nodiscard]] bool sways() const { return all_.front().structure.sways; }
  [[nodiscard]] std::size_t joint_count() const { return hinges_.size() + cables_.size(); }

 private:
  [[nodiscard]] double between(double low, double high);
  [[nodiscard]] Vec3 point(double low, double high) {
    return {between(low, high), between(low, high), between(low, high)};
  }
  [[nodiscard]] BodyId any_body();
  /// Of all worlds.
  template <class Call>
  auto each(const Call& call);
  [[nodiscard]] BodyDescription any_description();
  void change_bodies();
  void change_obstacles();
  void change_joints();
  void add_hinge();
  void forget_gone_joints();
  void ask();
  void step();

  std::mt19937 random_;
  std::vector<Beside> all_;
  std::vector<ObstacleId> obstacles_;
  std::vector<HingeId> hinges_;
  std::vector<CableId> cables_;
  int steps_ = 0;
};

}  // namespace collision_test
