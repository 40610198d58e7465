#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "panel_plane.h"
#include "topple/structure/frame.h"

namespace topple::structure {

namespace {

/// The edge of those that hold whose midpoint is lowest.
int lowest_edge(const Building& building, const Panel& panel) {
  const auto height = [&](std::size_t e) {
    return building[panel.nodes[e]].position.z() + building[panel.nodes[(e + 1) % 4]].position.z();
  };
  std::size_t lowest = 0;
  // A hair's breadth of difference is rounding: the first edge in order then counts.
  const double hair = 1e-9 * (building[panel.nodes[0]].position - building[panel.nodes[2]].position).norm();
  for (std::size_t e = 1; e < 4; ++e)
    if (height(e) < height(lowest) - hair) lowest = e;
  return static_cast<int>(lowest);
}

/// Edges' forces of the whole panel by its span and by what holds.
EdgeForces edge_forces(const Building& building, const Panel& panel, const PanelAction& action,
                       const std::array<bool, 4>& holds) {
  EdgeForces out;
  const PanelPlane plane = panel_plane(building, panel);
  const double across = action.body_force.dot(plane.normal) - action.pressure;
  const Vec3 along = action.body_force - action.body_force.dot(plane.normal) * plane.normal;
  if (!(holds[0] && holds[1] && holds[2] && holds[3])) {
    // Load alone: everything goes between the opposite pair that is left.
    for (const int first : {shorter_span(plane), 1 - shorter_span(plane)})
      if (holds[static_cast<std::size_t>(first)] && holds[static_cast<std::size_t>(first + 2)]) {
        one_way(plane, first, across * plane.normal + along, out);
        return out;
      }
    return out;
  }
  if (across != 0) {
    const Vec3 traction = across * plane.normal;
    if (panel.span == Span::x)
      one_way(plane, 1, traction, out);
    else if (panel.span == Span::y)
      one_way(plane, 0, traction, out);
    else if (!panel.openings.empty())
      one_way(plane, shorter_span(plane), traction, out);
    else
      two_way(plane, traction, out);
  }
  // What rounding leaves of a horizontal slab's weight in its plane is none.
  if (along.norm() > 1e-14 * action.body_force.norm()) along_plane(plane, lowest_edge(building, panel), along, out);
  return out;
}

/// Puts one edge's forces on its members, or on its two nodes.
class EdgeCarrier {
 public:
  EdgeCarrier(const Building& building, NodeId a, NodeId b, const std::vector<MemberId>& members, HandOver& out)
      : building_(building), a_(a), b_(b), members_(members), out_(out) {
    start_ = building[a].position;
    const Vec3 edge = building[b].position - start_;
    length_ = edge.norm();
    along_ = edge / length_;
  }

  void put(const EdgeForce& force) {
    if (members_.empty()) {
      on_two_nodes(force);
      return;
    }
    for (const MemberId id : members_) on_member(id, force);
  }

 private:
  [[nodiscard]] double place(NodeId node) const { return (building_[node].position - start_).dot(along_); }

  static Vec3 at(const EdgeForce& force, double place) {
    return force.first + (force.last - force.first) * ((place - force.from) / (force.to - force.from));
  }
  /// Resultant of the part within [low, high], and its place.
  struct Resultant {
    Vec3 force;
    double place;
  };
  static Resultant resultant(const EdgeForce& force, double low, double high) {
    if (force.from == force.to) return {force.first, force.from};
    const Vec3 f = at(force, low), l = at(force, high);
    const double width = high - low, sum = (f + l).norm();
    // The direction is the same all along; signs may differ, so weigh by the component along it.
    const Vec3 direction = f.norm() >= l.norm() ? f : l;
    const double fd = f.dot(direction), ld = l.dot(direction);
    const double lever = sum > 0 && fd + ld != 0 ? (fd + 2 * ld) / (3 * (fd + ld)) : 0.5;
    return {(f + l) * (width / 2), low + width * lever};
  }

  void on_two_nodes(const EdgeForce& force) {
    const Resultant r = resultant(force, force.from, force.to);
    node_force(a_, r.force * (1 - r.place / length_), Vec3::Zero());
    node_force(b_, r.force * (r.place / length_), Vec3::Zero());
  }

