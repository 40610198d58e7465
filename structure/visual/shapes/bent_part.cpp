#include "topple/structure/bent_part.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "model/index_of.h"
#include "simulation/debris/mass_properties.h"

namespace topple::structure {
namespace {

// In the order in which they are seen: files leave out the last ones where they are not.
enum MemberBend { first_about_y, second_about_y, out_z, first_about_z, second_about_z, out_y, longer, twisted };
enum PanelBend { warped, sheared, longer_1, longer_2, wider_1, wider_2, panel_ways };

/// A quadrilateral as centre + xi first + eta second + xi eta third; xi and eta from -1 to 1.
struct Quadrilateral {
  Vec3 centre, first, second, third;
  Mat3 axes;  ///< columns: along the first, in the plane, normal
  explicit Quadrilateral(const std::array<Vec3, 4>& c)
      : centre((c[0] + c[1] + c[2] + c[3]) / 4),
        first((c[1] + c[2] - c[0] - c[3]) / 4),
        second((c[2] + c[3] - c[0] - c[1]) / 4),
        third((c[0] - c[1] + c[2] - c[3]) / 4) {
    axes.col(0) = first.normalized();
    axes.col(2) = first.cross(second).normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    for (Vec3* v : {&first, &second, &third}) *v = axes.transpose() * *v;
  }
  /// xi and eta of a place in its axes, about its centre.
  [[nodiscard]] Vec2 shares(const Vec3& at) const {
    Eigen::Matrix2d sides;
    sides << first.head<2>(), second.head<2>();
    const Eigen::Matrix2d back = sides.inverse();
    Vec2 s = back * at.head<2>();
    constexpr int enough = 30;  // a quadrilateral that is no parallelogram: it converges by a third or so each time
    for (int i = 0; i < enough && !third.head<2>().isZero(0); ++i)
      s = back * (at.head<2>() - s.x() * s.y() * third.head<2>());
    return s;
  }
};

std::array<Vec3, 4> corners_of(const Building& building, PanelId id) {
  std::array<Vec3, 4> corners;
  for (std::size_t c = 0; c < 4; ++c) corners[c] = building[building[id].nodes[c]].position;
  return corners;
}

/// Of the axis by an end's turn, per radian and m of length, and by its middle's way out; at the share s of the length.
double first_turn(double s) { return s * (1 - s) * (1 - s); }
double second_turn(double s) { return -first_turn(1 - s); }
double way_out(double s) { return 16 * s * s * (1 - s) * (1 - s); }

/// How far weights move anything, m: half a member's section is taken for a twentieth of its length.
double reach(const BendWeights& a, const BendWeights& b, double size, bool is_member) {
  const auto between = [&](std::size_t k) { return static_cast<double>(a[k] - b[k]); };
  if (!is_member) {
    double sum = 0;
    for (std::size_t k = 0; k < panel_ways; ++k) sum += std::abs(between(k));
    return sum;
  }
  double axis = 0;
  constexpr int places = 8;
  for (int i = 1; i < places; ++i) {
    const double s = static_cast<double>(i) / places, length = 2 * size;
    const auto out = [&](MemberBend first, MemberBend second) {
      return length * (first_turn(s) * between(first) + second_turn(s) * between(second));
    };
    axis = std::max(axis, std::hypot(way_out(s) * between(out_z) - out(first_about_y, second_about_y),
                                     way_out(s) * between(out_y) + out(first_about_z, second_about_z)));
  }
  double turn = std::abs(between(twisted)) / 2;
  for (const MemberBend end : {first_about_y, second_about_y, first_about_z, second_about_z})
    turn = std::max(turn, std::abs(between(end)));
  return axis + std::abs(between(longer)) / 2 + turn * size / 10;
}

}  // namespace

BentPart bent_member(const Building& building, MemberId id, const MemberShape& shape) {
  const Member& member = building[id];
  const Vec3 axis = member.axes.row(0);
  const Vec3 start = member_start(building, member);
  const auto end = [&](std::size_t e) -> Vec3 {
    return start + static_cast<double>(e) * member.length * axis + shape.ends[e].head<3>().cast<double>();
  };
  const Vec3 way = end(1) - end(0);
  const Vec3 chord = axis.cross(way) / member.length;
  std::array<Vec3, 2> turns;  // against the line between the ends, member axes
  for (std::size_t e = 0; e < 2; ++e) turns[e] = member.axes * (shape.ends[e].tail<3>().cast<double>() - chord);
  const Vec3 bulge = member.axes * shape.bulge.cast<double>();
  BentPart part;
  part.pose.position = (end(0) + end(1)) / 2;
  part.pose.orientation = Eigen::Quaterniond::FromTwoVectors(axis, way) *
                          Eigen::Quaterniond(Mat3(member.axes.transpose())) *
                          Eigen::AngleAxisd((turns[0].x() + turns[1].x()) / 2, Vec3::UnitX());
  const auto set = [&](MemberBend bend, double weight) { part.bend[bend] = static_cast<float>(weight); };
  set(longer, way.norm() - member.length);
  set(first_about_y, turns[0].y()), set(first_about_z, turns[0].z());
  set(second_about_y, turns[1].y()), set(second_about_z, turns[1].z());
  set(out_y, bulge.y()), set(out_z, bulge.z());
  set(twisted, turns[1].x() - turns[0].x());
  return part;
}

BentPart bent_panel(const Building& building, PanelId id, const std::array<Vec3, 4>& moved) {
  std::array<Vec3, 4> corners = corners_of(building, id);
  const Quadrilateral rest(corners);
  for (std::size_t c = 0; c < 4; ++c) corners[c] += moved[c];
  const Quadrilateral now(corners);
  BentPart part;
  part.pose.position = now.centre;
  part.pose.orientation = Eigen::Quaterniond(Mat3(now.axes * rest.axes.transpose())).normalized();
  const Vec3 first = now.first - rest.first, second = now.second - rest.second, third = now.third - rest.third;
  const auto set = [&](PanelBend bend, double weight) { part.bend[bend] = static_cast<float>(weight); };
  set(longer_1, first.x());
  set(sheared, second.x()), set(longer_2, second.y());
  set(wider_1, third.x()), set(wider_2, third.y()), set(warped, third.z());
  return part;
}

std::array<Vec3, 4> moved_corners(const Building& building, PanelId id, const StandingShapes& standing,
                                  const KeptShapes& parts) {
  const auto index = index_of(id);
  const auto& kept = parts.panel_shape[index];
  const bool stands = parts.panel[index] == part_stands;
  std::array<Vec3, 4> moved;
  for (std::size_t c = 0; c < 4; ++c) {
    const auto node = index_of(building[id].nodes[c]);
    moved[c] = stands ? Vec3(standing.displacements[node].head<3>().cast<double>())
               : kept ? Vec3((*kept)[c].cast<double>())
                      : Vec3::Zero();
  }
  return moved;
}

MemberShape drawn_shape(const Building& building, MemberId id, const StandingShapes& standing,
                        const KeptShapes& parts) {
  const auto index = index_of(id);
  if (parts.member[index] == part_stands) return standing.of(building, index);
  const auto& kept = parts.member_shape[index];
  return kept ? *kept : MemberShape();
}

std::vector<std::vector<Vec3>> member_bends(double length, std::span<const Vec3> positions) {
  std::vector<std::vector<Vec3>> bends(BendWeights().size(), std::vector<Vec3>(positions.size(), Vec3::Zero()));
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const double s = positions[v].x() / length + 0.5, y = positions[v].y(), z = positions[v].z(), rest = 1 - s;
    bends[longer][v].x() = s - 0.5;
    // A slope along y is a turn about z; one along z a turn about y, backwards.
    const auto about = [&](MemberBend by_y, MemberBend by_z, double way, double slope) {
      bends[by_y][v] = Vec3(slope * z, 0, -way);
      bends[by_z][v] = Vec3(-slope * y, way, 0);
    };
    about(first_about_y, first_about_z, length * first_turn(s), rest * (1 - 3 * s));
    about(second_about_y, second_about_z, length * second_turn(s), s * (3 * s - 2));
    const double out = way_out(s), slope = 32 * s * rest * (1 - 2 * s) / length;
    bends[out_y][v] = Vec3(-slope * y, out, 0);
    bends[out_z][v] = Vec3(-slope * z, 0, out);
    bends[twisted][v] = (s - 0.5) * Vec3(0, -z, y);
  }
  return bends;
}

