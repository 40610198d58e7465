#pragma once
// What stands as the solver has it now, in the terms in which its energies are counted: shapes of members, and the work
// of loads.
#include <vector>

#include "failure/segmentation.h"
#include "loads/frame_loads.h"
#include "model/solved_member.h"
#include "standing/statics/frame_statics.h"

namespace topple::structure {

/// Looks at parts of a standing frame, which must outlive it, and owns nothing but the direction of gravity.
struct SolvedFrame {
  const Building& building;
  const Segmentation& segments;
  const PanelBearings& bearings;
  const FrameLoads& loads;
  const FrameStatics& statics;
  const std::vector<char>& node_solved;                       ///< per node: the solver holds it
  const std::vector<std::vector<solver::BeamLoad>>& applied;  ///< per member: what the solver has
  Vec3 gravity = -Vec3::UnitZ();                              ///< direction along which work counts as gravity's

  [[nodiscard]] bool solved(NodeId node) const;
  [[nodiscard]] bool stands(MemberId member) const { return segments.label(member) >= 0; }
  [[nodiscard]] bool stands(NodeId node) const { return segments.label(node) >= 0; }
  /// With all that bears it.
  [[nodiscard]] bool stands(PanelId panel) const;
  /// All that bears the load stands.
  [[nodiscard]] bool stands(const PlacedLoad& placed) const;
  [[nodiscard]] int component(PanelId panel) const { return statics.component(building[panel].nodes[0]); }
  [[nodiscard]] int component(const PlacedLoad& placed) const;

  /// Direction of gravity in the member's axes.
  [[nodiscard]] Vec3 local_gravity(MemberId member) const { return building[member].axes * gravity; }
  /// Displacements of the rigid ends at a member's ends, local axes, from those of its nodes.
  [[nodiscard]] solver::Vec12 rigid_ends(MemberId member, const Vec6& first, const Vec6& second) const;
  /// The same by the answer.
  [[nodiscard]] solver::Vec12 rigid_ends(MemberId member) const;
  [[nodiscard]] SolvedMember shape(MemberId member) const;
  /// Loads times displacements of all that stands of a component, contacts apart, J.
  [[nodiscard]] LoadWork load_work(int component) const;
};
template <class Archive>
void serialize(Archive& archive, SolvedFrame& frame) {
  auto& [building, segments, bearings, loads, statics, node_solved, applied, gravity] = frame;
  archive(gravity);
}

}  // namespace topple::structure
