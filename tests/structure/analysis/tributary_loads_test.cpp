// What panels hand to their edge members: closed forms, and resultants that stay whatever the shape.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>

#include "frame_builder.h"
#include "topple/structure/frame.h"

using namespace topple::structure;
using topple::test::FrameBuilder;
namespace solver = topple::solver;

namespace {

constexpr std::array<bool, 4> all_hold{true, true, true, true};

/// Six numbers: force, and moment about the origin.
Vec6 resultant(const Building& building, const TributaryLoads& handed) {
  Vec6 sum = Vec6::Zero();
  const auto add = [&](const Vec3& at, const Vec3& force, const Vec3& moment) {
    sum.head<3>() += force;
    sum.tail<3>() += at.cross(force) + moment;
  };
  for (const solver::NodeLoad& load : handed.nodes)
    add(building.nodes[static_cast<std::size_t>(load.node)].position, load.load.head<3>(), load.load.tail<3>());
  for (const solver::BeamLoad& load : handed.beams) {
    const Member& member = building.members[static_cast<std::size_t>(load.beam)];
    const Vec3 start = building[member.nodes[0]].position + member.offsets[0], axis = member.axes.row(0);
    const Mat3 global = member.axes.transpose();
    const double l = load.to - load.from;
    REQUIRE(load.from >= 0);
    REQUIRE(load.to <= member.length);
    // Simpson's rule: force times distance is quadratic.
    for (const auto& [f, w] : {std::pair{0.0, l / 6}, {0.5, 4 * l / 6}, {1.0, l / 6}}) {
      const Vec6 here = (1 - f) * load.first + f * load.last;
      add(start + (load.from + f * l) * axis, w * (global * here.head<3>()), w * (global * here.tail<3>()));
    }
  }
  return sum;
}

/// Area, and integral of position, of a plane polygon.
std::pair<double, Vec2> area_and_moment(const std::vector<Vec2>& polygon) {
  double area = 0;
  Vec2 moment = Vec2::Zero();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double c = 0.5 * (a.x() * b.y() - a.y() * b.x());
    area += c;
    moment += c * (a + b) / 3;
  }
  if (area < 0) return {-area, -moment};
  return {area, moment};
}

Vec6 expected_resultant(const Building& building, PanelId id, const PanelAction& action) {
  const Panel& panel = building[id];
  const Vec3 origin = building[panel.nodes[0]].position;
  std::vector<Vec2> outline;
  for (const NodeId node : panel.nodes)
    outline.emplace_back(panel.axes.topRows<2>() * (building[node].position - origin));
  auto [area, moment] = area_and_moment(outline);
  for (const auto& opening : panel.openings) {
    const auto [a, m] = area_and_moment(opening);
    area -= a;
    moment -= m;
  }
  const Vec3 normal = panel.axes.row(2);
  const Vec3 force = action.body_force - action.pressure * normal;
  const Vec3 first_moment = area * origin + panel.axes.topRows<2>().transpose() * moment;
  Vec6 sum;
  sum << area * force, first_moment.cross(force);
  return sum;
}

struct Bay {
  FrameBuilder frame;
  PanelId panel;
};

/// A panel with a member along each edge.
Bay bay(const std::array<Vec3, 4>& corner, PanelModel model = PanelModel::cladding) {
  Bay result;
  std::array<NodeId, 4> nodes;
  for (std::size_t i = 0; i < 4; ++i)
    nodes[i] = result.frame.node("n" + std::to_string(i), corner[i].x(), corner[i].y(), corner[i].z());
  for (std::size_t i = 0; i < 4; ++i)
    result.frame.member("m" + std::to_string(i), MemberKind::beam, nodes[i], nodes[(i + 1) % 4]);
  result.panel = result.frame.panel("S", model, nodes);
  return result;
}

TributaryLoads hand(const Bay& b, const PanelAction& action, const std::array<bool, 4>& holds = all_hold) {
  return tributary_loads(b.frame.building, EdgeMembers(b.frame.building), b.panel, action, holds);
}

PanelAction pressure(double p) {
  PanelAction action;
  action.pressure = p;
  return action;
}

double vertical(const solver::BeamLoad& load, const Building& building, bool last = false) {
  const Mat3& axes = building.members[static_cast<std::size_t>(load.beam)].axes;
  return (axes.transpose() * (last ? load.last : load.first).head<3>()).z();
}

}  // namespace

