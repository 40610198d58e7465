#pragma once
// What of a building stands: members, nodes and panels by the segments that they belong to, and the joints that hold.
#include <vector>

#include "failure/panel_bearings.h"
#include "failure/segmentation.h"
#include "topple/structure/standing_frame.h"

namespace topple::structure {

class StandingParts {
 public:
  explicit StandingParts(const Building& building);

  [[nodiscard]] const Building& building() const { return building_; }
  [[nodiscard]] bool stands(MemberId member) const { return segments.label(member) >= 0; }
  [[nodiscard]] bool stands(NodeId node) const { return segments.label(node) >= 0; }
  [[nodiscard]] bool stands(PanelId panel) const {
    return bearings.tracks(panel) ? bearings.stands(panel) : segments.label(panel) >= 0;
  }
  [[nodiscard]] bool holds(JointId joint) const;
  /// Of the segment that the joint's part belongs to, -1 when that left.
  [[nodiscard]] int label(JointId joint) const;
  [[nodiscard]] bool standing(JointId joint) const { return holds(joint) && label(joint) >= 0; }
  /// Where it is in the undeformed building: an end of the axis, the middle of an edge.
  [[nodiscard]] Vec3 position(JointId joint) const;

  /// Segments are numbered from 0 in order of their least node, lone nodes left out. -1: it does not stand.
  [[nodiscard]] int segment(MemberId member) const;
  [[nodiscard]] int segment_count() const { return numbers().back(); }
  /// To be called when something broke.
  void forget_numbers() { numbers_.clear(); }
  /// True when all of these members that stand are one segment.
  [[nodiscard]] bool one_segment(const std::vector<MemberId>& members) const;

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [building, edges, graph, panels, numbers] = *this;
    archive(graph, panels, numbers);
  }

 private:
  [[nodiscard]] const std::vector<int>& numbers() const;

  const Building& building_;
  EdgeMembers edges_;

 public:
  Segmentation segments;
  PanelBearings bearings;

 private:
  mutable std::vector<int> numbers_;  ///< per label, and how many there are; empty: to be found
};

}  // namespace topple::structure
