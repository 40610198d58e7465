#pragma once
// A building's parts as the boxes that rigid body engines are given. Mass is weight over gravity.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "topple/structure/building.h"
#include "topple/structure/frame.h"

namespace topple::bench {

using namespace topple::structure;

struct Body {
  std::string name;
  double mass = 0;
  Vec3 half_extents, centre;
  Mat3 axes;  // rows
};

/// Order of bodies and joints: posts, beams and braces, panels.
inline std::vector<std::size_t> members_in_order(const Building& building) {
  std::vector<std::size_t> order(building.members.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_partition(order.begin(), order.end(),
                        [&](std::size_t i) { return building.members[i].kind == MemberKind::post; });
  return order;
}

inline double total(const std::vector<solver::BeamLoad>& loads, const Mat3& axes) {
  double down = 0;
  for (const solver::BeamLoad& load : loads) {
    const solver::Vec6 sum = load.kind == solver::BeamLoad::Kind::distributed
                                 ? solver::Vec6((load.first + load.last) / 2 * (load.to - load.from))
                                 : load.first;
    down -= (axes.transpose() * sum.head<3>()).z();
  }
  return down;
}

inline Vec3 position(const Building& building, NodeId node) { return building[node].position; }

inline Body member_body(const Building& building, const Member& member, double weight) {
  const Section& section = building[member.section];
  const auto side = [](double given, double inertia, double area) {
    return given > 0 ? given : std::sqrt(12 * inertia / area);
  };
  Body body;
  body.name = member.name;
  body.mass = weight / building.gravity;
  body.half_extents = Vec3(member.length, side(section.width, section.Iz, section.area),
                           side(section.depth, section.Iy, section.area)) /
                      2;
  body.centre = (position(building, member.nodes[0]) + member.offsets[0] + position(building, member.nodes[1]) +
                 member.offsets[1]) /
                2;
  body.axes = member.axes;
  return body;
}

inline Body panel_body(const Building& building, const Panel& panel, double& area) {
  Vec3 low = Vec3::Constant(1e300), high = -low, centre = Vec3::Zero();
  for (const NodeId node : panel.nodes) {
    const Vec3 local = panel.axes * position(building, node);
    low = low.cwiseMin(local);
    high = high.cwiseMax(local);
    centre += position(building, node) / 4;
  }
  Body body;
  body.name = panel.name;
  body.half_extents = Vec3(high.x() - low.x(), high.y() - low.y(), panel.thickness) / 2;
  body.centre = centre;
  body.axes = panel.axes;
  area = 4 * body.half_extents.x() * body.half_extents.y();
  return body;
}

/// A line of a scene (baseline/scene.h).
inline void write(const Body& body, std::ostream& out) {
  const Mat3 rotation = body.axes.transpose();
  const Eigen::Quaterniond q(rotation);
  out << "body " << body.name << ' ' << body.mass << ' ' << body.half_extents.transpose() << ' '
            << body.centre.transpose() << ' ' << q.w() << ' ' << q.x() << ' ' << q.y() << ' ' << q.z() << '\n';
}

}  // namespace topple::bench
