#pragma once
// A building's parts as the boxes that rigid body engines are given. Mass is weight over gravity.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
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

inline Body panel_body(const Building& building, const Panel& panel, const PanelAction& action) {
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
  const double area = 4 * body.half_extents.x() * body.half_extents.y();
  const double down = -action.body_force.z() + action.pressure * panel.axes(2, 2);
  body.mass = down * area / building.gravity;
  return body;
}

/// The post under each node, by its upper end.
inline std::map<int, MemberId> posts_below(const Building& building) {
  std::map<int, MemberId> below;
  for (std::size_t i = 0; i < building.members.size(); ++i)
    if (building.members[i].kind == MemberKind::post) below[building.members[i].nodes[1].index] = MemberId(i);
  return below;
}

/// A post is joined to the post below (or the ground: not valid) at its lower end; a beam at both ends to the lower
/// posts. `visit` takes the member, its end, the post and the point.
template <class Visit>
void visit_member_joints(const Building& building, const Visit& visit) {
  const std::map<int, MemberId> posts = posts_below(building);
  for (const std::size_t i : members_in_order(building)) {
    const Member& member = building.members[i];
    for (int end = 0; end < (member.kind == MemberKind::post ? 1 : 2); ++end) {
      const NodeId node = member.nodes[static_cast<std::size_t>(end)];
      const auto below = posts.find(node.index);
      visit(MemberId(i), end, below == posts.end() ? MemberId() : below->second, position(building, node));
    }
  }
}

/// At the middle of each edge, to the member there: a slab has four beams, a wall two beams and two posts. `visit`
/// takes the panel, its edge, the member and the point.
template <class Visit>
void visit_panel_joints(const Building& building, const Visit& visit) {
  const EdgeMembers edges(building);
  for (std::size_t i = 0; i < building.panels.size(); ++i) {
    const Panel& panel = building.panels[i];
    for (int edge = 0; edge < 4; ++edge) {
      const std::vector<MemberId>& along = edges.of(PanelId(i), edge);
      if (along.empty()) continue;
      const Vec3 middle = (position(building, panel.nodes[static_cast<std::size_t>(edge)]) +
                           position(building, panel.nodes[static_cast<std::size_t>((edge + 1) % 4)])) /
                          2;
      visit(PanelId(i), edge, along.front(), middle);
    }
  }
}

inline std::string joint_name(const std::string& part, int end) { return part + ':' + std::to_string(end + 1); }

/// A line of a scene (baseline/scene.h).
inline void write(const Body& body, std::ostream& out) {
  const Mat3 rotation = body.axes.transpose();
  const Eigen::Quaterniond q(rotation);
  out << "body " << body.name << ' ' << body.mass << ' ' << body.half_extents.transpose() << ' '
      << body.centre.transpose() << ' ' << q.w() << ' ' << q.x() << ' ' << q.y() << ' ' << q.z() << '\n';
}

}  // namespace topple::bench
