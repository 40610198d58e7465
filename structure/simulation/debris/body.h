#pragma once
// A moving body as the simulation knows it: what it is made of, and how its velocity is read.
//
// The collision world integrates by semi-implicit Euler. Its velocities are taken as those of the middle of the step,
// so that free flight is exact: a body whose true velocity is V enters with V - g dt/2, and is read back by adding g
// dt/2.
#include <memory>
#include <string>
#include <vector>

#include "simulation/debris/mass_properties.h"
#include "simulation/debris/part_shapes.h"
#include "topple/collision/world.h"
#include "topple/fracture/mesh.h"
#include "topple/structure/piece_kind.h"

namespace topple::structure {

struct Body {
  collision::BodyId id;
  std::string name;  ///< of its first member, else panel, else node; a projectile is numbered
  std::vector<MemberId> members;
  std::vector<PanelId> panels;
  std::vector<NodeId> nodes;
  MassProperties rest;     ///< in the undeformed building
  double radius = 0;       ///< above zero: a sphere
  double volume = 0;       ///< of solid material, m3
  std::vector<Vec3> hull;  ///< a chunk, or a piece of a member: corners of its shape about `rest.centre`, global axes
                           ///< at rest; else empty
  PieceKind chunk_of = PieceKind::slab;
  JointId end_joint;                           ///< a piece of a member that was cut in two: the joint of its end
  std::shared_ptr<const fracture::Mesh> mesh;  ///< a chunk: as it is drawn, in the same axes
  Bounds bounds;                               ///< in the undeformed building, about `rest.centre`
  std::vector<Part> near;  ///< what may stand where it was looked over, and had no shape in the collision world
};

template <class Archive>
void serialize(Archive& archive, Body& of) {
  auto& [id, name, members, panels, nodes, rest, radius, volume, hull, chunk_of, end_joint, mesh, bounds, near] = of;
  archive(id, name, members, panels, nodes, rest, radius, volume, hull, chunk_of, end_joint, mesh, bounds, near);
}

/// Inertia about the centre, global axes, as the body lies.
[[nodiscard]] inline Mat3 world_inertia(const Body& body, const Eigen::Quaterniond& orientation) {
  const Mat3 turned = orientation.toRotationMatrix();
  return turned * body.rest.inertia * turned.transpose();
}

/// What a point of a body feels along a unit direction: 1/m + (r x n).I^-1 (r x n), inverted.
[[nodiscard]] inline double effective_mass(double mass, const Mat3& inverse_inertia, const Vec3& r, const Vec3& n) {
  const Vec3 lever = r.cross(n);
  return 1 / (1 / mass + lever.dot(inverse_inertia * lever));
}

/// Converts between true velocities and those of the collision world.
struct VelocityReading {
  Vec3 half_step;  ///< g dt/2
  [[nodiscard]] Vec3 true_velocity(const Vec3& read) const { return read + half_step; }
  [[nodiscard]] Vec3 to_world(const Vec3& velocity) const { return velocity - half_step; }
};

/// Kinetic energy of translation and of rotation.
struct Kinetic {
  double translation = 0, rotation = 0;
};
/// Of a state that tells true velocities.
[[nodiscard]] inline Kinetic kinetic_energy(const Body& body, const collision::BodyState& state) {
  return {body.rest.mass * state.velocity.squaredNorm() / 2,
          state.angular_velocity.dot(world_inertia(body, state.pose.orientation) * state.angular_velocity) / 2};
}
/// Of a state as the collision world tells it.
[[nodiscard]] inline Kinetic kinetic_energy(const Body& body, collision::BodyState state,
                                            const VelocityReading& reading) {
  if (state.asleep) return {};
  state.velocity = reading.true_velocity(state.velocity);
  return kinetic_energy(body, state);
}

/// Turned about the global rotation vector `angle`.
[[nodiscard]] inline Eigen::Quaterniond turned(const Eigen::Quaterniond& orientation, const Vec3& angle) {
  const double size = angle.norm();
  if (size == 0) return orientation;
  return (Eigen::Quaterniond(Eigen::AngleAxisd(size, angle / size)) * orientation).normalized();
}

}  // namespace topple::structure
