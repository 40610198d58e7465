#pragma once
// Places of what stands, where that moves, at which bodies hang by hinges: obstacles that nothing touches. Each goes
// with its node, or with its member as a rigid one.
#include <cstdint>
#include <map>
#include <optional>

#include "simulation/debris/part_motion.h"
#include "simulation/scene.h"

namespace topple::structure {

class StandingHolds {
 public:
  /// `scene` must outlive it.
  explicit StandingHolds(Scene& scene) : scene_(scene) {}

  /// For a hinge that holds there, at a node or at the end of a member that is still fixed to the node at the other
  /// end, and that is at `point` now. What hangs there begins with the mean displacement of its part, and so somewhat
  /// off: the obstacle is at the hinge, and moves as the place does.
  [[nodiscard]] collision::ObstacleId hold(const ContactPlace& place, NodeId fixed_to, const Vec3& point);
  /// The hinge is gone.
  void let_go(collision::ObstacleId obstacle);
  /// Of its place; nothing where it stands still, or for another obstacle.
  [[nodiscard]] std::optional<PartMotion> velocity(collision::ObstacleId obstacle) const;
  /// m/s2 and rad/s2 of its place through the next substep; of one that moves (StandingFrame::foreseen_acceleration()).
  [[nodiscard]] PartMotion foreseen_acceleration(collision::ObstacleId obstacle) const;
  /// Where it is, and how it gives way; of one that moves.
  [[nodiscard]] collision::ObstacleMotion motion(collision::ObstacleId obstacle);
  [[nodiscard]] bool any() const { return !holds_.empty(); }
  /// Those off by DebrisSettings::follow go after what they are places of; to be called when what stands has moved.
  void follow();

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [scene, holds] = *this;
    archive(holds);
  }

 private:
  struct Hold {
    ContactPlace place;
    NodeId fixed_to;
    Vec3 origin = Vec3::Zero();                          ///< m: where the hinge would be in the undeformed building
    Vec3 followed = Vec3::Zero();                        ///< m: displacement with which the world has it
    std::optional<std::uint64_t> found_at;               ///< changes of mobilities when its own was found
    collision::Mat6 mobility = collision::Mat6::Zero();  ///< at the place
  };
  template <class Archive>
  friend void serialize(Archive& archive, Hold& hold) {
    auto& [place, fixed_to, origin, followed, found_at, mobility] = hold;
    archive(place, fixed_to, origin, followed, found_at, mobility);
  }
  [[nodiscard]] PartMotion displacement(const Hold& hold) const;
  void find_mobility(Hold& hold) const;

  Scene& scene_;
  std::map<std::int64_t, Hold> holds_;  ///< by obstacle
};

}  // namespace topple::structure
