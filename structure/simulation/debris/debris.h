#pragma once
// Debris: the bodies that move, which part of the building is in which of them, and how they meet what stands: shapes,
// obstacles, what lies at rest on it.
#include <map>
#include <span>
#include <string>
#include <vector>

#include "simulation/debris/bodies.h"
#include "simulation/debris/obstacles.h"
#include "simulation/debris/part_masses.h"
#include "simulation/debris/resting_loads.h"
#include "simulation/scene.h"

namespace topple::structure {

struct Debris {
  /// `scene` must outlive it.
  explicit Debris(Scene& the_scene);

  /// A body of true velocity and spin, `displacement` away from where it was in the undeformed building.
  collision::BodyId add(Body one, const Vec3& velocity, const Vec3& spin, const Vec3& displacement);
  /// The same where it is by now.
  collision::BodyId add(Body one, const Vec3& velocity, const Vec3& spin, const collision::Pose& pose);
  /// `state` as the collision world reads it.
  collision::BodyId add(Body one, const collision::BodyState& state);
  /// The collision world knows it no more, nor does what it lay on; its parts are in no body until they are in others.
  void remove(collision::BodyId id);
  /// Null for one that is not there.
  [[nodiscard]] Body* find(collision::BodyId id);
  [[nodiscard]] const Body* find(collision::BodyId id) const;
  /// They go through each other until they have parted once.
  void pass(collision::BodyId id, const collision::Touched& other);
  void pass(collision::BodyId id, collision::BodyId other);

  // By part of the building; -1: it stands, -2: it is gone.
  [[nodiscard]] std::int64_t body_of(Part part) const;
  /// Of the joint's member or panel.
  [[nodiscard]] std::int64_t body_of(JointId joint) const;
  /// The body that a member or node is part of; -1: none.
  [[nodiscard]] collision::BodyId body_with(const ContactPlace& place) const;
  /// The part is in no body any more.
  void lose(Part part) { body_of_part[static_cast<std::size_t>(part_number(scene.building, part))] = -2; }
  /// Rotation of the body since the building was whole; what stands (-1) has not turned.
  [[nodiscard]] Mat3 rotation(collision::BodyId id) const;
  /// Of a part of the building, or of the chunk or ball that the body is.
  [[nodiscard]] std::string name(collision::BodyId body, std::int64_t part_tag) const;

  // What stands no more, and what lies on what stands.
  /// Bodies that lay on the parts wake.
  void stop_standing(std::span<const Part> parts);
  void stop_standing(Part part) { stop_standing({&part, 1}); }
  /// A standing part has another shape: bodies that lie on it wake.
  void renew_shape(Part part);
  /// What lies where its body was dropped goes on weighing, and falls with what it lies on.
  void freeze(const std::vector<RestingLoads::Kept>& lying);
  /// A part too small to be a body comes down on what stands under it, and its weight stays there.
  void leave_weight(const MassProperties& rest);

  /// Debris that is no body any more and lies as dead weight.
  struct Frozen {
    Part on;
    MassProperties mass;
  };
  struct HungBall {
    collision::CableId cable;
    Vec3 anchor;
  };
  Scene& scene;
  PartMasses masses;
  PartShapes shapes;
  PartGrid grid;
  Obstacles obstacles;
  RestingLoads resting;
  std::vector<Frozen> frozen;
  Bodies bodies;
  std::vector<std::int64_t> body_of_part;   ///< by part number
  std::map<std::int64_t, HungBall> cables;  ///< by body
};

template <class Archive>
void serialize(Archive& archive, Debris::Frozen& frozen) {
  auto& [on, mass] = frozen;
  archive(on, mass);
}
template <class Archive>
void serialize(Archive& archive, Debris::HungBall& ball) {
  auto& [cable, anchor] = ball;
  archive(cable, anchor);
}
/// The grid is the building's.
template <class Archive>
void serialize(Archive& archive, Debris& of) {
  auto& [scene, masses, shapes, grid, obstacles, resting, frozen, bodies, body_of_part, cables] = of;
  archive(masses, shapes, obstacles, resting, frozen, bodies, body_of_part, cables);
}

}  // namespace topple::structure
