#pragma once
// Collision shapes of what stands, made only when something comes near. They stay until their part falls or is removed;
// a static shape that nothing touches costs nothing.
#include <map>

#include "simulation/debris/part_grid.h"
#include "simulation/debris/part_motion.h"
#include "topple/collision/world.h"
#include "topple/structure/standing_frame.h"

namespace topple::structure {

class Obstacles {
 public:
  Obstacles(const Building& building, const PartShapes& shapes, const PartGrid& grid, double friction,
            double restitution, bool sways);

  /// Makes shapes for the standing parts that reach into the box.
  void approach(const Bounds& box, const StandingFrame& frame, collision::World& world);
  /// The same for those of `near`, out of which those are taken that need none any longer.
  void approach(std::vector<Part>& near, const Bounds& box, const StandingFrame& frame, collision::World& world);
  /// Parts at the box that have no shape in the world, in order of number; some may be gone.
  [[nodiscard]] std::vector<Part> without_shape(const Bounds& box) const { return grid_.near(box, settled_); }
  /// Shapes of parts that have moved go after them, once they are off by DebrisSettings::follow; to be called when what
  /// stands has moved.
  void follow(const StandingFrame& frame, collision::World& world);
  /// Where the part is now.
  [[nodiscard]] collision::Pose pose(Part part, const StandingFrame& frame) const;
  /// The same; the collision world takes its shape there by itself.
  [[nodiscard]] collision::Pose carry(Part part, const StandingFrame& frame);
  /// Of a part's bounds, undeformed: its shape turns about it.
  [[nodiscard]] Vec3 middle(Part part) const;
  /// m: no part that stands is farther from its unloaded place.
  [[nodiscard]] double reach() const { return reach_; }
  /// The part has another shape now. What was swept against the old one still tells the part.
  void renew(Part part, collision::World& world);
  /// The part stands no more.
  void remove(Part part, collision::World& world);
  [[nodiscard]] Part part_of(collision::ObstacleId obstacle) const;
  /// -1 when the part has no shape.
  [[nodiscard]] collision::ObstacleId obstacle_of(Part part) const;

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [building, shapes, grid, friction, restitution, sways, obstacle_of_part, settled, part_of_obstacle, shifted,
           reach] = *this;
    archive(obstacle_of_part, settled, part_of_obstacle, shifted, reach);
  }

 private:
  [[nodiscard]] collision::Pose pose_of(Part part, const PartMotion& shift) const;
  [[nodiscard]] collision::ObstacleId make(Part part, collision::World& world);
  void put(std::size_t number, collision::World& world) const;
  const Building& building_;
  const PartShapes& shapes_;
  const PartGrid& grid_;
  double friction_, restitution_;
  bool sways_;  ///< parts move, and have their shapes where they are
  std::vector<collision::ObstacleId> obstacle_of_part_;
  std::vector<char> settled_;  ///< by part number: has a shape, or has been seen to be gone
  std::map<std::int64_t, Part> part_of_obstacle_;
  /// By part number, about middle(): where shapes are that are not at their unloaded place.
  std::map<std::size_t, PartMotion> shifted_;
  double reach_ = 0;
};

}  // namespace topple::structure
