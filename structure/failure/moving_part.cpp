#include "failure/moving_part.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "model/index_of.h"

namespace topple::structure {

namespace {

/// Below this share of the largest motion a node stands still: far above the noise of a null vector (1e-8), below the
/// ratio of motions inside a part that swings (its node next to the hinge moves at least by a member's share of it).
constexpr double moving_limit = 1e-4;

double mean_member_length(const Building& building) {
  double sum = 0;
  for (const Member& member : building.members) sum += member.length;
  return building.members.empty() ? 1 : sum / static_cast<double>(building.members.size());
}

/// Size of a motion with rotations measured at the end of a lever.
double size(const Vec6& motion, double lever) {
  return std::max(motion.head<3>().cwiseAbs().maxCoeff(), lever * motion.tail<3>().cwiseAbs().maxCoeff());
}

}  // namespace

MovingPart find_moving_part(const Building& building, const Segmentation& segments, const FrameMechanism& mechanism) {
  const double lever = mean_member_length(building);
  std::vector<char> node_moves(building.nodes.size(), 0), member_moves(building.members.size(), 0);
  double largest = 0;
  for (std::size_t n = 0; n < building.nodes.size(); ++n)
    if (segments.label(NodeId(n)) >= 0) largest = std::max(largest, size(mechanism.motion[n], lever));
  const double limit = moving_limit * largest;
  MovingPart part;
  for (std::size_t n = 0; n < building.nodes.size(); ++n)
    node_moves[n] = largest > 0 && segments.label(NodeId(n)) >= 0 && size(mechanism.motion[n], lever) > limit;
  for (std::size_t m = 0; m < building.members.size(); ++m) {
    const Member& member = building.members[m];
    if (segments.label(MemberId(m)) < 0) continue;
    for (int end = 0; end < 2; ++end) {
      const auto e = static_cast<std::size_t>(end);
      const JointId joint = building.joint(MemberId(m), end);
      if (!segments.holds(joint) || !node_moves[index_of(member.nodes[e])]) continue;
      const Vec6& motion = mechanism.motion[index_of(member.nodes[e])];
      Vec6 handed;
      handed << member.axes * (motion.head<3>() + motion.tail<3>().cross(member.offsets[e])),
          member.axes * motion.tail<3>();
      for (int c = 0; c < 6; ++c)
        if (building[joint].stiffness(c) == 0) handed(c) = 0;
      if (size(handed, lever) > limit) member_moves[m] = 1;
    }
  }
  const bool any_member = std::find(member_moves.begin(), member_moves.end(), 1) != member_moves.end();
  if (!any_member) {
    // Only nodes turn: nothing would leave. What hangs on the node that moves most goes, so that the search ends.
    std::fill(node_moves.begin(), node_moves.end(), 0);
    const NodeId most = mechanism.nodes.front();
    node_moves[index_of(most)] = 1;
    for (std::size_t m = 0; m < building.members.size(); ++m)
      for (int end = 0; end < 2; ++end)
        if (building.members[m].nodes[static_cast<std::size_t>(end)] == most &&
            segments.holds(building.joint(MemberId(m), end)) && segments.label(MemberId(m)) >= 0)
          member_moves[m] = 1;
  }
  for (std::size_t n = 0; n < node_moves.size(); ++n)
    if (node_moves[n]) part.nodes.push_back(NodeId(n));
  for (std::size_t m = 0; m < member_moves.size(); ++m) {
    if (member_moves[m]) part.members.push_back(MemberId(m));
    if (segments.label(MemberId(m)) < 0) continue;
    for (int end = 0; end < 2; ++end) {
      const JointId joint = building.joint(MemberId(m), end);
      const NodeId node = building.members[m].nodes[static_cast<std::size_t>(end)];
      if (segments.holds(joint) && node_moves[index_of(node)] != member_moves[m]) part.holds.push_back(joint);
    }
  }
  return part;
}

bool hangs_loose(const Building& building, const Segmentation& segments, MemberId member) {
  if (segments.label(member) < 0) return false;
  const JointId first = building.joint(member, 0), second = building.joint(member, 1);
  if (segments.holds(first) == segments.holds(second)) return false;
  return (building[segments.holds(first) ? first : second].stiffness.array() == 0).any();
}

}  // namespace topple::structure
