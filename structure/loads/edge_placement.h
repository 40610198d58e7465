#pragma once
// A line load along a panel's edge, placed on the members there, or on the nodes where there are none.
#include "topple/structure/frame.h"

namespace topple::structure {

/// Force per length of edge, global, linear from `first` at the distance `from` of the edge's first node to `last`.
struct EdgeLoad {
  double from = 0, to = 0;
  Vec3 first = Vec3::Zero(), last = Vec3::Zero();

  [[nodiscard]] Vec3 at(double s) const { return first + (last - first) * ((s - from) / (to - from)); }
  [[nodiscard]] Vec3 resultant() const { return (first + last) * (0.5 * (to - from)); }
  /// Integral of force times the distance from `from`.
  [[nodiscard]] Vec3 moment() const { return (first + 2 * last) * ((to - from) * (to - from) / 6); }
};

class EdgePlacement {
 public:
  /// `member_stands` empty: all stand.
  EdgePlacement(const Building& building, const EdgeMembers& edges, PanelId panel, int edge,
                const std::vector<bool>& member_stands);

  [[nodiscard]] double length() const { return length_; }
  /// Appends what the members and nodes get; force and moments are those of `load`. Over a rigid offset it goes to the
  /// node; where a member is missing, by the lever rule to the nodes at the ends of the gap, or to the ends of what
  /// stands when the gap reaches a corner.
  void add(const EdgeLoad& load, TributaryLoads& result) const;

 private:
  struct Stretch {
    MemberId member;  ///< invalid: a gap
    NodeId first, last;
    double from = 0, to = 0;
  };
  void add_to_member(const Stretch& stretch, const EdgeLoad& load, TributaryLoads& result) const;
  void add_over_gap(std::size_t gap, const EdgeLoad& load, TributaryLoads& result) const;
  void add_to_node(NodeId node, const EdgeLoad& load, TributaryLoads& result) const;
  void share_by_lever(NodeId a, double at_a, NodeId b, double at_b, const EdgeLoad& load, TributaryLoads& result) const;
  [[nodiscard]] double position_of(NodeId node) const { return direction_.dot(building_[node].position - start_); }

  const Building& building_;
  Vec3 start_ = Vec3::Zero(), direction_ = Vec3::Zero();
  double length_ = 0;
  std::vector<Stretch> stretches_;
};

}  // namespace topple::structure
