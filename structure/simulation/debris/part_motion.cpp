#include "simulation/debris/part_motion.h"

#include <Eigen/Geometry>

#include "standing/motion/rigid_displacement_fit.h"

namespace topple::structure {
namespace {

/// `value`: displacement or velocity of a node.
template <class Value>
PartMotion nearest(const StandingFrame& frame, Part part, const Vec3& at, const Value& value) {
  const Building& building = frame.building();
  // An end or corner that has let go does not go with its node any more.
  std::vector<NodeId> nodes;
  const auto take = [&](NodeId node, bool holds) {
    if (holds && frame.stands(node)) nodes.push_back(node);
  };
  if (part.member.valid()) {
    for (int end = 0; end < 2; ++end)
      take(building[part.member].nodes[static_cast<std::size_t>(end)], frame.intact(building.joint(part.member, end)));
  } else {
    for (int k = 0; k < 4; ++k)
      take(building[part.panel].nodes[static_cast<std::size_t>(k)],
           frame.intact(building.joint(part.panel, k)) || frame.intact(building.joint(part.panel, (k + 3) % 4)));
  }
  PartMotion motion;
  if (nodes.empty()) return motion;
  RigidDisplacementFit places;
  Vec3 rotation = Vec3::Zero();
  for (const NodeId node : nodes) {
    const Vec6 u = value(node);
    places.add_point(1, building[node].position, u.head<3>());
    rotation += u.tail<3>() / static_cast<double>(nodes.size());
  }
  // Where its nodes' places tell of a turn, that counts; about a line of them their rotations do.
  motion.turned = places.turned(rotation);
  motion.moved = places.moved() + motion.turned.cross(at - places.centre());
  return motion;
}

}  // namespace

PartMotion rigid_displacement(const StandingFrame& frame, Part part, const Vec3& at) {
  return nearest(frame, part, at, [&](NodeId node) -> const Vec6& { return frame.displacement(node); });
}

PartMotion rigid_velocity(const StandingFrame& frame, Part part, const Vec3& at) {
  return nearest(frame, part, at, [&](NodeId node) { return frame.velocity(node); });
}

PartMotion foreseen_acceleration(StandingFrame& frame, Part part, const Vec3& at) {
  return nearest(frame, part, at, [&](NodeId node) { return frame.foreseen_acceleration(node); });
}

}  // namespace topple::structure
