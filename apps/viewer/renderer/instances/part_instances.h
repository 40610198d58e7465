#pragma once
// How each member and panel of a building is drawn: at rest in its colours, bent as it stands, or moved as one body
// with the shape that it had when it let go.
#include <vector>

#include "renderer/instances/instance_parts.h"

namespace topple::viewer {

/// A part that has come off, and its body's place in Snapshot::bodies.
struct MovingPart {
  std::size_t index;
  int body;
};

class PartInstances {
 public:
  /// Places are relative to `origin`. The building must outlive it.
  PartInstances(const structure::Building& building, const glm::dvec3& origin);

  /// The largest of the values that Scale::largest_in_view refers to: what colours are by, until it is found again.
  void find_largest(const Snapshot& snapshot, const ViewOptions& options);
  [[nodiscard]] double largest() const { return largest_; }
  void colour_member(std::size_t index, const Snapshot& snapshot, const ViewOptions& options);
  void colour_panel(std::size_t index, const Snapshot& snapshot, const ViewOptions& options);

  /// As coloured last.
  [[nodiscard]] const MemberInstance& member(std::size_t index) const { return members_[index]; }
  [[nodiscard]] MemberInstance standing_member(std::size_t index, const Snapshot& snapshot,
                                               const ViewOptions& options) const;
  [[nodiscard]] PanelInstance standing_panel(std::size_t index, const Snapshot& snapshot,
                                             const ViewOptions& options) const;
  [[nodiscard]] MemberInstance moved_member(std::size_t index, const BodyMotion& motion,
                                            const Snapshot& snapshot) const;
  [[nodiscard]] PanelInstance moved_panel(std::size_t index, const BodyMotion& motion, const Snapshot& snapshot) const;

 private:
  const structure::Building& building_;
  glm::dvec3 origin_;
  std::vector<MemberInstance> members_;
  std::vector<PanelInstance> panels_;
  double largest_ = 0;
};

}  // namespace topple::viewer
