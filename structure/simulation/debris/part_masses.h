#pragma once
// Mass properties of every part of a building in one combination, and of bodies made of parts.
#include <vector>

#include "model/index_of.h"
#include "simulation/debris/mass_properties.h"
#include "topple/structure/standing_frame.h"

namespace topple::structure {

class PartMasses {
 public:
  /// Throws InputError naming a member or panel whose mass is not above zero.
  PartMasses(const Building& building, CombinationId combination, const StandingFrame& frame);

  [[nodiscard]] const MassProperties& of(MemberId id) const { return members_[index_of(id)]; }
  [[nodiscard]] const MassProperties& of(PanelId id) const { return panels_[index_of(id)]; }
  [[nodiscard]] const MassProperties& of(NodeId id) const { return nodes_[index_of(id)]; }
  [[nodiscard]] MassProperties of(const Detached& part) const;
  /// Of a stretch of a member, in distances from its first end, the upper limit left out unless it is the member's end.
  [[nodiscard]] MassProperties of(const Building& building, MemberId id, double from, double to) const;
  /// What is left of a broken panel.
  void set(PanelId id, const MassProperties& left) { panels_[index_of(id)] = left; }

  /// The rest is the building's.
  template <class Archive>
  void serialize(Archive& archive) {
    auto& [members, panels, nodes, member_loads] = *this;
    archive(panels);
  }

 private:
  std::vector<MassProperties> members_, panels_, nodes_;
  std::vector<std::vector<solver::BeamLoad>> member_loads_;  ///< in the combination
};

}  // namespace topple::structure
