#include "analysis/divided_building.h"

#include "model/index_of.h"
#include "topple/structure/join_shells.h"

namespace topple::structure {

DividedBuilding::DividedBuilding(const Building& whole) : divided_(whole), nodes_(whole.nodes.size()) {
  join_shells(divided_);
  find_pieces(whole.members.size());
  find_joints(whole);
}

/// A node where a member is divided is its own: one piece ends there and one begins.
void DividedBuilding::find_pieces(std::size_t members) {
  std::vector<MemberId> begins_at(divided_.nodes.size());
  for (std::size_t m = members; m < divided_.members.size(); ++m)
    begins_at[index_of(divided_.members[m].nodes[0])] = MemberId(m);
  member_.resize(divided_.members.size());
  for (std::size_t m = 0; m < members; ++m) {
    pieces_.emplace_back();
    for (MemberId piece(m); piece.valid();) {
      pieces_.back().push_back(piece);
      member_[index_of(piece)] = MemberId(m);
      const NodeId end = divided_[piece].nodes[1];
      piece = given(end) ? MemberId() : begins_at[index_of(end)];
    }
  }
}

void DividedBuilding::find_joints(const Building& whole) {
  joint_.resize(divided_.joints.size());
  for (std::size_t m = 0; m < pieces_.size(); ++m) {
    joint_[index_of(divided_.joint(pieces_[m].front(), 0))] = whole.joint(MemberId(m), 0);
    joint_[index_of(divided_.joint(pieces_[m].back(), 1))] = whole.joint(MemberId(m), 1);
  }
  for (std::size_t p = 0; p < whole.panels.size(); ++p)
    for (int edge = 0; edge < 4; ++edge)
      joint_[index_of(divided_.joint(PanelId(p), edge))] = whole.joint(PanelId(p), edge);
}

}  // namespace topple::structure
