#pragma once
// Contact loads and softening come on slowly: their change moves R0 as much as R, so that no sudden-loss factor acts on
// them.
#include <utility>

#include "standing/damage/break_log.h"
#include "standing/joint_answers.h"

namespace topple::structure {

class SlowChanges {
 public:
  /// All must outlive it.
  SlowChanges(StructuralState& state, JointAnswers& answers, YieldingWay& yielding, BreakLog& breaks)
      : state_(state), answers_(answers), yielding_(yielding), breaks_(breaks) {}

  /// Stiffness has changed since the last answer.
  void soften() { softened_ = true; }
  [[nodiscard]] bool extract_softened() { return std::exchange(softened_, false); }
  /// Solves what changed slowly; what changed suddenly before is read as such.
  void lay();

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [state, answers, yielding, breaks, softened] = *this;
    archive(softened);
  }

 private:
  void laid(int component);

  StructuralState& state_;
  JointAnswers& answers_;
  YieldingWay& yielding_;
  BreakLog& breaks_;
  bool softened_ = false;
};

}  // namespace topple::structure
