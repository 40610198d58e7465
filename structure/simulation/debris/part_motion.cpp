#include "simulation/debris/part_motion.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "model/point_inertia.h"

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
  const auto count = static_cast<double>(nodes.size());
  Vec3 centre = Vec3::Zero();
  for (const NodeId node : nodes) {
    const Vec6 u = value(node);
    centre += building[node].position / count;
    motion.moved += u.head<3>() / count;
    motion.turned += u.tail<3>() / count;
  }
  // Where its nodes' places tell of a turn, that counts; about a line of them their rotations do.
  Mat3 spread = Mat3::Zero();
  Vec3 turning = Vec3::Zero();
  for (const NodeId node : nodes) {
    const Vec3 r = building[node].position - centre;
    spread += point_inertia(1, r);
    turning += r.cross(Vec3(value(node).template head<3>() - motion.moved));
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(spread);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    constexpr double on_a_line = 1e-6;
    if (!(axes.eigenvalues()(axis) > on_a_line * axes.eigenvalues()(2))) continue;
    const Vec3 along = axes.eigenvectors().col(axis);
    motion.turned += (along.dot(turning) / axes.eigenvalues()(axis) - along.dot(motion.turned)) * along;
  }
  motion.moved += motion.turned.cross(at - centre);
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
