#pragma once
// What there is in a world of debris: bodies, obstacles, hinges, cables, the ground, and the pairs of them that are
// near each other. Who is awake is kept here; everything else is changed by the parts that work on it.
#include <map>
#include <memory>
#include <vector>

#include "contacts/near_pairs.h"
#include "debris/debris_parts.h"
#include "solver/solver_settings.h"

namespace topple::collision {

/// The half space below `height`, m, if it is there.
struct DebrisGround {
  Solid solid;
  bool there = false;
  double height = 0, friction = 0, restitution = 0;
};

/// Owned by its world; everyone else holds a reference.
struct DebrisScene {
  explicit DebrisScene(const SolverSettings& of) : settings(of) {}
  /// All once more, but shapes, which nothing changes.
  DebrisScene(const DebrisScene& of);
  DebrisScene& operator=(const DebrisScene&) = delete;

  // Throw out_of_range for what is not in the world.
  [[nodiscard]] DebrisBody& body(std::int64_t id) const;
  [[nodiscard]] DebrisObstacle& obstacle(std::int64_t id) const;
  [[nodiscard]] DebrisHinge& hinge(std::int64_t id) const;
  [[nodiscard]] DebrisCable& cable(std::int64_t id) const;

  void fall_asleep(DebrisBody& body);
  void wake_up(DebrisBody& body);
  void wake_all();
  void wake_touching(const Solid& solid);
  void wake_hinged();
  /// The obstacle at which it hangs, where that moves; else null.
  [[nodiscard]] DebrisObstacle* moving_holder(const DebrisHinge& hinge) const;
  [[nodiscard]] bool all_awake() const { return awake_count == order.size(); }
  [[nodiscard]] bool awake(const NearPair& pair) const;
  [[nodiscard]] static bool awake(const Solid& solid) {
    return solid.kind == Touched::Kind::body && !static_cast<const DebrisBody&>(solid).asleep;
  }
  [[nodiscard]] static Box3 bounds_of(const PartShape& shape, const Placement& at);
  [[nodiscard]] static const Placement& placement(const Solid& solid);

  SolverSettings settings;
  Vec3 gravity = Vec3::Zero();
  std::vector<std::unique_ptr<DebrisBody>> bodies;  ///< by id, which is never used again: null where one is gone
  std::map<std::int64_t, std::unique_ptr<DebrisObstacle>> obstacles;
  std::map<std::int64_t, std::unique_ptr<DebrisHinge>> hinges;
  std::map<std::int64_t, std::unique_ptr<DebrisCable>> cables;
  std::vector<std::int64_t> moving_obstacles;  ///< ascending
  std::vector<BodyId> order;                   ///< of the bodies that are there, ascending
  std::size_t awake_count = 0;
  DebrisGround ground;
  NearPairs pairs;
  std::vector<std::uint32_t> touching;  ///< pairs that have contacts, in order
  std::uint64_t step_number = 0;        ///< of the last step in which any was awake
  Vec3 reading = Vec3::Zero();          ///< by which velocities are read otherwise than between steps
};

}  // namespace topple::collision
