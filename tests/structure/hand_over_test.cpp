// What panels hand to their edges: classic distributions, and force and moments kept whatever the shape.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>

#include "topple/structure/frame.h"
#include "topple/structure/joint_check.h"

using namespace topple::structure;

namespace {

/// One panel in a frame of four beams (or fewer), in a plane turned by `turn`.
Building make_panel(const std::array<Vec2, 4>& corner, const Mat3& turn = Mat3::Identity(), int beams = 4) {
  Building b;
  b.materials.emplace_back();
  b.sections.emplace_back();
  Panel panel;
  for (std::size_t i = 0; i < 4; ++i) {
    b.nodes.push_back({"N" + std::to_string(i), turn * Vec3(corner[i].x(), corner[i].y(), 0) + Vec3(3, -2, 5)});
    panel.nodes[i] = NodeId(i);
  }
  panel.material = MaterialId(0u);
  const Vec3 x = (b.nodes[1].position - b.nodes[0].position).normalized(), z = turn.col(2);
  panel.axes << x.transpose(), z.cross(x).transpose(), z.transpose();
  b.panels.push_back(panel);
  for (int e = 0; e < beams; ++e) {
    Member m;
    m.nodes = {NodeId(static_cast<std::size_t>(e)), NodeId(static_cast<std::size_t>((e + 1) % 4))};
    if (e % 2) std::swap(m.nodes[0], m.nodes[1]);  // also against the edge's sense
    m.section = SectionId(0u);
    m.material = MaterialId(0u);
    const Vec3 along = b[m.nodes[1]].position - b[m.nodes[0]].position;
    m.length = along.norm();
    const Vec3 mx = along / m.length, up = std::abs(mx.z()) > 0.9 ? Vec3(Vec3::UnitX()) : Vec3(Vec3::UnitZ());
    const Vec3 my = up.cross(mx).normalized();
    m.axes << mx.transpose(), my.transpose(), mx.cross(my).transpose();
    b.members.push_back(m);
  }
  return b;
}

/// Force and moment about the origin of all that is handed over.
Vec6 resultant(const Building& b, const HandOver& given) {
  Vec6 sum = Vec6::Zero();
  const auto add = [&](const Vec3& at, const Vec3& force, const Vec3& moment) {
    sum.head<3>() += force;
    sum.tail<3>() += at.cross(force) + moment;
  };
  for (const auto& load : given.nodes)
    add(b.nodes[static_cast<std::size_t>(load.node)].position, load.load.head<3>(), load.load.tail<3>());
  for (const auto& load : given.beams) {
    const Member& m = b.members[static_cast<std::size_t>(load.beam)];
    const Vec3 start = b[m.nodes[0]].position + m.offsets[0];
    const auto at = [&](double x) { return Vec3(start + x * m.axes.row(0).transpose()); };
    const auto global = [&](const Vec6& v) {
      Vec6 g;
      g << m.axes.transpose() * v.head<3>(), m.axes.transpose() * v.tail<3>();
      return g;
    };
    if (load.from == load.to) {
      const Vec6 v = global(load.first);
      add(at(load.from), v.head<3>(), v.tail<3>());
      continue;
    }
    // Simpson's rule: exact for a linear load times a linear arm.
    const double width = load.to - load.from;
    const Vec6 values[3] = {global(load.first), global((load.first + load.last) / 2), global(load.last)};
    for (int k = 0; k < 3; ++k) {
      const double weight = width * (k == 1 ? 4.0 : 1.0) / 6;
      add(at(load.from + width * k / 2), weight * values[k].head<3>(), weight * values[k].tail<3>());
    }
  }
  return sum;
}

/// The panel's own: its area without openings, as triangles.
Vec6 expected(const Building& b, const Panel& panel, const Vec3& traction) {
  Vec6 sum = Vec6::Zero();
  const auto polygon = [&](const std::vector<Vec2>& p, double sign) {
    for (std::size_t i = 1; i + 1 < p.size(); ++i) {
      const Vec2 u = p[i] - p[0], v = p[i + 1] - p[0];
      const double area = sign * (u.x() * v.y() - u.y() * v.x()) / 2;
      const Vec2 c = (p[0] + p[i] + p[i + 1]) / 3;
      const Vec3 at = b[panel.nodes[0]].position + panel.axes.transpose() * Vec3(c.x(), c.y(), 0);
      sum.head<3>() += area * traction;
      sum.tail<3>() += area * at.cross(traction);
    }
  };
  std::vector<Vec2> border;
  for (const NodeId node : panel.nodes)
    border.push_back((panel.axes * (b[node].position - b[panel.nodes[0]].position)).head<2>());
  polygon(border, 1);
  for (const auto& opening : panel.openings) polygon(opening, -1);
  return sum;
}

constexpr std::array<bool, 4> all{true, true, true, true};

HandOver give(const Building& b, const PanelAction& action, const std::array<bool, 4>& holds = all) {
  return hand_over(b, EdgeMembers(b), PanelId(0u), action, holds);
}

Mat3 upright() {  // local y up: a wall
  Mat3 turn;
  turn << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return turn;
}

}  // namespace

