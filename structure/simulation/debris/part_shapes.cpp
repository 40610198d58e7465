#include "simulation/debris/part_shapes.h"
#include "model/index_of.h"
#include "simulation/debris/debris_settings.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "simulation/debris/mass_properties.h"

namespace topple::structure {

namespace {

/// Half of what a section covers along a direction across its member.
double half_extent(const Member& member, const Vec2& size, const Vec3& direction) {
  const Vec3 local = member.axes * direction;
  return (std::abs(local.y()) * size.x() + std::abs(local.z()) * size.y()) / 2;
}

/// Where the lines p + s a and q + t b (in a plane, not parallel) meet.
Vec2 meeting(const Vec2& p, const Vec2& a, const Vec2& q, const Vec2& b) {
  const double cross = a.x() * b.y() - a.y() * b.x();
  const Vec2 d = q - p;
  return p + a * ((d.x() * b.y() - d.y() * b.x()) / cross);
}

}  // namespace

Vec2 section_size(const Section& section) {
  if (section.depth > 0 && section.width > 0) return {section.width, section.depth};
  if (section.depth > 0) return {section.depth, section.depth};
  return {std::sqrt(12 * section.Iz / section.area), std::sqrt(12 * section.Iy / section.area)};
}

PartShapes::PartShapes(const Building& building) : members_(building.members.size()) {
  members_at_node_.resize(building.nodes.size());
  for (std::size_t i = 0; i < building.members.size(); ++i)
    for (const NodeId node : building.members[i].nodes) members_at_node_[index_of(node)].push_back(MemberId(i));
  shapes_.reserve(part_count(building));
  for (std::size_t i = 0; i < building.members.size(); ++i) shapes_.push_back(member_shape(building, MemberId(i)));
  for (std::size_t i = 0; i < building.panels.size(); ++i) shapes_.push_back(panel_shape(building, PanelId(i)));
}

double PartShapes::clearance(const Building& building, NodeId node, MemberId except, const Vec3& direction) const {
  double clear = 0;
  for (const MemberId other : members_at_node_[index_of(node)]) {
    if (other == except) continue;
    const Member& member = building[other];
    clear = std::max(clear, half_extent(member, section_size(building[member.section]), direction));
  }
  return clear;
}

PartShapes::Shape PartShapes::member_shape(const Building& building, MemberId id) const {
  const Member& member = building[id];
  const Vec2 size = section_size(building[member.section]);
  const Vec3 x = member.axes.row(0).transpose();
  std::array<double, 2> cut{};
  for (int end = 0; end < 2; ++end) {
    const auto e = static_cast<std::size_t>(end);
    const double arm = (end == 0 ? 1 : -1) * member.offsets[e].dot(x);
    const double wanted = clearance(building, member.nodes[e], id, x) - arm + debris_settings.neighbour_gap;
    cut[e] = std::clamp(wanted, 0.0, debris_settings.largest_cut * member.length);
  }
  Shape shape;
  shape.axes = member.axes;
  shape.half = Vec3((member.length - cut[0] - cut[1]) / 2, size.x() / 2, size.y() / 2);
  shape.centre = member_start(building, member) + x * (cut[0] + shape.half.x());
  const Vec3 reach = member.axes.transpose().cwiseAbs() * shape.half;
  shape.bounds.add(shape.centre - reach);
  shape.bounds.add(shape.centre + reach);
  return shape;
}

double PartShapes::edge_inset(const Building& building, const Panel& panel, int edge) const {
  const NodeId first = panel.nodes[static_cast<std::size_t>(edge)];
  const NodeId second = panel.nodes[static_cast<std::size_t>((edge + 1) % 4)];
  const Vec3 along = (building[second].position - building[first].position).normalized();
  const Vec3 across = along.cross(Vec3(panel.axes.row(2).transpose()));
  double inset = 0;
  for (const NodeId node : {first, second})
    for (const MemberId id : members_at_node_[index_of(node)]) {
      const Member& member = building[id];
      // Members along the edge, and those that pierce the panel's plane at its corners (posts through a floor): a slab
      // that falls must not start inside the posts beside it, nor hang between them.
      const bool lies_along = std::abs(member.axes.row(0).dot(along)) >= debris_settings.along_edge;
      const bool pierces = std::abs(member.axes.row(0).dot(panel.axes.row(2))) > debris_settings.piercing;
      if (!lies_along && !pierces) continue;
      inset = std::max(inset, half_extent(member, section_size(building[member.section]), across));
    }
  return inset + debris_settings.neighbour_gap;
}

/// A plate whose corners are those of a box along its axes becomes one: boxes touch each other at a fraction of the
/// cost of hulls.
void PartShapes::make_box(Shape& shape) {
  constexpr double rounding = 1e-9;  // of the size
  Vec3 half = Vec3::Zero();
  for (const Vec3& corner : shape.corners)
    half = half.cwiseMax(Vec3((shape.axes * (corner - shape.centre)).cwiseAbs()));
  for (const Vec3& corner : shape.corners) {
    const Vec3 local = (shape.axes * (corner - shape.centre)).cwiseAbs();
    if ((local - half).cwiseAbs().maxCoeff() > rounding * half.maxCoeff()) return;
  }
  shape.half = half;
  shape.corners.clear();
}

PartShapes::Shape PartShapes::panel_shape(const Building& building, PanelId id) const {
  const Panel& panel = building[id];
  const Vec3 origin = building[panel.nodes[0]].position;
  std::array<Vec2, 4> outline, inward, along;
  Vec2 middle = Vec2::Zero();
  for (std::size_t i = 0; i < 4; ++i) {
    outline[i] = (panel.axes * (building[panel.nodes[i]].position - origin)).head<2>();
    middle += outline[i] / 4;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    along[i] = (outline[(i + 1) % 4] - outline[i]).normalized();
    const Vec2 normal(-along[i].y(), along[i].x());
    const double depth = normal.dot(middle - outline[i]);  // positive when the nodes run counter-clockwise
    const double inset =
        std::min(edge_inset(building, panel, static_cast<int>(i)), debris_settings.largest_cut * std::abs(depth));
    inward[i] = outline[i] + normal * std::copysign(inset, depth);
  }
  Shape shape;
  shape.axes = panel.axes;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t before = (i + 3) % 4;
    const Vec2 corner = meeting(inward[before], along[before], inward[i], along[i]);
    for (const double side : {-0.5, 0.5}) {
      const Vec3 local(corner.x(), corner.y(), side * panel.thickness);
      shape.corners.push_back(origin + panel.axes.transpose() * local);
      shape.bounds.add(shape.corners.back());
    }
  }
  for (const Vec3& corner : shape.corners) shape.centre += corner / 8;
  make_box(shape);
  return shape;
}

