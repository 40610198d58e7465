// Bent members and panels in files: a pose and weights against where the shape itself puts them.
#include "topple/structure/bent_part.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "../frame_builder.h"

namespace {

using namespace topple::test;

constexpr double length = 6;

struct Beam {
  FrameBuilder frame;
  MemberId member;
  Beam() { member = frame.member("AB", MemberKind::beam, frame.node("A", 1, 2, 3), frame.node("B", 1, 2 + length, 3)); }
};

/// Where a vertex of a mesh comes to lie.
Vec3 placed(const BentPart& part, const Vec3& at, const std::vector<std::vector<Vec3>>& bends, std::size_t vertex) {
  Vec3 sum = at;
  for (std::size_t k = 0; k < bends.size(); ++k) sum += static_cast<double>(part.bend[k]) * bends[k][vertex];
  return part.pose.position + part.pose.orientation * sum;
}

/// Of a member's axis, as MemberShape tells it: Hermite's cubic through displacements and slopes, and the bulge.
Vec3 axis_at(const Building& building, MemberId id, const MemberShape& shape, double s) {
  const Member& member = building[id];
  const Vec3 axis = member.axes.row(0);
  std::array<Vec3, 2> moved, slope;
  for (std::size_t e = 0; e < 2; ++e) {
    moved[e] = shape.ends[e].head<3>().cast<double>();
    slope[e] = shape.ends[e].tail<3>().cast<double>().cross(axis);
  }
  const Vec3 along = axis * axis.dot(moved[1] - moved[0]);
  const Vec3 across = moved[1] - moved[0] - along;
  const double s2 = s * s, s3 = s2 * s;
  return building[member.nodes[0]].position + s * member.length * axis + moved[0] + s * along +
         (3 * s2 - 2 * s3) * across + member.length * ((s - 2 * s2 + s3) * slope[0] + (s3 - s2) * slope[1]) +
         16 * s2 * (1 - s) * (1 - s) * shape.bulge.cast<double>();
}

}  // namespace

TEST_CASE("a member's pose and bend put its axis where its shape has it, and its sections across it") {
  const Beam beam;
  std::mt19937 random(7);
  std::uniform_real_distribution<float> any(-1, 1);
  const double half = 0.15;
  std::vector<Vec3> positions;
  for (int i = 0; i <= 8; ++i)
    for (const double out : {0.0, half}) positions.emplace_back(length * (i / 8.0 - 0.5), 0, out);
  const auto bends = member_bends(length, positions);
  for (int round = 0; round < 200; ++round) {
    // Ends that turn by up to 0.08 rad beside a line that turns by up to 0.08: what hinges allow.
    MemberShape shape;
    for (Displacement& end : shape.ends)
      for (int c = 0; c < 6; ++c) end(c) = any(random) * (c < 3 ? 0.2F : 0.08F);
    shape.bulge = Eigen::Vector3f(0, any(random), any(random)) * 0.02F;
    shape.bulge = Eigen::Vector3f(shape.bulge.y(), 0, shape.bulge.z());  // across the member, which runs along y
    const BentPart part = bent_member(beam.frame.building, beam.member, shape);
    for (std::size_t v = 0; v < positions.size(); v += 2) {
      const double s = positions[v].x() / length + 0.5;
      const Vec3 is = placed(part, positions[v], bends, v), was = axis_at(beam.frame.building, beam.member, shape, s);
      // Its middle is out by up to 0.15 m across a line that turns by up to 0.07: that much it is off along it.
      CHECK((is - was).norm() < 0.15 * 0.07);
      if (v == 0 || v + 2 == positions.size()) CHECK((is - was).norm() < 1e-5);  // single precision
      // The section's own points stay that far from the axis, and lie across it: to second order in the turns.
      const double step = 1e-3;
      const Vec3 tangent = (axis_at(beam.frame.building, beam.member, shape, std::min(1.0, s + step)) -
                            axis_at(beam.frame.building, beam.member, shape, std::max(0.0, s - step)))
                               .normalized();
      const Vec3 arm = placed(part, positions[v + 1], bends, v + 1) - is;
      CHECK(arm.norm() == Approx(half).epsilon(0.04));
      CHECK(std::abs(arm.normalized().dot(tangent)) < 0.03);
    }
  }
}

TEST_CASE("a panel's pose and bend put its corners where they have moved, and its inside between them") {
  FrameBuilder frame;
  Panel panel;
  panel.nodes = {frame.node("A", 0, 0, 3), frame.node("B", 6, 0, 3), frame.node("C", 5, 4, 3),
                 frame.node("D", 0, 5, 3)};
  frame.building.panels.push_back(panel);
  const PanelId id(0U);
  const auto corner = [&](std::size_t c) { return frame.building[panel.nodes[c]].position; };
  const auto between = [](const std::array<Vec3, 4>& c, double s, double t) -> Vec3 {
    return (1 - t) * ((1 - s) * c[0] + s * c[1]) + t * ((1 - s) * c[3] + s * c[2]);
  };
  const std::array<Vec3, 4> rest{corner(0), corner(1), corner(2), corner(3)};
  const Vec3 centre = between(rest, 0.5, 0.5);
  std::vector<std::array<double, 2>> shares;
  for (const double s : {0.0, 0.3, 1.0})
    for (const double t : {0.0, 0.8, 1.0}) shares.push_back({s, t});
  std::vector<Vec3> positions;
  for (const auto& [s, t] : shares) positions.push_back(between(rest, s, t) - centre);
  const auto bends = panel_bends(frame.building, id, positions);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(-0.5, 0.5);
  for (int round = 0; round < 50; ++round) {
    std::array<Vec3, 4> moved, now = rest;
    for (std::size_t c = 0; c < 4; ++c) {
      moved[c] = Vec3(0.1 * any(random), 0.1 * any(random), any(random));
      now[c] += moved[c];
    }
    const BentPart part = bent_panel(frame.building, id, moved);
    for (std::size_t v = 0; v < positions.size(); ++v)
      CHECK((placed(part, positions[v], bends, v) - between(now, shares[v][0], shares[v][1])).norm() < 1e-5);
  }
}