TEST_CASE("a two-way slab gives trapezoids to its long edges and triangles to its short ones") {
  const Building b = make_panel({Vec2(0, 0), Vec2(8, 0), Vec2(8, 6), Vec2(0, 6)});
  PanelAction action;
  action.pressure = 1000;
  const HandOver given = give(b, action);
  CHECK(given.edge_force[0].z() == Approx(-1000.0 * 3 * (8 + 2) / 2));
  CHECK(given.edge_force[1].z() == Approx(-1000.0 * 6 * 3 / 2));
  double deepest = 0;
  for (const auto& load : given.beams) deepest = std::max({deepest, std::abs(load.first[2]), std::abs(load.last[2])});
  CHECK(deepest == Approx(3000));  // half of the short span
  CHECK((resultant(b, given) - expected(b, b.panels[0], Vec3(0, 0, -1000))).norm() < 1e-9);
}

TEST_CASE("a one-way slab loads only the edges that its strips reach") {
  Building b = make_panel({Vec2(0, 0), Vec2(8, 0), Vec2(8, 6), Vec2(0, 6)});
  PanelAction action;
  action.pressure = 1000;
  b.panels[0].span = Span::x;
  HandOver given = give(b, action);
  CHECK(given.edge_force[0].norm() == 0);
  CHECK(given.edge_force[1].z() == Approx(-24000));
  b.panels[0].span = Span::y;
  given = give(b, action);
  CHECK(given.edge_force[0].z() == Approx(-24000));
  CHECK(given.edge_force[3].norm() == 0);
}

TEST_CASE("a wall's weight stands on its lowest edge, less over a door") {
  Building b = make_panel({Vec2(0, 0), Vec2(6, 0), Vec2(6, 3), Vec2(0, 3)}, upright());
  PanelAction action;
  action.body_force = Vec3(0, 0, -3600);
  HandOver given = give(b, action);
  CHECK(given.edge_force[0].z() == Approx(-3600.0 * 18));
  REQUIRE(given.beams.size() == 1);
  CHECK((b.members[0].axes.transpose() * given.beams[0].first.head<3>()).z() == Approx(-3600.0 * 3));
  b.panels[0].openings = {{Vec2(1.5, 0), Vec2(2.5, 0), Vec2(2.5, 2.1), Vec2(1.5, 2.1)}};
  given = give(b, action);
  REQUIRE(given.beams.size() == 3);
  CHECK((b.members[0].axes.transpose() * given.beams[1].first.head<3>()).z() == Approx(-3600.0 * 0.9));
  CHECK((resultant(b, given) - expected(b, b.panels[0], action.body_force)).norm() < 1e-9);
}

