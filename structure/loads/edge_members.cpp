#include <algorithm>

#include "model/index_of.h"
#include "topple/structure/frame.h"

namespace topple::structure {

namespace {

/// Tolerance, relative to the edge's length, within which a node counts as lying on the edge.
constexpr double on_edge = 1e-6;

/// The chain of members from node a straight to node b, empty when they do not reach.
std::vector<MemberId> chain(const Building& building, const std::vector<std::vector<MemberId>>& at_node, NodeId a,
                            NodeId b) {
  const Vec3 start = building[a].position;
  const Vec3 edge = building[b].position - start;
  const double length = edge.norm();
  const auto place = [&](NodeId node) { return (building[node].position - start).dot(edge) / length; };
  const auto lies_on = [&](NodeId node) {
    const Vec3 away = building[node].position - start;
    return (away - edge * (away.dot(edge) / (length * length))).norm() <= on_edge * length;
  };
  std::vector<MemberId> found;
  for (NodeId at = a; at != b;) {
    MemberId next;
    NodeId reached;
    for (const MemberId id : at_node[index_of(at)]) {
      const Member& member = building[id];
      const NodeId other = member.nodes[0] == at ? member.nodes[1] : member.nodes[0];
      const double along = place(other);
      const bool forward = along > place(at) + on_edge * length && along <= length * (1 + on_edge);
      // Of several the nearest node, then the least id: the finest division is the one that is really there.
      if (forward && lies_on(other) && (!next.valid() || along < place(reached))) {
        next = id;
        reached = other;
      }
    }
    if (!next.valid()) return {};
    found.push_back(next);
    at = reached;
  }
  return found;
}

}  // namespace

EdgeMembers::EdgeMembers(const Building& building) : members_(4 * building.panels.size()) {
  if (building.panels.empty()) return;
  std::vector<std::vector<MemberId>> at_node(building.nodes.size());
  for (std::size_t i = 0; i < building.members.size(); ++i)
    for (const NodeId node : building.members[i].nodes) at_node[index_of(node)].push_back(MemberId(i));
  for (std::size_t p = 0; p < building.panels.size(); ++p)
    for (std::size_t edge = 0; edge < 4; ++edge)
      members_[4 * p + edge] =
          chain(building, at_node, building.panels[p].nodes[edge], building.panels[p].nodes[(edge + 1) % 4]);
}

}  // namespace topple::structure
