#pragma once
// What hangs on nothing leaves a standing frame: parts without a support, members that can swing by themselves, posts
// without bracing, the part of a mechanism that moves, and posts that buckled inside.
#include <map>
#include <vector>

#include "standing/damage/standing_damage.h"

namespace topple::structure {

class StandingRelease {
 public:
  /// What it changes; all of it must outlive it.
  struct Parts {
    StructuralState& state;
    YieldingWay& yielding;
    BreakLog& breaks;
    Departures& departures;
    ShellDamage& shells;
    StandingDamage& damage;
  };
  explicit StandingRelease(const Parts& parts) : to_(parts), in_mechanism_(parts.state.building.members.size(), 0) {}

  /// All that has lost its hold.
  void release();
  /// The part that moves is cut free: it leaves with the next release().
  void cut_free(const FrameMechanism& mechanism);
  /// The member leaves with both of its joints holding: each piece goes on hanging by one. `inside`: of its length,
  /// from its first end.
  void cut_in_two(MemberId post, double inside);

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [to, in_mechanism, hanging, cut_inside] = *this;
    archive(in_mechanism, hanging, cut_inside);
  }

 private:
  void extract_unanchored();
  void leave(const std::vector<Segmentation::Part>& loose, std::vector<Detached>& leaving);
  [[nodiscard]] bool release_loose_members();
  [[nodiscard]] bool snap_unbraced();
  void release_moving_shells(const std::vector<NodeId>& moving);
  void let_hang(JointId joint);

  Parts to_;
  std::vector<char> in_mechanism_;         ///< per member: it moves, and is about to leave
  std::vector<JointId> hanging_;           ///< joints that let go of what moves, to be handed out with it
  std::map<MemberId, double> cut_inside_;  ///< posts that are about to leave, cut in two
};

}  // namespace topple::structure