TEST_CASE("force and moments of a panel are kept whatever its shape, openings, edges and members") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(-0.8, 0.8), angle(-3, 3);
  for (int k = 0; k < 400; ++k) {
    const bool rectangle = k % 3 == 0;
    std::array<Vec2, 4> corner{Vec2(0, 0), Vec2(6, 0), Vec2(6, 4), Vec2(0, 4)};
    if (!rectangle)
      for (Vec2& c : corner) c += Vec2(part(random), part(random));
    Mat3 turn;
    turn = Eigen::AngleAxisd(angle(random), Vec3(part(random), part(random), 1).normalized());
    Building b = make_panel(corner, turn, static_cast<int>(random() % 5));
    Panel& panel = b.panels[0];
    if (k % 2) {
      const Vec2 c(2.5 + part(random), 2 + part(random) / 2);
      panel.openings = {{c, c + Vec2(0.7, 0.1), c + Vec2(0.6, 0.8), c + Vec2(-0.1, 0.6)}};
    }
    panel.span = static_cast<Span>(random() % 3);
    if (!rectangle && panel.openings.empty()) panel.span = Span::x;  // two-way keeps moments in rectangles
    for (Member& m : b.members)
      if (random() % 2) {
        m.offsets = {Vec3(0.2 * m.axes.row(0).transpose()), Vec3(-0.3 * m.axes.row(0).transpose())};
        m.length -= 0.5;
      }
    std::array<bool, 4> holds = all;
    if (k % 5 == 0) holds[random() % 4] = false;
    PanelAction action;
    action.pressure = 1000 * part(random);
    action.body_force = Vec3(part(random), part(random), -3) * 1000;
    const Vec3 traction = action.body_force - action.pressure * panel.axes.row(2).transpose();
    const HandOver given = give(b, action, holds);
    const Vec6 sum = resultant(b, given), wanted = expected(b, panel, traction);
    INFO("case " << k);
    // Forces of some 1e5 N at arms of some 10 m: rounding of sums.
    CHECK((sum - wanted).head<3>().norm() < 1e-12 * wanted.head<3>().norm());
    CHECK((sum - wanted).tail<3>().norm() < 1e-11 * wanted.norm());
    Vec3 edges = Vec3::Zero();
    for (const Vec3& f : given.edge_force) edges += f;
    CHECK((edges - wanted.head<3>()).norm() < 1e-12 * wanted.head<3>().norm());
  }
}

TEST_CASE("collinear members share an edge, and a panel without an opposite pair hands nothing over") {
  Building b = make_panel({Vec2(0, 0), Vec2(8, 0), Vec2(8, 6), Vec2(0, 6)}, Mat3::Identity(), 0);
  b.nodes.push_back({"M", (b.nodes[0].position + b.nodes[1].position) / 2});
  for (const auto& [from, to] : {std::pair{0u, 4u}, std::pair{4u, 1u}}) {
    Member m;
    m.nodes = {NodeId(from), NodeId(to)};
    m.length = 4;
    m.section = SectionId(0u);
    m.material = MaterialId(0u);
    b.members.push_back(m);
  }
  PanelAction action;
  action.pressure = 1000;
  const HandOver given = give(b, action);
  CHECK(EdgeMembers(b).of(PanelId(0u), 0).size() == 2);
  for (int beam = 0; beam < 2; ++beam) {
    double total = 0;
    for (const auto& load : given.beams)
      if (load.beam == beam) total += (load.first[2] + load.last[2]) / 2 * (load.to - load.from);
    CHECK(total == Approx(-7500));  // half of a trapezoid of 15 m2
  }
  CHECK(give(b, action, {true, true, false, false}).beams.empty());
  CHECK(give(b, action, {true, true, false, false}).nodes.empty());
}

TEST_CASE("a joint's use follows its interaction rule and its strength") {
  JointCapacity capacity;
  capacity.value = {100, 200, 50, 50, 20, 10, 5};
  Vec6 demand;
  demand << -100, 10, -20, 4, 5, -2;
  Utilisation used = utilisation(capacity, demand);
  CHECK(used.value == Approx(0.5));
  CHECK(used.sense == Sense::compression);  // the first of equals
  capacity.interaction = Interaction::sum;
  used = utilisation(capacity, demand, 0.5);
  CHECK(used.value == Approx(2 * (0.5 + 0.5 + 0.4)));
  CHECK(utilisation(capacity, demand, 0).value == unlimited);
  CHECK(utilisation(JointCapacity{}, demand).value == 0);
}
