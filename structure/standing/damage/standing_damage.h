#pragma once
// Damage to a standing frame: each change goes to the energy account, segmentation,
// bearings, statics, loads and joints alike.
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "failure/bracing.h"
#include "standing/damage/break_log.h"
#include "standing/damage/shell_damage.h"
#include "standing/slow_changes.h"

namespace topple::structure {

class StandingDamage {
 public:
  /// What it changes; all of it must outlive it.
  struct Parts {
    StructuralState& state;
    YieldingWay& yielding;
    BreakLog& breaks;
    SlowChanges& slow;
    Departures& departures;
    ShellDamage& shells;
  };
  explicit StandingDamage(const Parts& parts);

  void break_joint(JointId joint, BreakCause cause) { break_joints({&joint, 1}, cause); }
  /// Those of them that hold, together: each is told as it was before any of them broke.
  void break_joints(std::span<const JointId> together, BreakCause cause);
  /// A joint that holds lets go, whatever the cause. `line`: index of its line in the log, -1 when it has none.
  void let_go(JointId joint, int line = -1);
  /// No effect on what stands no more.
  void remove(MemberId member);
  void remove(PanelId panel);
  /// Only this remains of a panel that stands; edges of which nothing is left break.
  void fracture(PanelId panel, const PanelRemains& remains);

  // What damage leaves open, for the release; each in order of id, handed out once.
  [[nodiscard]] bool leaves_open() const { return !half_held_.empty() || !unbraced_.empty(); }
  /// Members that have just lost one end.
  [[nodiscard]] std::vector<MemberId> extract_half_held();
  /// Joints of posts that have lost the last of what braced them.
  [[nodiscard]] std::vector<JointId> extract_unbraced();

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [to, bracing, half_held, unbraced] = *this;
    if (bracing) archive(*bracing);  // the rules say whether it is there
    archive(half_held, unbraced);
  }

 private:
  void lose_member_joint(JointId joint, int line);
  void break_bare_edges(PanelId panel, const PanelRemains& remains);
  void condense(PanelId panel, const PanelRemains& remains);

  Parts to_;
  std::optional<ClassicBracing> bracing_;
  std::vector<MemberId> half_held_;
  std::vector<JointId> unbraced_;
};

}  // namespace topple::structure
