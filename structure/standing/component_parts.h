#pragma once
// The connected components that a building has at the start, each served by an analysis of its own, and what belongs to
// them for good.
#include <vector>

#include "standing/statics/frame_statics.h"

namespace topple::structure {

struct ComponentParts {
  ComponentParts(const Building& building, const FrameStatics& statics)
      : joints(static_cast<std::size_t>(statics.components())),
        edges(joints.size()),
        panels(joints.size()),
        building_(building),
        statics_(statics) {
    for (std::size_t j = 0; j < building.joints.size(); ++j) {
      if (!building.joints[j].capacity.breakable) continue;
      const auto c = static_cast<std::size_t>(of(JointId(j)));
      joints[c].push_back(JointId(j));
      if (!building.joints[j].member.valid()) edges[c].push_back(JointId(j));
    }
    for (std::size_t p = 0; p < building.panels.size(); ++p)
      panels[static_cast<std::size_t>(of(PanelId(p)))].push_back(PanelId(p));
  }

  [[nodiscard]] int of(PanelId panel) const { return statics_.component(building_[panel].nodes[0]); }
  [[nodiscard]] int of(JointId joint) const {
    const Joint& own = building_[joint];
    return own.member.valid() ? statics_.component(own.member) : of(own.panel);
  }
  [[nodiscard]] int of(const ContactPlace& place) const {
    if (place.node.valid()) return statics_.component(place.node);
    return place.member.valid() ? statics_.component(place.member) : of(place.panel);
  }

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [breakable, of_edges, of_panels, building, statics] = *this;
    archive(breakable);  // the others follow from the building
  }

  // Per component, each in order of id:
  std::vector<std::vector<JointId>> joints;  ///< with a capacity
  std::vector<std::vector<JointId>> edges;   ///< those of them that are edges of panels
  std::vector<std::vector<PanelId>> panels;

 private:
  const Building& building_;
  const FrameStatics& statics_;
};

}  // namespace topple::structure
