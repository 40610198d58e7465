#include "design/bracing.h"

#include <algorithm>
#include <cmath>

#include "design/alignment_chart.h"
#include "model/index_of.h"

namespace topple::structure {

namespace {

constexpr double in_line = 1 - 1e-6;  // cosine between members of one axis
constexpr double holds_along = 0.5;   // cosine: what meets a member within 60 degrees of the direction holds it
constexpr double braced_ratio = 4;    // braces against posts: 80 % of the sidesway is taken off
constexpr double millimetre = 1e-3;

std::size_t index(auto id) { return index_of(id); }

Vec3 axis(const Member& member) { return member.axes.row(0).transpose(); }

int end_at(const Member& member, NodeId node) { return member.nodes[0] == node ? 0 : 1; }

/// Horizontal stiffness k d d' of what pushes back with k along the unit vector `d` in plan.
Eigen::Matrix2d along(const Vec3& direction, double stiffness) {
  const Vec2 flat = direction.head<2>();
  return stiffness * flat * flat.transpose();
}

}  // namespace

StoreyLevels storey_levels(const Building& building, const Member& member) {
  const double a = building[member.nodes[0]].position.z(), b = building[member.nodes[1]].position.z();
  return {std::lround(std::min(a, b) / millimetre), std::lround(std::max(a, b) / millimetre)};
}

bool turns_with(const Building& building, MemberId id, int end, const Vec3& about) {
  const Joint& joint = building[building.joint(id, end)];
  const Vec3 local = building[id].axes * about;
  for (int i = 1; i < 3; ++i)
    if (std::abs(local(i)) > holds_along && joint.stiffness(3 + i) == 0) return false;
  return true;
}

Bracing::Bracing(const Building& building)
    : building_(building),
      members_at_(building.nodes.size()),
      panels_at_(building.nodes.size()),
      support_of_(building.nodes.size(), -1),
      diaphragms_at_(building.nodes.size(), 0) {
  for (std::size_t m = 0; m < building.members.size(); ++m)
    for (const NodeId node : building.members[m].nodes) members_at_[index(node)].emplace_back(m);
  for (std::size_t p = 0; p < building.panels.size(); ++p)
    if (building.panels[p].model != PanelModel::cladding)
      for (const NodeId node : building.panels[p].nodes) panels_at_[index(node)].emplace_back(p);
  for (std::size_t s = 0; s < building.supports.size(); ++s)
    support_of_[index(building.supports[s].node)] = static_cast<int>(s);
  for (const Diaphragm& diaphragm : building.diaphragms)
    for (const NodeId node : diaphragm.nodes) ++diaphragms_at_[index(node)];
  find_storeys();
}

bool Bracing::holds(NodeId node, MemberId member, const Vec3& direction) const {
  if (const int s = support_of_[index(node)]; s >= 0) {
    const Vec6& stiffness = building_.supports[static_cast<std::size_t>(s)].stiffness;
    for (int i = 0; i < 3; ++i)
      if (std::abs(direction(i)) > holds_along && stiffness(i) > 0) return true;
  }
  if (diaphragms_at_[index(node)] > 0 && direction.head<2>().norm() > holds_along) return true;
  for (const PanelId id : panels_at_[index(node)]) {
    const double across = std::abs(direction.dot(building_[id].axes.row(2).transpose()));
    if (std::sqrt(std::max(0.0, 1 - across * across)) > holds_along) return true;
  }
  for (const MemberId other : members_at_[index(node)])
    if (other != member && std::abs(axis(building_[other]).dot(direction)) > holds_along) return true;
  return false;
}

MemberId Bracing::beyond(NodeId node, MemberId member, int direction) const {
  const Member& m = building_[member];
  const Vec3 about = direction_of(member, direction == 1 ? 2 : 1);
  if (!turns_with(building_, member, end_at(m, node), about)) return {};
  for (const MemberId other : members_at_[index(node)]) {
    if (other == member) continue;
    const Member& o = building_[other];
    if (std::abs(axis(o).dot(axis(m))) < in_line || !turns_with(building_, other, end_at(o, node), about)) continue;
    // On the other side of the node, not back along the member.
    const Vec3 away = building_[o.nodes[static_cast<std::size_t>(1 - end_at(o, node))]].position;
    const Vec3 back = building_[m.nodes[static_cast<std::size_t>(1 - end_at(m, node))]].position;
    const Vec3 here = building_[node].position;
    if ((away - here).dot(back - here) < 0) return other;
  }
  return {};
}

HeldLength Bracing::held_length(MemberId member, int direction) const {
  const Vec3 sideways = direction_of(member, direction);
  HeldLength held;
  held.length = building_[member].length;
  for (int end = 0; end < 2; ++end) {
    const auto e = static_cast<std::size_t>(end);
    MemberId last = member;
    NodeId node = building_[member].nodes[e];
    for (std::size_t steps = 0; steps < building_.members.size() && !holds(node, last, sideways); ++steps) {
      const MemberId next = beyond(node, last, direction);
      if (!next.valid() || next == member) {
        held.free_end = held.free_end || (!next.valid() && members_at_[index(node)].size() == 1);
        break;
      }
      held.own = false;
      held.length += building_[next].length;
      node = building_[next].nodes[static_cast<std::size_t>(1 - end_at(building_[next], node))];
      last = next;
    }
    held.nodes[e] = node;
    held.members[e] = last;
  }
  return held;
}

double Bracing::end_stiffness(const HeldLength& held, int end, int direction) const {
  const auto e = static_cast<std::size_t>(end);
  const NodeId node = held.nodes[e];
  const MemberId member = held.members[e];
  const Vec3 about = direction_of(member, direction == 1 ? 2 : 1);
  if (!turns_with(building_, member, end_at(building_[member], node), about)) return released_end;
  double columns = 0, beams = 0;
  for (const MemberId id : members_at_[index(node)]) {
    const Member& m = building_[id];
    if (!turns_with(building_, id, end_at(m, node), about)) continue;
    const Section& section = building_[m.section];
    const Vec3 local = m.axes * about;
    const double bending = building_[m.material].youngs_modulus *
                           (section.Iy * local.y() * local.y() + section.Iz * local.z() * local.z()) / m.length;
    (std::abs(axis(m).dot(axis(building_[member]))) > in_line ? columns : beams) += bending;
  }
  if (const int s = support_of_[index(node)]; s >= 0) {
    const Vec6& stiffness = building_.supports[static_cast<std::size_t>(s)].stiffness;
    for (int i = 0; i < 3; ++i)
      if (std::abs(about(i)) > holds_along && stiffness(3 + i) == unlimited) return fixed_end;
  }
  return std::min(beams > 0 ? columns / beams : released_end, released_end);
}

/// Braces count with E A/L, walls in shear with G t b/h, posts with 12 E I/h^3.
void Bracing::find_storeys() {
  for (const Member& m : building_.members) {
    if (m.kind != MemberKind::post) continue;
    Storey& storey = storeys_[storey_levels(building_, m)];
    const double E = building_[m.material].youngs_modulus, h3 = std::pow(m.length, 3);
    storey.posts += along(m.axes.row(2).transpose(), 12 * E * building_[m.section].Iy / h3) +
                    along(m.axes.row(1).transpose(), 12 * E * building_[m.section].Iz / h3);
  }
  const auto braces_between = [&](double low, double high, const Eigen::Matrix2d& stiffness) {
    for (auto& [between, storey] : storeys_) {
      const double middle = (static_cast<double>(between.first) + static_cast<double>(between.second)) / 2 * millimetre;
      if (low < middle && middle < high) storey.braces += stiffness;
    }
  };
  constexpr double steep = 0.95, flat = 0.2;  // of the cosine to the vertical: between them it is a brace
  for (const Member& m : building_.members) {
    const double up = std::abs(axis(m).z());
    if (m.kind == MemberKind::post || up > steep || up < flat) continue;
    const double a = building_[m.nodes[0]].position.z(), b = building_[m.nodes[1]].position.z();
    braces_between(std::min(a, b), std::max(a, b),
                   along(axis(m), building_[m.material].youngs_modulus * building_[m.section].area / m.length));
  }
  for (const Panel& p : building_.panels) {
    if (p.model == PanelModel::cladding || std::abs(p.axes(2, 2)) > flat) continue;
    double low = unlimited, high = -unlimited;
    for (const NodeId node : p.nodes) {
      low = std::min(low, building_[node].position.z());
      high = std::max(high, building_[node].position.z());
    }
    const Vec3 run = Vec3(-p.axes(2, 1), p.axes(2, 0), 0).normalized();
    double wide = 0;
    for (const NodeId node : p.nodes)
      wide = std::max(wide, std::abs((building_[node].position - building_[p.nodes[0]].position).dot(run)));
    braces_between(low, high, along(run, building_[p.material].shear_modulus * p.thickness * wide / (high - low)));
  }
}

bool Bracing::supported(NodeId node, const Vec3& direction) const {
  const int s = support_of_[index(node)];
  if (s < 0) return false;
  const Vec6& stiffness = building_.supports[static_cast<std::size_t>(s)].stiffness;
  for (int i = 0; i < 3; ++i)
    if (std::abs(direction(i)) > holds_along && stiffness(i) == unlimited) return true;
  return false;
}

bool Bracing::braced(MemberId post, int direction) const {
  const Vec3 sideways = direction_of(post, direction);
  const std::array<NodeId, 2>& ends = building_[post].nodes;
  if (supported(ends[0], sideways) && supported(ends[1], sideways)) return true;
  const auto storey = storeys_.find(storey_levels(building_, building_[post]));
  if (storey == storeys_.end()) return false;
  const Vec2 u = direction_of(post, direction).head<2>();
  if (u.norm() < holds_along) return false;
  const double braces = u.dot(storey->second.braces * u), posts = u.dot(storey->second.posts * u);
  return braces >= braced_ratio * posts;
}

}  // namespace topple::structure
