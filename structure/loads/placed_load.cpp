#include "loads/placed_load.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "model/index_of.h"

namespace topple::structure {

namespace {

solver::BeamLoad point_load(const Building& building, MemberId member, double distance, const Vec3& force,
                            const Vec3& moment) {
  const Mat3& axes = building[member].axes;
  solver::BeamLoad load;
  load.kind = solver::BeamLoad::Kind::point;
  load.from = load.to = distance;
  load.first << axes * force, axes * moment;
  load.last = load.first;
  return load;
}

struct Edge {
  Vec3 start, along;  ///< `along` has the edge's length
  [[nodiscard]] double nearest(const Vec3& point) const {
    return std::clamp((point - start).dot(along) / along.squaredNorm(), 0.0, 1.0);
  }
  [[nodiscard]] Vec3 at(double share) const { return start + share * along; }
};

Edge edge_of(const Building& building, const Panel& panel, std::size_t edge) {
  const Vec3& start = building[panel.nodes[edge]].position;
  return {start, building[panel.nodes[(edge + 1) % 4]].position - start};
}

/// The force on one edge: on the standing member that is there, else shared between the edge's nodes.
void load_on_edge(const Building& building, const PanelBearings& bearings, PanelId id, std::size_t edge,
                  const Vec3& point, const Vec3& force, PlacedLoad& placed) {
  placed.edge_force[edge] += force;
  MemberId nearest;
  double distance_from_it = 0;
  const auto& members = bearings.edge_members().of(id, static_cast<int>(edge));
  for (MemberId member : members) {
    if (!bearings.member_stands()[index_of(member)]) continue;
    const double away = (on_axis(building, member, nearest_on_axis(building, member, point)) - point).norm();
    if (nearest.valid() && away >= distance_from_it) continue;
    nearest = member;
    distance_from_it = away;
  }
  if (nearest.valid()) {
    const double distance = nearest_on_axis(building, nearest, point);
    // Where the member ends short of the point (a rigid arm, a gap) the moment keeps the line of action.
    const Vec3 arm = point - on_axis(building, nearest, distance);
    const Vec3 lengthwise = building[nearest].axes.row(0);
    placed.members.emplace_back(
        nearest, point_load(building, nearest, distance, force, lengthwise.dot(arm) * lengthwise.cross(force)));
    return;
  }
  const Panel& panel = building[id];
  const double share = edge_of(building, panel, edge).nearest(point);
  for (const auto& [node, part] : {std::pair{panel.nodes[edge], 1 - share}, {panel.nodes[(edge + 1) % 4], share}}) {
    Vec6 load = Vec6::Zero();
    load.head<3>() = part * force;
    if (part > 0) placed.nodes.emplace_back(node, load);
  }
}

double strip_compliance(const Building& building, const Panel& panel, double x, double span, double width) {
  if (x <= 0 || x >= span) return 0;
  const Material& material = building[panel.material];
  const double t = panel.thickness;
  const double effective = std::min(width, std::max(t, 2.4 * x * (1 - x / span)));
  const double modulus = material.youngs_modulus / (1 - material.poisson_ratio * material.poisson_ratio);
  const double bending = modulus * effective * t * t * t / 12;
  return x * x * (span - x) * (span - x) / (3 * bending * span);
}

/// The strip of a panel through a point, from one of two opposite edges (`near`) to the other.
struct Strip {
  Vec3 start, end;
  double x = 0;  ///< of the point's foot, from the start, m
  double width = 0;
  [[nodiscard]] double length() const { return (end - start).norm(); }
};

Strip strip_through(const Building& building, const Panel& panel, std::size_t near, const Vec3& point) {
  const Vec3 normal = panel.axes.row(2);
  const Vec3 foot = point - normal * normal.dot(point - building[panel.nodes[0]].position);
  const Edge first = edge_of(building, panel, near), second = edge_of(building, panel, near + 2);
  // The strip through the point meets both edges at the same share of their lengths (exactly so in a parallelogram).
  const double share = 0.5 * (first.nearest(foot) + 1 - second.nearest(foot));
  Strip strip{first.at(share), second.at(1 - share)};
  const double length = strip.length();
  strip.x = std::clamp((foot - strip.start).dot(strip.end - strip.start) / length, 0.0, length);
  strip.width = 0.5 * (first.along.norm() + second.along.norm());
  return strip;
}

/// Distances between the middles of opposite edges: 0 to 2, 1 to 3.
std::array<double, 2> spans(const Building& building, const Panel& panel) {
  const auto middle = [&](std::size_t edge) { return edge_of(building, panel, edge).at(0.5); };
  return {(middle(2) - middle(0)).norm(), (middle(3) - middle(1)).norm()};
}

double bending_of(const Building& building, const Panel& panel, const Strip& strip, const Vec3& force) {
  const double across = force.norm() > 0 ? panel.axes.row(2).dot(force) / force.norm() : 0;
  return across * across * strip_compliance(building, panel, strip.x, strip.length(), strip.width);
}

PlacedLoad load_on_panel(const Building& building, const PanelBearings& bearings, PanelId id, const Vec3& point,
                         const Vec3& force) {
  const Panel& panel = building[id];
  const std::array<double, 2> span = spans(building, panel);
  const auto& holds = bearings.holds(id);
  const std::array<bool, 2> bears{holds[0] && holds[2], holds[1] && holds[3]};
  const std::size_t near = bears[0] && (!bears[1] || span[0] <= span[1]) ? 0 : 1, far = near + 2;
  const Strip strip = strip_through(building, panel, near, point);
  const double length = strip.length();
  PlacedLoad placed;
  placed.panel = id;
  load_on_edge(building, bearings, id, near, strip.start, (1 - strip.x / length) * force, placed);
  load_on_edge(building, bearings, id, far, strip.end, strip.x / length * force, placed);
  placed.bending_compliance = bending_of(building, panel, strip, force);
  return placed;
}

}  // namespace

double nearest_on_axis(const Building& building, MemberId member, const Vec3& point) {
  const Member& own = building[member];
  const Vec3 start = building[own.nodes[0]].position + own.offsets[0];
  return std::clamp(own.axes.row(0).dot((point - start).transpose()), 0.0, own.length);
}

Vec3 on_axis(const Building& building, MemberId member, double distance) {
  const Member& own = building[member];
  return building[own.nodes[0]].position + own.offsets[0] + distance * own.axes.row(0).transpose();
}

double panel_bending_compliance(const Building& building, PanelId id, const Vec3& point, const Vec3& direction) {
  const Panel& panel = building[id];
  const std::array<double, 2> span = spans(building, panel);
  return bending_of(building, panel, strip_through(building, panel, span[0] <= span[1] ? 0 : 1, point), direction);
}

PlacedLoad load_at_place(const Building& building, const PanelBearings& bearings, const ContactPlace& place,
                         const Vec3& force, const Vec3& moment) {
  if (place.panel.valid()) return load_on_panel(building, bearings, place.panel, place.point, force);
  PlacedLoad placed;
  if (place.node.valid()) {
    Vec6 load;
    load << force, moment + (place.point - building[place.node].position).cross(force);
    placed.nodes.emplace_back(place.node, load);
    return placed;
  }
  const double distance = nearest_on_axis(building, place.member, place.point);
  placed.members.emplace_back(place.member, point_load(building, place.member, distance, force, moment));
  return placed;
}

}  // namespace topple::structure