TEST_CASE("a rectangular slab hands triangles to its short edges and trapezoids to its long ones") {
  const Bay b = bay({Vec3(0, 0, 3), Vec3(6, 0, 3), Vec3(6, 4, 3), Vec3(0, 4, 3)});
  const TributaryLoads handed = hand(b, pressure(1000));
  REQUIRE(handed.nodes.empty());
  REQUIRE(handed.beams.size() == 3 + 2 + 3 + 2);
  // 45 degree lines: breadth 2 m at most, reached 2 m from the corners.
  const std::array<double, 3> start{0, 2, 4}, end{2, 4, 6}, first{0, -2000, -2000}, last{-2000, -2000, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    const solver::BeamLoad& load = handed.beams[i];
    CHECK(load.beam == 0);
    CHECK(load.from == Approx(start[i]).margin(1e-12));
    CHECK(load.to == Approx(end[i]));
    CHECK(vertical(load, b.frame.building) == Approx(first[i]).margin(1e-9));
    CHECK(vertical(load, b.frame.building, true) == Approx(last[i]).margin(1e-9));
  }
  CHECK(handed.edge_force[0].z() == Approx(-8000));  // (6 + 2) / 2 m x 2 m x 1000 N/m2
  CHECK(handed.edge_force[1].z() == Approx(-4000));
  CHECK(handed.edge_force[2].z() == Approx(-8000));
}

TEST_CASE("one-way slabs load the edges that their strips end on, evenly") {
  Bay b = bay({Vec3(0, 0, 3), Vec3(6, 0, 3), Vec3(6, 4, 3), Vec3(0, 4, 3)});
  b.frame.building.panels[0].span = Span::x;
  const TributaryLoads handed = hand(b, pressure(1000));
  REQUIRE(handed.beams.size() == 2);
  CHECK(handed.beams[0].beam == 1);
  CHECK(handed.beams[1].beam == 3);
  for (const auto& load : handed.beams) {
    CHECK(vertical(load, b.frame.building) == Approx(-3000));
    CHECK(vertical(load, b.frame.building, true) == Approx(-3000));
  }
}

TEST_CASE("after the loss of an edge a slab spans one way between the opposite pair that is left") {
  const Bay b = bay({Vec3(0, 0, 3), Vec3(6, 0, 3), Vec3(6, 4, 3), Vec3(0, 4, 3)});
  const TributaryLoads handed = hand(b, pressure(1000), {true, false, true, true});
  CHECK(handed.edge_force[0].z() == Approx(-12000));
  CHECK(handed.edge_force[2].z() == Approx(-12000));
  CHECK(handed.edge_force[1].isZero(0));
  CHECK(handed.edge_force[3].isZero(0));
  for (const auto& load : handed.beams) CHECK(load.beam % 2 == 0);
}

TEST_CASE("without an opposite pair a panel hands nothing over") {
  const Bay b = bay({Vec3(0, 0, 3), Vec3(6, 0, 3), Vec3(6, 4, 3), Vec3(0, 4, 3)});
  const TributaryLoads handed = hand(b, pressure(1000), {true, true, false, false});
  CHECK(handed.beams.empty());
  CHECK(handed.nodes.empty());
  for (const Vec3& force : handed.edge_force) CHECK(force.isZero(0));
}

TEST_CASE("the weight of a wall goes straight down to its lowest edge, and wind to all four") {
  // A wall in the x-z plane with a sloping top, from 3 m to 5 m over 4 m.
  const Bay b = bay({Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(4, 0, 5), Vec3(0, 0, 3)});
  PanelAction action;
  action.body_force = Vec3(0, 0, -100);
  const TributaryLoads handed = hand(b, action);
  REQUIRE(handed.beams.size() == 1);
  CHECK(handed.beams[0].beam == 0);
  CHECK(vertical(handed.beams[0], b.frame.building) == Approx(-300));
  CHECK(vertical(handed.beams[0], b.frame.building, true) == Approx(-500));
  const TributaryLoads wind = hand(b, pressure(1000));
  for (const Vec3& force : wind.edge_force) CHECK(force.y() > 1000);
}

TEST_CASE("collinear members share an edge, and an edge without members loads its nodes by the lever rule") {
  FrameBuilder frame;
  const NodeId a = frame.node("a", 0, 0, 3), b = frame.node("b", 6, 0, 3), c = frame.node("c", 6, 4, 3),
               d = frame.node("d", 0, 4, 3), between = frame.node("between", 2.5, 0, 3);
  frame.member("ab1", MemberKind::beam, between, a);  // runs the other way
  frame.member("ab2", MemberKind::beam, between, b);
  frame.member("cd", MemberKind::beam, c, d);
  const PanelId panel = frame.panel("S", PanelModel::cladding, {a, b, c, d});
  frame.building.panels[0].span = Span::y;
  const EdgeMembers edges(frame.building);
  CHECK(edges.of(panel, 0) == std::vector{MemberId(0u), MemberId(1u)});
  CHECK(edges.of(panel, 1).empty());
  const TributaryLoads strips = tributary_loads(frame.building, edges, panel, pressure(1000), all_hold);
  REQUIRE(strips.beams.size() == 3);
  for (const auto& load : strips.beams) CHECK(vertical(load, frame.building) == Approx(-2000));
  CHECK(strips.nodes.empty());
  frame.building.panels[0].span = Span::x;
  const TributaryLoads across = tributary_loads(frame.building, edges, panel, pressure(1000), all_hold);
  REQUIRE(across.beams.empty());
  REQUIRE(across.nodes.size() == 4);
  for (const auto& load : across.nodes) CHECK(load.load(2) == Approx(-6000));
}