  void on_member(MemberId id, const EdgeForce& force) {
    const Member& member = building_[id];
    const double n0 = place(member.nodes[0]), n1 = place(member.nodes[1]);
    const double u0 = n0 + member.offsets[0].dot(along_), u1 = n1 + member.offsets[1].dot(along_);
    const double low = std::min(u0, u1), high = std::max(u0, u1);
    on_beam(id, force, u0, u1);
    // Over the rigid arms: the node takes it, with its moment.
    const bool forward = n0 < n1;
    over_arm(member.nodes[forward ? 0 : 1], force, std::min(n0, n1), low);
    over_arm(member.nodes[forward ? 1 : 0], force, high, std::max(n0, n1));
  }

  void over_arm(NodeId node, const EdgeForce& force, double low, double high) {
    const double from = std::max(low, force.from), to = std::min(high, force.to);
    if (force.from == force.to ? !(force.from > low && force.from < high) : !(to > from)) return;
    const Resultant r = resultant(force, from, to);
    node_force(node, r.force, (start_ + along_ * r.place - building_[node].position).cross(r.force));
  }

  void on_beam(MemberId id, const EdgeForce& force, double u0, double u1) {
    const Member& member = building_[id];
    const double low = std::min(u0, u1), high = std::max(u0, u1);
    const bool point = force.from == force.to;
    const double from = std::max(low, force.from), to = std::min(high, force.to);
    // A point on the border of two members belongs to the one that begins there.
    if (point ? !(force.from >= low && (force.from < high || (high >= length_ && force.from <= high))) : !(to > from))
      return;
    const double stretch = member.length / (u1 - u0);
    const auto distance = [&](double place) { return std::clamp((place - u0) * stretch, 0.0, member.length); };
    solver::BeamLoad load;
    load.beam = id.index;
    load.kind = point ? solver::BeamLoad::Kind::point : solver::BeamLoad::Kind::distributed;
    const bool forward = u1 > u0;
    load.from = distance(forward ? from : to);
    load.to = distance(forward ? to : from);
    const double scale = point ? 1 : 1 / std::abs(stretch);
    const Vec3 first = point ? force.first : at(force, forward ? from : to);
    const Vec3 last = point ? force.first : at(force, forward ? to : from);
    load.first = local(member, first * scale, arm(member, forward ? from : to, load.from));
    load.last = local(member, last * scale, arm(member, forward ? to : from, load.to));
    if (point) load.from = load.to = distance(force.from);
    out_.beams.push_back(load);
  }

  /// From the member's axis to the edge, where the member lies beside it.
  [[nodiscard]] Vec3 arm(const Member& member, double place, double distance) const {
    const Vec3 axis_point =
        building_[member.nodes[0]].position + member.offsets[0] + distance * member.axes.row(0).transpose();
    const Vec3 away = start_ + along_ * place - axis_point;
    return away.norm() > 1e-9 * length_ ? away : Vec3::Zero();
  }

  static Vec6 local(const Member& member, const Vec3& force, const Vec3& arm) {
    Vec6 out;
    out.head<3>() = member.axes * force;
    out.tail<3>() = member.axes * arm.cross(force);
    return out;
  }

  void node_force(NodeId node, const Vec3& force, const Vec3& moment) {
    Vec6 load;
    load << force, moment;
    if (!load.isZero(0)) out_.nodes.push_back({node.index, load});
  }

  const Building& building_;
  NodeId a_, b_;
  const std::vector<MemberId>& members_;
  HandOver& out_;
  Vec3 start_, along_;
  double length_ = 0;
};

}  // namespace

HandOver hand_over(const Building& building, const EdgeMembers& edges, PanelId id, const PanelAction& action,
                   const std::array<bool, 4>& edge_holds, const std::vector<bool>& member_stands) {
  const Panel& panel = building[id];
  std::array<bool, 4> holds = edge_holds;
  for (int e = 0; e < 4 && !member_stands.empty(); ++e)
    for (const MemberId member : edges.of(id, e))
      if (!member_stands[static_cast<std::size_t>(member.index)]) holds[static_cast<std::size_t>(e)] = false;
  HandOver out;
  out.edge_force.fill(Vec3::Zero());
  for (const EdgeForce& force : edge_forces(building, panel, action, holds)) {
    const auto e = static_cast<std::size_t>(force.edge);
    out.edge_force[e] +=
        force.from == force.to ? force.first : Vec3((force.first + force.last) * ((force.to - force.from) / 2));
    EdgeCarrier(building, panel.nodes[e], panel.nodes[(e + 1) % 4], edges.of(id, force.edge), out).put(force);
  }
  return out;
}

}  // namespace topple::structure
