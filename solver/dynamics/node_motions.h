#pragma once
// The motion by nodes at both ends of the substep under way, or of the last one, computed as far as it is needed.
#include "assembly/frame_system.h"
#include "dynamics/motion_state.h"

namespace topple::solver {

class NodeMotions {
 public:
  explicit NodeMotions(std::size_t nodes);
  /// The motion is another one.
  void forget() { known_ = end_known_ = false; }
  /// Displacements at the end. False: they were there already.
  bool evaluate_end(const FrameSystem& system, const MotionState& end);
  /// And all the others.
  void evaluate(const FrameSystem& system, const MotionState& start, const MotionState& end);
  /// Displacements at the start alone.
  void set_start(const FrameSystem& system, const MotionState& start);

  [[nodiscard]] const NodeMotion& start() const { return start_; }
  [[nodiscard]] const NodeMotion& end() const { return end_; }

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [start, end, known, end_known] = *this;
    archive(start, end, known, end_known);
  }

 private:
  NodeMotion start_, end_;
  bool known_ = false, end_known_ = false;  ///< all of them, the displacements at the end
};

}  // namespace topple::solver
