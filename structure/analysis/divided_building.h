#pragma once
// A building whose members are divided where shell panels hang on them (join_shells.h), and what its parts were.
#include <vector>

#include "model/index_of.h"
#include "topple/structure/building.h"

namespace topple::structure {

/// Nodes and members keep their ids; a member's first piece has the member's own. Other pieces and their nodes and
/// joints come after those that the building had.
class DividedBuilding {
 public:
  explicit DividedBuilding(const Building& whole);

  [[nodiscard]] const Building& building() const { return divided_; }
  /// Of a member of the whole building, from its first end to its second.
  [[nodiscard]] const std::vector<MemberId>& pieces(MemberId member) const { return pieces_[index_of(member)]; }
  /// The member that this one is a piece of.
  [[nodiscard]] MemberId member(MemberId piece) const { return member_[index_of(piece)]; }
  /// The joint of the whole building; not valid for one between pieces.
  [[nodiscard]] JointId joint(JointId divided) const { return joint_[index_of(divided)]; }
  /// The node is one of the whole building.
  [[nodiscard]] bool given(NodeId node) const { return index_of(node) < nodes_; }

 private:
  void find_pieces(std::size_t members);
  void find_joints(const Building& whole);

  Building divided_;
  std::size_t nodes_;
  std::vector<std::vector<MemberId>> pieces_;  ///< per member of the whole building
  std::vector<MemberId> member_;               ///< per member of the divided one
  std::vector<JointId> joint_;                 ///< per joint of the divided one
};

}  // namespace topple::structure