const PartShapes::Shape& PartShapes::of(Part part) const {
  return part.member.valid() ? shapes_[index_of(part.member)] : shapes_[members_ + index_of(part.panel)];
}

const Bounds& PartShapes::bounds(Part part) const { return of(part).bounds; }

collision::ConvexPart PartShapes::shape(Part part, const Vec3& origin) const {
  const Shape& shape = of(part);
  collision::ConvexPart convex;
  convex.tag = part.member.valid() ? part.member.index : static_cast<std::int64_t>(members_) + part.panel.index;
  if (shape.corners.empty()) {
    convex.kind = collision::ConvexPart::Kind::box;
    convex.half_extents = shape.half;
    convex.pose.position = shape.centre - origin;
    convex.pose.orientation = Eigen::Quaterniond(Mat3(shape.axes.transpose()));
  } else {
    convex.kind = collision::ConvexPart::Kind::hull;
    for (const Vec3& corner : shape.corners) convex.points.push_back(corner - origin);
  }
  return convex;
}

std::vector<collision::ConvexPart> PartShapes::parts(Part part, const Vec3& origin) const {
  const auto broken = part.panel.valid() ? broken_.find(part.panel) : broken_.end();
  if (broken == broken_.end()) return {shape(part, origin)};
  std::vector<collision::ConvexPart> convex;
  for (const std::vector<Vec3>& hull : broken->second) {
    collision::ConvexPart& own = convex.emplace_back();
    own.tag = static_cast<std::int64_t>(members_) + part.panel.index;
    own.kind = collision::ConvexPart::Kind::hull;
    for (const Vec3& corner : hull) own.points.push_back(corner - origin);
  }
  return convex;
}

void PartShapes::set_broken(PanelId panel, std::vector<std::vector<Vec3>> hulls) { broken_[panel] = std::move(hulls); }

std::vector<Vec3> PartShapes::corners(PanelId panel) const {
  const Shape& shape = of(Part(panel));
  if (!shape.corners.empty()) return shape.corners;
  constexpr std::array<std::array<double, 2>, 4> round{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  std::vector<Vec3> corners;
  for (const auto& [x, y] : round)
    for (const double z : {-1.0, 1.0})
      corners.push_back(shape.centre + shape.axes.transpose() * shape.half.cwiseProduct(Vec3(x, y, z)));
  return corners;
}

std::vector<Vec3> PartShapes::corners(const Building& building, MemberId id, double from, double to) const {
  const Member& member = building[id];
  const Shape& shape = of(Part(id));
  const Vec3 x = shape.axes.row(0).transpose(), start = member_start(building, member);
  const double middle = (shape.centre - start).dot(x),
               long_enough = (1 - 2 * debris_settings.largest_cut) * (to - from);
  double low = std::max(from > 0 ? from + debris_settings.neighbour_gap / 2 : from, middle - shape.half.x());
  double high = std::min(to < member.length ? to - debris_settings.neighbour_gap / 2 : to, middle + shape.half.x());
  if (high - low < long_enough) {
    low = from + debris_settings.largest_cut * (to - from);
    high = to - debris_settings.largest_cut * (to - from);
  }
  std::vector<Vec3> corners;
  for (const double y : {-1.0, 1.0})
    for (const double z : {-1.0, 1.0})
      for (const double along : {low, high})
        corners.push_back(start + along * x + shape.axes.transpose() * Vec3(0, y * shape.half.y(), z * shape.half.z()));
  return corners;
}

std::optional<double> PartShapes::ray(Part part, const Vec3& from, const Vec3& direction) const {
  const Shape& shape = of(part);
  Vec3 half = shape.half;
  if (!shape.corners.empty())  // the box around the plate, in its own axes
    for (const Vec3& corner : shape.corners) half = half.cwiseMax((shape.axes * (corner - shape.centre)).cwiseAbs());
  const Vec3 start = shape.axes * (from - shape.centre), way = shape.axes * direction;
  double enter = 0, leave = unlimited;
  for (int i = 0; i < 3; ++i) {
    if (way[i] == 0) {
      if (std::abs(start[i]) > half[i]) return std::nullopt;
      continue;
    }
    const double a = (-half[i] - start[i]) / way[i], b = (half[i] - start[i]) / way[i];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  if (enter > leave) return std::nullopt;
  return enter;
}

}  // namespace topple::structure
