#pragma once
// What there is in a world of debris: bodies, obstacles, hinges, cables, the ground, and the pairs of them that are
// near each other. Who is awake is kept here; everything else is changed by the parts that work on it.
#include <map>
#include <memory>
#include <vector>

#include "contacts/near_pairs.h"
#include "debris/debris_parts.h"
#include "shapes/polyhedron_store.h"
#include "solver/solver_settings.h"

namespace topple::collision {

/// The half space below `height`, m, if it is there.
struct DebrisGround {
  Solid solid;
  bool there = false;
  double height = 0, friction = 0, restitution = 0;
};
template <class Archive>
void serialize(Archive& archive, DebrisGround& of) {
  auto& [solid, there, height, friction, restitution] = of;
  archive(solid, there, height, friction, restitution);
}

/// Owned by its world; everyone else holds a reference.
struct DebrisScene {
  explicit DebrisScene(const SolverSettings& of) : settings(of) {}
  /// All once more, but shapes, which nothing changes.
  DebrisScene(const DebrisScene& of);
  DebrisScene& operator=(const DebrisScene&) = delete;
  /// All once more as well, with the shapes made anew; `polyhedra` has their faces. Of a scene with the same settings.
  template <class Archive>
  void save(Archive& archive) const;
  template <class Archive>
  void load(Archive& archive, PolyhedronStore& polyhedra);
  /// What `polyhedra` keeps of the shapes that are there.
  [[nodiscard]] PolyhedronStore features(const PolyhedronStore& polyhedra) const;

  // Throw out_of_range for what is not in the world.
  [[nodiscard]] DebrisBody& body(std::int64_t id) const;
  [[nodiscard]] DebrisObstacle& obstacle(std::int64_t id) const;
  [[nodiscard]] DebrisHinge& hinge(std::int64_t id) const;
  [[nodiscard]] DebrisCable& cable(std::int64_t id) const;
  /// The ground has no id.
  [[nodiscard]] Solid* solid(Touched::Kind kind, std::int64_t id);

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

 private:
  void make_shapes_again(PolyhedronStore& polyhedra);
};

template <class Archive>
void DebrisScene::save(Archive& archive) const {
  // Settings are those that it is made with; what touches is found anew before it is read; velocities are read as
  // between steps.
  const auto& [of_settings, g, all_bodies, all_obstacles, all_hinges, all_cables, moving, in_order, awake_ones, below,
               near, in_contact, number, read_by] = *this;
  archive(g, all_bodies, all_obstacles, all_hinges, all_cables, moving, in_order, awake_ones, below, number);
  near.save(archive);
}

template <class Archive>
void DebrisScene::load(Archive& archive, PolyhedronStore& polyhedra) {
  archive(gravity, bodies, obstacles, hinges, cables, moving_obstacles, order, awake_count, ground, step_number);
  make_shapes_again(polyhedra);
  pairs.load(archive, [this](Touched::Kind kind, std::int64_t id) { return solid(kind, id); });
}

}  // namespace topple::collision
