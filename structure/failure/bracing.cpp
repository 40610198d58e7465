#include "failure/bracing.h"

#include "model/index_of.h"

namespace topple::structure {

ClassicBracing::ClassicBracing(const Building& building)
    : bracing_node_(building.joints.size(), -1), left_(building.nodes.size(), 0), braced_(building.nodes.size()) {
  for (std::size_t j = 0; j < 2 * building.members.size(); ++j) {
    const Joint& joint = building.joints[j];
    const Member& member = building[joint.member];
    const NodeId node = member.nodes[static_cast<std::size_t>(joint.end)];
    if (member.kind != MemberKind::post) {
      bracing_node_[j] = node.index;
      ++left_[index_of(node)];
    } else if (joint.capacity.breakable) {
      braced_[index_of(node)].push_back(JointId(j));
    }
  }
}

const std::vector<JointId>& ClassicBracing::lose(JointId joint) {
  int& node = bracing_node_[index_of(joint)];
  if (node < 0) return none_;
  const auto n = static_cast<std::size_t>(node);
  node = -1;
  return --left_[n] == 0 ? braced_[n] : none_;
}

}  // namespace topple::structure