std::vector<std::vector<Vec3>> panel_bends(const Building& building, PanelId id, std::span<const Vec3> positions) {
  const Quadrilateral panel(corners_of(building, id));
  std::vector<std::vector<Vec3>> bends(panel_ways, std::vector<Vec3>(positions.size(), Vec3::Zero()));
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const Vec3 at = panel.axes.transpose() * positions[v];
    const Vec2 s = panel.shares(at);
    const double both = s.x() * s.y(), out = at.z() - both * panel.third.z();
    const auto set = [&](PanelBend bend, const Vec3& way) { bends[bend][v] = panel.axes * way; };
    set(longer_1, {s.x(), 0, 0});
    set(sheared, {s.y(), 0, 0});
    set(longer_2, {0, s.y(), 0});
    set(wider_1, {both, 0, 0});
    set(wider_2, {0, both, 0});
    // What lies beside the middle plane turns with it.
    const double slope_1 = s.y() / panel.first.x();
    const double slope_2 = (s.x() - s.y() * panel.second.x() / panel.first.x()) / panel.second.y();
    set(warped, {-out * slope_1, -out * slope_2, both});
  }
  return bends;
}

namespace {

/// `places_moved`: how far places go by each way, for a list of places.
template <class Bends>
std::vector<std::vector<Vec3>> bend_normals(const Bends& places_moved, double size, std::span<const Vec3> positions,
                                            std::span<const Vec3> normals) {
  // By central differences: places move by polynomials of at most the fourth power, so the error is their third
  // derivative times this squared, below 1e-6 of the turn.
  const double step = 1e-4 * size;
  std::vector<std::vector<Vec3>> added;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Vec3> before(positions.begin(), positions.end()), after = before;
    for (Vec3& p : before) p[axis] -= step;
    for (Vec3& p : after) p[axis] += step;
    const auto low = places_moved(before), high = places_moved(after);
    added.resize(low.size(), std::vector<Vec3>(positions.size(), Vec3::Zero()));
    for (std::size_t k = 0; k < low.size(); ++k)
      for (std::size_t v = 0; v < positions.size(); ++v)
        added[k][v][axis] = -(high[k][v] - low[k][v]).dot(normals[v]) / (2 * step);
  }
  return added;
}

}  // namespace

