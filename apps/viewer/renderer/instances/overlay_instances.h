#pragma once
// What is drawn over the building: diagrams, arrows, marks, cables.
#include <array>

#include "renderer/camera.h"
#include "renderer/instances/part_instances.h"
#include "renderer/shapes/overlay.h"

namespace topple::viewer {

class OverlayInstances {
 public:
  /// The building must outlive it.
  OverlayInstances(const structure::Building& building, const Bounds& bounds);

  /// Diagrams, arrows and marks of hinges: of what stands, and worked out again only with that.
  void draw_forces(const PartInstances& parts, const Snapshot& snapshot, const ViewOptions& options);
  /// Marks and cables, which follow what moves.
  void draw_marks(const PartInstances& parts, const Snapshot& snapshot, const ViewOptions& options);

  /// Loads and contacts; reactions, which come from below the ground.
  [[nodiscard]] const InstanceBatch<RigidInstance>& arrows() const { return arrows_; }
  [[nodiscard]] const InstanceBatch<RigidInstance>& buried_arrows() const { return buried_arrows_; }
  /// A ball at each joint that has yielded.
  [[nodiscard]] const InstanceBatch<RigidInstance>& hinges() const { return hinges_; }
  /// Along members.
  [[nodiscard]] const Overlay& diagrams() const { return diagrams_; }
  /// The least and greatest value of the diagram that is drawn (N, N m).
  [[nodiscard]] const std::array<double, 2>& diagram_range() const { return diagram_range_; }
  /// Around what is hovered over and selected, where it now is.
  [[nodiscard]] const Overlay& marks() const { return marks_; }

 private:
  void draw_diagrams(const PartInstances& parts, const Snapshot& snapshot, const ViewOptions& options);
  void draw_arrows(const Snapshot& snapshot, const ViewOptions& options);
  void draw_hinges(const PartInstances& parts, const Snapshot& snapshot, const ViewOptions& options);
  void draw_cables(const Snapshot& snapshot);

  const structure::Building& building_;
  Bounds bounds_;
  InstanceBatch<RigidInstance> arrows_, buried_arrows_, hinges_;
  Overlay diagrams_, marks_;
  std::array<double, 2> diagram_range_{};
};

}  // namespace topple::viewer
