#include "standing/energy/solved_frame.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "model/index_of.h"

namespace topple::structure {

bool SolvedFrame::solved(NodeId node) const { return node_solved[index_of(node)] != 0; }

bool SolvedFrame::stands(PanelId panel) const {
  return bearings.tracks(panel) ? bearings.stands(panel) : segments.label(panel) >= 0;
}

bool SolvedFrame::stands(const PlacedLoad& placed) const {
  const auto bears = [&](const auto& bearing) { return stands(bearing.first); };
  return std::all_of(placed.members.begin(), placed.members.end(), bears) &&
         std::all_of(placed.nodes.begin(), placed.nodes.end(), bears);
}

int SolvedFrame::component(const PlacedLoad& placed) const {
  if (placed.panel.valid()) return component(placed.panel);
  if (placed.members.empty()) return statics.component(placed.nodes.front().first);
  return statics.component(placed.members.front().first);
}

solver::Vec12 SolvedFrame::rigid_ends(MemberId member, const Vec6& first, const Vec6& second) const {
  const Member& own = building[member];
  solver::Vec12 local;
  local << own.axes * (first.head<3>() + first.tail<3>().cross(own.offsets[0])), own.axes * first.tail<3>(),
      own.axes * (second.head<3>() + second.tail<3>().cross(own.offsets[1])), own.axes * second.tail<3>();
  return local;
}

solver::Vec12 SolvedFrame::rigid_ends(MemberId member) const {
  const auto& nodes = building[member].nodes;
  return rigid_ends(member, statics.displacement(nodes[0]), statics.displacement(nodes[1]));
}

SolvedMember SolvedFrame::shape(MemberId member) const {
  return {statics.beam(member), statics.elastic_end_forces(member),
          rigid_ends(member) - statics.plastic_rotations(member), applied[index_of(member)]};
}

LoadWork SolvedFrame::load_work(int component) const {
  LoadWork sum;
  for (MemberId member : statics.members(component)) {
    if (!stands(member)) continue;
    const auto own = loads.own_and_handed(member);
    if (!own.empty()) sum += shape(member).work(own, local_gravity(member));
  }
  for (NodeId node : statics.nodes(component)) {
    if (!solved(node)) continue;
    const Vec6& u = statics.displacement(node);
    sum += work(loads.own_and_handed(node), u, gravity);
    sum.other += loads.event_load(node).dot(u);
  }
  return sum;
}

}  // namespace topple::structure