TEST_CASE("load over a rigid offset goes to the node") {
  Bay b = bay({Vec3(0, 0, 3), Vec3(6, 0, 3), Vec3(6, 4, 3), Vec3(0, 4, 3)});
  Member& member = b.frame.building.members[0];
  member.offsets = {Vec3(0.5, 0, 0), Vec3(-0.5, 0, 0)};
  member.length = 5;
  b.frame.building.panels[0].span = Span::y;
  const TributaryLoads handed = hand(b, pressure(1000));
  REQUIRE(handed.nodes.size() == 2);
  CHECK(handed.nodes[0].load(2) == Approx(-1000));
  CHECK(handed.nodes[0].load(4) == Approx(250));  // 1000 N at 0.25 m beyond the node turns about +y
  CHECK(handed.nodes[1].load(4) == Approx(-250));
  REQUIRE(handed.beams.size() == 2);
  CHECK(handed.beams[0].from == 0);
  CHECK(handed.beams[0].to == 5);
}

TEST_CASE("whatever the panel, what it hands over has its force and its moment") {
  std::mt19937 random(20240);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto between = [&](double a, double b) { return a + (b - a) * unit(random); };
  int compared = 0;
  for (int trial = 0; trial < 400; ++trial) {
    // Corners of a convex quadrilateral in the plane, then turned and moved.
    const std::array<Vec2, 4> flat{Vec2(between(-1, 1), between(-1, 1)), Vec2(between(4, 7), between(-1, 1)),
                                   Vec2(between(4, 7), between(3, 5)), Vec2(between(-1, 1), between(3, 5))};
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond(between(-1, 1), between(-1, 1), between(-1, 1), between(-1, 1)).normalized();
    const bool parallelogram = trial % 5 == 0;
    std::array<Vec3, 4> corner;
    for (std::size_t i = 0; i < 4; ++i) {
      Vec2 p = flat[i];
      if (parallelogram && i == 2) p = flat[1] + flat[3] - flat[0];
      const Vec3 place(p.x(), p.y(), 0);
      corner[i] = (trial % 3 == 0 ? place : turn * place) + Vec3(10, -4, 3);
    }
    Bay b = bay(corner);
    Building& building = b.frame.building;
    Panel& panel = building.panels[0];
    panel.span = std::array{Span::two_way, Span::x, Span::y}[static_cast<std::size_t>(trial % 4) % 3];
    if (trial % 2 == 0) {
      const Vec2 centre =
          panel.axes.topRows<2>() * (0.25 * (corner[0] + corner[1] + corner[2] + corner[3]) - corner[0]);
      panel.openings.push_back({centre + Vec2(between(-1, -0.2), between(-1, -0.2)),
                                centre + Vec2(between(0.2, 1), between(-1, -0.2)), centre + Vec2(between(0.2, 1), 0.7),
                                centre + Vec2(between(-1, -0.2), 0.4)});
    }
    // Eccentric members, and now and then an edge without one.
    for (Member& member : building.members) {
      const Vec3 whole = building[member.nodes[1]].position - building[member.nodes[0]].position;
      for (Vec3& offset : member.offsets) offset = 0.3 * Vec3(between(-1, 1), between(-1, 1), between(-1, 1));
      const Vec3 along = whole + member.offsets[1] - member.offsets[0];
      member.length = along.norm();
      const Vec3 x = along.normalized(), y = x.unitOrthogonal();
      member.axes << x.transpose(), y.transpose(), x.cross(y).transpose();
    }
    std::array<bool, 4> holds = all_hold;
    if (trial % 3 == 1) holds[static_cast<std::size_t>(trial) % 4] = false;
    PanelAction action;
    action.pressure = between(-1e3, 1e3);
    action.body_force = 1e3 * Vec3(between(-1, 1), between(-1, 1), between(-1, 1));
    std::vector<bool> stands(4, true);
    if (trial % 7 == 0) stands[static_cast<std::size_t>(trial) % 4] = false;
    const TributaryLoads handed = tributary_loads(building, EdgeMembers(building), b.panel, action, holds,
                                                  trial % 7 == 0 ? stands : std::vector<bool>{});
    const Vec6 expected = expected_resultant(building, b.panel, action), found = resultant(building, handed);
    // Relative to all that acts: some 30 m2 of it within 20 m of the origin; sums of a few hundred rounded numbers.
    const double force = 30 * (action.body_force.norm() + std::abs(action.pressure));
    INFO("trial " << trial << "\n" << expected.transpose() << "\n" << found.transpose());
    CHECK((found - expected).head<3>().norm() <= 1e-12 * force);
    CHECK((found - expected).tail<3>().norm() <= 1e-12 * force * 20);
    Vec3 edges = Vec3::Zero();
    for (const Vec3& edge : handed.edge_force) edges += edge;
    CHECK((edges - expected.head<3>()).norm() <= 1e-12 * force);
    ++compared;
  }
  CHECK(compared == 400);
}
