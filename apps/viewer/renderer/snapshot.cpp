#include "renderer/snapshot.h"

namespace topple::viewer {

using structure::Building;

Snapshot undeformed(const Building& building) {
  Snapshot snapshot;
  auto answer = std::make_shared<FrameAnswer>();
  answer->displacements.assign(building.nodes.size(), Eigen::Matrix<float, 6, 1>::Zero());
  answer->joints.resize(building.joints.size());
  auto membership = std::make_shared<Membership>();
  membership->member.assign(building.members.size(), part_stands);
  membership->panel.assign(building.panels.size(), part_stands);
  membership->segment.assign(building.members.size(), 0);
  membership->broken.resize(building.panels.size());
  membership->supports.assign(building.supports.size(), true);
  membership->members_standing = static_cast<int>(building.members.size());
  membership->panels_standing = static_cast<int>(building.panels.size());
  snapshot.answer = std::move(answer);
  snapshot.membership = std::move(membership);
  return snapshot;
}

Snapshot interpolate(const Snapshot& earlier, const Snapshot& later, double share) {
  Snapshot between = later;
  between.time = earlier.time + share * (later.time - earlier.time);
  auto before = earlier.bodies.begin();
  for (BodyPose& body : between.bodies) {
    while (before != earlier.bodies.end() && before->id < body.id) ++before;
    if (before == earlier.bodies.end()) break;
    if (before->id != body.id || body.asleep) continue;
    body.position = before->position + share * (body.position - before->position);
    body.orientation = before->orientation.slerp(share, body.orientation);
  }
  return between;
}

}  // namespace topple::viewer