std::vector<std::vector<Vec3>> member_bend_normals(double length, std::span<const Vec3> positions,
                                                   std::span<const Vec3> normals) {
  return bend_normals([&](std::span<const Vec3> at) { return member_bends(length, at); }, length, positions, normals);
}

std::vector<std::vector<Vec3>> panel_bend_normals(const Building& building, PanelId id, std::span<const Vec3> positions,
                                                  std::span<const Vec3> normals) {
  const std::array<Vec3, 4> corners = corners_of(building, id);
  return bend_normals([&](std::span<const Vec3> at) { return panel_bends(building, id, at); },
                      (corners[2] - corners[0]).norm(), positions, normals);
}

Vec3 bent_normal(const Vec3& normal, const std::vector<std::vector<Vec3>>& ways, const BendWeights& bend,
                 std::size_t vertex) {
  Vec3 sum = normal;
  for (std::size_t k = 0; k < ways.size(); ++k) sum += static_cast<double>(bend[k]) * ways[k][vertex];
  return sum.normalized();
}

bool normals_turn(std::span<const Vec3> normals, const std::vector<std::vector<Vec3>>& ways, const BendWeights& from,
                  const BendWeights& to) {
  if (ways.empty() || from == to) return false;
  for (std::size_t v = 0; v < normals.size(); ++v) {
    const Vec3 a = bent_normal(normals[v], ways, from, v), b = bent_normal(normals[v], ways, to, v);
    if ((a - b).norm() > seen_turn) return true;
  }
  return false;
}

SteadyPart::SteadyPart(const BentPart& rest, double size, bool is_member)
    : last_(rest), size_(size), is_member_(is_member) {}

const BentPart& SteadyPart::at(const BentPart& now) {
  constexpr double each = drawn_tolerance / 2;
  const double moved = (now.pose.position - last_.pose.position).norm();
  const double turned = now.pose.orientation.angularDistance(last_.pose.orientation) * size_;
  if (moved + turned > each) last_.pose = now.pose;
  if (reach(now.bend, last_.bend, size_, is_member_) > each) {
    // One way of them that by itself is not seen is none, in fewer of which files are smaller.
    for (std::size_t k = 0; k < now.bend.size(); ++k) {
      BendWeights alone{};
      alone[k] = now.bend[k];
      last_.bend[k] = reach(alone, BendWeights(), size_, is_member_) > each / 10 ? now.bend[k] : 0;
    }
    if (reach(now.bend, BendWeights(), size_, is_member_) <= each) last_.bend.fill(0);
  }
  return last_;
}

AnimatedPose rest_pose(const Building& building, MemberId member) {
  return bent_member(building, member, MemberShape()).pose;
}

AnimatedPose rest_pose(const Building& building, PanelId panel) {
  return {Quadrilateral(corners_of(building, panel)).centre, Eigen::Quaterniond::Identity()};
}

SteadyPart steady(const Building& building, MemberId member) {
  BentPart rest;
  rest.pose = rest_pose(building, member);
  return {rest, building[member].length / 2, true};
}

SteadyPart steady(const Building& building, PanelId panel) {
  BentPart rest;
  rest.pose = rest_pose(building, panel);
  double size = 0;
  for (const Vec3& corner : corners_of(building, panel)) size = std::max(size, (corner - rest.pose.position).norm());
  return {rest, size, false};
}

}  // namespace topple::structure
