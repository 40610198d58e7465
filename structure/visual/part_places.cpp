#include "visual/part_places.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "topple/structure/visual_mesh.h"

namespace topple::structure {

namespace {

double along(const std::array<Vec3, 2>& line, const Vec3& point) {
  const Vec3 way = line[1] - line[0];
  return std::clamp((point - line[0]).dot(way) / way.squaredNorm(), 0.0, 1.0);
}

}  // namespace

PartPlaces::PartPlaces(const Building& building) : building_(building) {
  for (std::size_t i = 0; i < part_count(building); ++i)
    all_.push_back(part_of_number(building, static_cast<std::int64_t>(i)));
  for (const Part part : all_) {
    Sphere& sphere = around_.emplace_back();
    std::vector<Vec3> corners;
    if (part.member.valid()) {
      const Line own = line(part);
      corners.assign(own.begin(), own.end());
    } else {
      // The box of its nodes in the panel's axes, which is what distances are measured to.
      const Panel& panel = building[part.panel];
      const Vec3 origin = building[panel.nodes[0]].position;
      Vec3 low = Vec3::Zero(), high = Vec3::Zero();
      for (const NodeId node : panel.nodes) {
        const Vec3 local = panel.axes * (building[node].position - origin);
        low = low.cwiseMin(local), high = high.cwiseMax(local);
      }
      for (const Vec3& corner : {Vec3(low.x(), low.y(), 0), Vec3(high.x(), low.y(), 0), Vec3(high.x(), high.y(), 0),
                                 Vec3(low.x(), high.y(), 0)})
        corners.push_back(origin + panel.axes.transpose() * corner);
    }
    for (const Vec3& corner : corners) sphere.centre += corner / static_cast<double>(corners.size());
    for (const Vec3& corner : corners) sphere.radius = std::max(sphere.radius, (corner - sphere.centre).norm());
  }
}

PartPlaces::Line PartPlaces::line(Part part) const {
  if (part.member.valid()) {
    const Member& member = building_[part.member];
    return {building_[member.nodes[0]].position + member.offsets[0],
            building_[member.nodes[1]].position + member.offsets[1]};
  }
  const auto& nodes = building_[part.panel].nodes;
  const auto at = [&](std::size_t i) -> const Vec3& { return building_[nodes[i]].position; };
  return {(at(0) + at(3)) / 2, (at(1) + at(2)) / 2};
}

double PartPlaces::distance(Part part, const Vec3& point) const {
  if (part.member.valid()) {
    const Line own = line(part);
    return (own[0] + along(own, point) * (own[1] - own[0]) - point).norm();
  }
  // To the plate: across its plane, and in it beyond its box of nodes.
  const Panel& panel = building_[part.panel];
  const Vec3 origin = building_[panel.nodes[0]].position;
  const Vec3 local = panel.axes * (point - origin);
  Vec2 low = Vec2::Zero(), high = Vec2::Zero();
  for (const NodeId node : panel.nodes) {
    const Vec2 corner = (panel.axes * (building_[node].position - origin)).head<2>();
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  const Vec2 flat = local.head<2>();
  const Vec2 inside = flat.cwiseMax(low).cwiseMin(high);
  return std::hypot((flat - inside).norm(), local.z());
}

Part PartPlaces::nearest(const Vec3& point, const std::vector<Part>& among) const {
  Part best = among.front();
  double least = unlimited;
  constexpr double rounding = 1e-6;  // m
  for (const Part part : among) {
    const Sphere& sphere = around_[static_cast<std::size_t>(part_number(building_, part))];
    const double reach = least + sphere.radius + rounding;
    if ((sphere.centre - point).squaredNorm() > reach * reach) continue;
    const double away = distance(part, point);
    if (away >= least) continue;
    least = away;
    best = part;
  }
  return best;
}

/// C. Ericson, "Real-Time Collision Detection" (2005), section 5.1.9.
std::pair<Vec3, Vec3> PartPlaces::closest(Part first, Part second) const {
  const Line p = line(first), q = line(second);
  const Vec3 d1 = p[1] - p[0], d2 = q[1] - q[0], r = p[0] - q[0];
  const double a = d1.squaredNorm(), e = d2.squaredNorm(), b = d1.dot(d2), c = d1.dot(r), f = d2.dot(r);
  const double denominator = a * e - b * b;
  double s = denominator > 1e-12 * a * e ? std::clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0.5;
  const double t = std::clamp((b * s + f) / e, 0.0, 1.0);
  s = std::clamp((b * t - c) / a, 0.0, 1.0);
  return {p[0] + s * d1, q[0] + t * d2};
}

Vec3 PartPlaces::centre(Part part) const {
  const Line own = line(part);
  return (own[0] + own[1]) / 2;
}

bool PartPlaces::touches(Part part, NodeId node) const {
  if (part.member.valid()) {
    const auto& nodes = building_[part.member].nodes;
    return nodes[0] == node || nodes[1] == node;
  }
  const auto& nodes = building_[part.panel].nodes;
  return std::find(nodes.begin(), nodes.end(), node) != nodes.end();
}

namespace {

/// A member bends as the cubic beam between its ends; one that is free to turn at an end has no curvature there.
Vec3 bent_with(const Building& building, MemberId id, const Vec3& point, const BentBuilding& bent) {
  const Member& member = building[id];
  const std::array<Vec3, 2> own{building[member.nodes[0]].position + member.offsets[0],
                                building[member.nodes[1]].position + member.offsets[1]};
  const double s = along(own, point), length = member.length;
  std::array<Vec3, 2> u, turn;  // of the ends, local axes
  for (std::size_t end = 0; end < 2; ++end) {
    const Vec6 rigid_end = bent.displacement(member.nodes[end]);
    turn[end] = rigid_end.tail<3>();
    u[end] = member.axes * (rigid_end.head<3>() + turn[end].cross(member.offsets[end]));
    turn[end] = member.axes * turn[end];
  }
  // Slopes of the axis towards y (turning about z) and towards z (about -y).
  std::array<Vec2, 2> slope;
  const Vec2 chord = (u[1] - u[0]).tail<2>() / length;
  const std::array<Vec2, 2> rigid_end_slope{Vec2(turn[0].z(), -turn[0].y()), Vec2(turn[1].z(), -turn[1].y())};
  for (int way = 0; way < 2; ++way) {
    const int turns_about = way == 0 ? 5 : 4;
    const auto free = [&](int end) {
      const JointId joint = building.joint(id, end);
      return !bent.holds(joint) || building[joint].stiffness(turns_about) == 0;
    };
    for (int end = 0; end < 2; ++end) {
      const auto e = static_cast<std::size_t>(end);
      if (!free(end))
        slope[e](way) = rigid_end_slope[e](way);
      else
        slope[e](way) = free(1 - end) ? chord(way) : 1.5 * chord(way) - 0.5 * rigid_end_slope[1 - e](way);
    }
  }
  const double a = (1 - s) * (1 - s) * (1 + 2 * s), b = s * (1 - s) * (1 - s) * length, d = s * s * (s - 1) * length;
  const Vec2 across = a * u[0].tail<2>() + b * slope[0] + (1 - a) * u[1].tail<2>() + d * slope[1];
  const Vec2 turned = 6 * s * (1 - s) * chord + (1 - s) * (1 - 3 * s) * slope[0] + s * (3 * s - 2) * slope[1];
  const Vec3 axis(u[0].x() + s * (u[1].x() - u[0].x()), across.x(), across.y());
  const Vec3 rotation(turn[0].x() + s * (turn[1].x() - turn[0].x()), -turned.y(), turned.x());
  // What hangs beside the axis turns with it.
  const Vec3 beside = member.axes * (point - (own[0] + s * (own[1] - own[0])));
  return member.axes.transpose() * (axis + rotation.cross(beside));
}

}  // namespace

Vec3 displacement_with(const Building& building, std::int32_t number, const Vec3& point, const BentBuilding& bent) {
  const Part part = part_of_number(building, number);
  if (part.member.valid()) return bent_with(building, part.member, point, bent);
  Vec3 sum = Vec3::Zero();
  double weights = 0;
  for (const NodeId node : building[part.panel].nodes) {
    const double weight = 1 / (1e-3 + (building[node].position - point).norm());
    sum += weight * bent.displacement(node).head<3>();
    weights += weight;
  }
  return sum / weights;
}

BentBuilding bent_as(const StandingFrame& frame) {
  return {[&frame](NodeId node) { return frame.displacement(node); },
          [&frame](JointId joint) { return frame.intact(joint); }};
}

}  // namespace topple::structure
