#pragma once
// Mass, centre and inertia of parts and of bodies made of them. The mass of a part is its downward load in the
// combination over gravity, the same standing, falling and lying.
#include <vector>

#include "topple/structure/building.h"
#include "topple/structure/frame.h"

namespace topple::structure {

/// Of a rigid body, global axes of the undeformed building.
struct MassProperties {
  double mass = 0;
  Vec3 centre = Vec3::Zero();
  Mat3 inertia = Mat3::Zero();  ///< about the centre

  /// Joins another body to this one (parallel axes).
  void add(const MassProperties& other);
};
template <class Archive>
void serialize(Archive& archive, MassProperties& of) {
  auto& [mass, centre, inertia] = of;
  archive(mass, centre, inertia);
}

/// How a member's mass lies along its axis, from its first end.
struct LineMass {
  double mass = 0, first_moment = 0, second_moment = 0;  ///< kg, kg m, kg m2
};
/// Downward share of the loads over gravity. `loads` in the member's axes, as PartLoads has them.
[[nodiscard]] LineMass line_mass(const Member& member, const std::vector<solver::BeamLoad>& loads, double gravity);

/// A prism of the member's section around its axis, its mass spread as `line`.
[[nodiscard]] MassProperties member_mass(const Building& building, const Member& member, const LineMass& line);
/// A plate of the panel's outline less its openings, with this mass.
[[nodiscard]] MassProperties panel_mass(const Building& building, const Panel& panel, double mass);
[[nodiscard]] MassProperties point_mass(const Vec3& at, double mass);
[[nodiscard]] MassProperties sphere_mass(const Vec3& at, double mass, double radius);

/// Start of the member's axis: its first node and its rigid offset.
[[nodiscard]] inline Vec3 member_start(const Building& building, const Member& member) {
  return building[member.nodes[0]].position + member.offsets[0];
}
/// Volume of solid material, m3.
[[nodiscard]] double member_volume(const Building& building, const Member& member);
[[nodiscard]] double panel_volume(const Building& building, const Panel& panel);

}  // namespace topple::structure
