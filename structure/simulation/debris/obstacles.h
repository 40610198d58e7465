#pragma once
// Collision shapes of what stands, made only when something comes near. They stay until their part falls or is removed;
// a static shape that nothing touches costs nothing.
#include <map>

#include "simulation/debris/part_grid.h"
#include "topple/collision/world.h"
#include "topple/structure/standing_frame.h"

namespace topple::structure {

class Obstacles {
 public:
  Obstacles(const Building& building, const PartShapes& shapes, const PartGrid& grid, double friction,
            double restitution);

  /// Makes shapes for the standing parts that reach into the box.
  void approach(const Bounds& box, const StandingFrame& frame, collision::World& world);
  /// The same for those of `near`, out of which those are taken that need none any longer.
  void approach(std::vector<Part>& near, const Bounds& box, const StandingFrame& frame, collision::World& world);
  /// Parts at the box that have no shape in the world, in order of number; some may be gone.
  [[nodiscard]] std::vector<Part> without_shape(const Bounds& box) const { return grid_.near(box, settled_); }
  /// The part has another shape now. What was swept against the old one still tells the part.
  void renew(Part part, collision::World& world);
  /// The part stands no more.
  void remove(Part part, collision::World& world);
  [[nodiscard]] Part part_of(collision::ObstacleId obstacle) const;
  /// -1 when the part has no shape.
  [[nodiscard]] collision::ObstacleId obstacle_of(Part part) const;

 private:
  [[nodiscard]] collision::ObstacleId make(Part part, collision::World& world);
  const Building& building_;
  const PartShapes& shapes_;
  const PartGrid& grid_;
  double friction_, restitution_;
  std::vector<collision::ObstacleId> obstacle_of_part_;
  std::vector<char> settled_;  ///< by part number: has a shape, or has been seen to be gone
  std::map<std::int64_t, Part> part_of_obstacle_;
};

}  // namespace topple::structure