TEST_CASE("normals turn with a bend as the surface does") {
  // Around each place two points of the surface are bent along with it: the normal is their cross product.
  const auto check = [](const std::vector<Vec3>& around, const std::vector<Vec3>& normals, const auto& bends_of,
                        const std::vector<std::vector<Vec3>>& ways, const BendWeights& weights) {
    const auto bends = bends_of(around);
    const auto now = [&](std::size_t v) {
      Vec3 sum = around[v];
      for (std::size_t k = 0; k < bends.size(); ++k) sum += static_cast<double>(weights[k]) * bends[k][v];
      return sum;
    };
    double most = 0;
    for (std::size_t v = 0; v < normals.size(); ++v) {
      const Vec3 is = bent_normal(normals[v], ways, weights, v);
      const Vec3 was = (now(3 * v + 1) - now(3 * v)).cross(now(3 * v + 2) - now(3 * v)).normalized();
      CHECK((is - was).norm() < 0.01);  // the turns below, squared
      most = std::max(most, (is - normals[v]).norm());
    }
    CHECK(most > 0.03);
    CHECK(normals_turn(normals, ways, {}, weights));
    CHECK_FALSE(normals_turn(normals, ways, weights, weights));
  };
  const auto tangents = [](const Vec3& normal) {
    const Vec3 first = normal.unitOrthogonal();
    return std::array<Vec3, 2>{first, normal.cross(first)};
  };
  constexpr double step = 1e-5;
  const auto surround = [&](const std::vector<Vec3>& at, const std::vector<Vec3>& normals) {
    std::vector<Vec3> around;
    for (std::size_t v = 0; v < at.size(); ++v) {
      around.push_back(at[v]);
      for (const Vec3& t : tangents(normals[v])) around.push_back(at[v] + step * t);
    }
    return around;
  };
  std::vector<Vec3> places, normals;
  for (int i = 0; i <= 8; ++i)
    for (const Vec3& out : {Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0, -0.6, 0.8), Vec3(1, 0, 0)}) {
      places.push_back(Vec3(length * (i / 8.0 - 0.5), 0, 0) + 0.15 * Vec3(0, out.y(), out.z()));
      normals.push_back(out);
    }
  for (std::size_t way = 0; way < BendWeights().size(); ++way) {
    CAPTURE(way);
    if (way == 6) continue;  // longer: nothing turns
    BendWeights weights{};
    const bool out = way == 2 || way == 5;  // m at the middle; the others are turns
    weights[way] = out ? 0.1F : 0.08F;
    check(
        surround(places, normals), normals, [](const auto& at) { return member_bends(length, at); },
        member_bend_normals(length, places, normals), weights);
  }
  FrameBuilder frame;
  Panel panel;
  panel.nodes = {frame.node("A", 0, 0, 3), frame.node("B", 6, 0, 3), frame.node("C", 5, 4, 3),
                 frame.node("D", 0, 5, 3)};
  frame.building.panels.push_back(panel);
  const PanelId id(0U);
  places.clear(), normals.clear();
  for (const double x : {-2.0, 0.5, 2.0})
    for (const double y : {-1.5, 0.0, 1.0}) {
      places.emplace_back(x, y, 0.1);
      normals.emplace_back(0, 0, 1);
    }
  BendWeights warped{};
  warped[0] = 0.15F;
  check(
      surround(places, normals), normals, [&](const auto& at) { return panel_bends(frame.building, id, at); },
      panel_bend_normals(frame.building, id, places, normals), warped);
}

TEST_CASE("a part that sways less than is seen keeps its pose and stays straight, one that does more follows") {
  const Beam beam;
  const Building& building = beam.frame.building;
  std::vector<Vec3> positions;
  for (int i = 0; i <= 8; ++i) positions.emplace_back(length * (i / 8.0 - 0.5), 0, 0);
  const auto bends = member_bends(length, positions);
  SteadyPart steady_part = steady(building, beam.member);
  const BentPart rest = bent_member(building, beam.member, MemberShape());
  int changes = 0;
  BentPart last = rest;
  for (int step = 0; step <= 1000; ++step) {
    // It sags by up to 0.1 m and comes back; one end turns by twice as much as the other.
    const auto by = static_cast<float>(0.05 * (1 - std::cos(step * 2 * M_PI / 1000)));
    MemberShape shape;
    shape.ends[0].tail<3>() = Eigen::Vector3f(-by, 0, 0) * 0.4F;
    shape.ends[1].tail<3>() = Eigen::Vector3f(by, 0, 0) * 0.2F;
    shape.ends[1](2) = -by;
    const BentPart is = bent_member(building, beam.member, shape);
    const BentPart& drawn = steady_part.at(is);
    if (step < 20) CHECK(drawn == rest);  // it has moved by less than 2 mm
    for (std::size_t v = 0; v < positions.size(); ++v)
      CHECK((placed(drawn, positions[v], bends, v) - placed(is, positions[v], bends, v)).norm() < drawn_tolerance);
    changes += drawn == last ? 0 : 1;
    last = drawn;
  }
  CHECK(changes > 20);
  CHECK(changes < 100);
  CHECK(last.bend == BendWeights());
}
