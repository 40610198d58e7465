// What the joints of a free body bear, against closed forms of free bars.
#include <catch2/catch.hpp>

#include <Eigen/Geometry>
#include <map>

#include "simulation/impact/free_segment.h"
#include "structure/frame_builder.h"

namespace {

using namespace topple::test;

constexpr double rounding = 1e-9;  // relative; statically determinate

/// A bar of two equal halves along x, jointed in the middle.
struct Bar {
  Bar() {
    const NodeId a = frame.node("A", 0, 0, 0), m = frame.node("M", length / 2, 0, 0), b = frame.node("B", length, 0, 0);
    const MemberId left = frame.member("AM", MemberKind::beam, a, m, {}, same_capacity(1e9));
    const MemberId right = frame.member("MB", MemberKind::beam, m, b, same_capacity(1e9));
    parts.members = {left, right};
    parts.nodes = {a, m, b};
    parts.member_mass = {mass / 2, mass / 2};
    parts.node_mass = {0, 0, 0};
  }
  static constexpr double length = 8, mass = 400;
  FrameBuilder frame;
  FreeSegmentParts parts;
};

bool all_hold(JointId) { return true; }

}  // namespace

TEST_CASE("a free bar that is hit in the middle bends by F l/8, at its end by F l/8 in the middle") {
  const Bar bar;
  FreeSegment segment(bar.frame.building, bar.parts, all_hold);
  REQUIRE(segment.can_break());
  const double F = 5e4, l = Bar::length;
  for (const double at : {l / 2, l}) {
    const FreePush push{bar.parts.members[1], {}, Vec3(at, 0, 0), Vec3(0, 0, F)};
    const auto answer = segment.bear({&push, 1}, Vec3::Zero(), Vec3(0, 0, -10));
    CHECK(answer.acceleration.z() == Approx(F / Bar::mass - 10));
    CHECK(answer.angular_acceleration.y() == Approx(at == l ? -6 * F / (Bar::mass * l) : 0.0).margin(1e-9));
    CHECK(answer.imbalance < 1e-10);
    REQUIRE(answer.demands.size() == 2);
    for (const auto& [joint, demand] : answer.demands)
      CHECK(std::abs(demand(4)) == Approx(F * l / 8).epsilon(rounding));
  }
}

TEST_CASE("free fall bears nothing, spin pulls by m w2 l/8") {
  const Bar bar;
  FreeSegment segment(bar.frame.building, bar.parts, all_hold);
  for (const auto& [joint, demand] : segment.bear({}, Vec3::Zero(), Vec3(0, 0, -10)).demands)
    CHECK(demand.norm() < 1e-6);
  const double w = 12;
  for (const auto& [joint, demand] : segment.bear({}, Vec3(0, 0, w), Vec3::Zero()).demands)
    CHECK(demand(0) == Approx(Bar::mass * w * w * Bar::length / 8).epsilon(rounding));
}

TEST_CASE("a spin that is not about a principal axis brings the gyroscopic moment, in balance") {
  // An L of two bars: products of inertia.
  FrameBuilder frame;
  const NodeId a = frame.node("A", 0, 0, 0), m = frame.node("M", 4, 0, 0), b = frame.node("B", 4, 3, 0);
  FreeSegmentParts parts;
  parts.members = {frame.member("AM", MemberKind::beam, a, m, {}, same_capacity(1e9)),
                   frame.member("MB", MemberKind::beam, m, b, same_capacity(1e9))};
  parts.nodes = {a, m, b};
  parts.member_mass = {200, 150};
  parts.node_mass = {0, 70, 0};
  FreeSegment segment(frame.building, parts, all_hold);
  const auto answer = segment.bear({}, Vec3(3, 1, 2), Vec3(0, 0, -10));
  CHECK(answer.imbalance < 1e-10);
  // d(I w)/dt = 0: angular momentum is kept, so that the kinetic energy's rate, w . I alpha, vanishes with it.
  CHECK(answer.angular_acceleration.norm() > 0.1);
  CHECK(answer.acceleration.z() == Approx(-10));
}

TEST_CASE("a free end is free, and a single member or a body of rigid joints is asked nothing") {
  const Bar bar;
  const auto cut = [&](JointId joint) { return joint != bar.frame.building.joint(bar.parts.members[0], 1); };
  CHECK_FALSE(FreeSegment(bar.frame.building, {{bar.parts.members[0]}, {}, {}, {200}, {}, {}}, all_hold).can_break());
  const auto pieces = connected_parts(bar.frame.building, bar.parts, cut);
  REQUIRE(pieces.size() == 2);
  CHECK(pieces[0].members == std::vector<MemberId>{bar.parts.members[0]});
  CHECK(pieces[0].nodes == std::vector<NodeId>{NodeId(0u)});
  CHECK(pieces[1].members == std::vector<MemberId>{bar.parts.members[1]});
  CHECK(pieces[1].nodes == std::vector<NodeId>{NodeId(1u), NodeId(2u)});
  CHECK(pieces[1].member_mass == std::vector<double>{Bar::mass / 2});
  CHECK(connected_parts(bar.frame.building, bar.parts, all_hold).size() == 1);
}

namespace {

/// A slab of 6 m x 4 m and 0.2 m on four beams that weigh next to nothing.
struct Floor {
  explicit Floor(PanelModel model) {
    const std::array<NodeId, 4> corner{frame.node("A", 0, 0, 0), frame.node("B", 6, 0, 0), frame.node("C", 6, 4, 0),
                                       frame.node("D", 0, 4, 0)};
    for (std::size_t i = 0; i < 4; ++i) {
      parts.members.push_back(frame.member("B" + std::to_string(i), MemberKind::beam, corner[i], corner[(i + 1) % 4]));
      parts.member_mass.push_back(1e-3);
      parts.nodes.push_back(corner[i]);
      parts.node_mass.push_back(0);
    }
    parts.panels.push_back(frame.panel("S", model, corner, same_capacity(1e9)));
    parts.panel_mass.push_back(mass);
    length = {6, 4, 6, 4};
  }
  FreeSegment segment(const std::function<bool(JointId)>& holds = all_hold,
                      const std::function<Eigen::MatrixXd(PanelId)>& stiffness = nullptr) {
    return {frame.building, parts, holds, stiffness,
            [this, holds](PanelId panel) -> std::optional<std::array<double, 4>> {
              std::array<double, 4> there = length;
              for (int edge = 0; edge < 4; ++edge)
                if (!holds(frame.building.joint(panel, edge))) there[static_cast<std::size_t>(edge)] = 0;
              return there;
            }};
  }
  [[nodiscard]] JointId edge(int number) const { return frame.building.joint(parts.panels[0], number); }
  static constexpr double mass = 11520;
  FrameBuilder frame;
  FreeSegmentParts parts;
  std::array<double, 4> length{};
};

std::map<JointId, Vec6> by_joint(const FreeSegment::Answer& answer) {
  return {answer.demands.begin(), answer.demands.end()};
}

}  // namespace

TEST_CASE("a floor that is stopped by its beams pulls at its edges with its inertia, along their length alike") {
  Floor floor(PanelModel::membrane);
  FreeSegment segment = floor.segment();
  REQUIRE(segment.can_break());
  // The beams land all along, so that nothing turns: 2 F on each long one, F on each short one.
  const double F = 4e4;
  std::vector<FreePush> pushes;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& [a, b] = floor.frame.building[floor.parts.members[i]].nodes;
    const Vec3 middle = (floor.frame.building[a].position + floor.frame.building[b].position) / 2;
    pushes.push_back({floor.parts.members[i], {}, middle, Vec3(0, 0, i % 2 == 0 ? 2 * F : F)});
  }
  const auto landed = by_joint(segment.bear(pushes, Vec3::Zero(), Vec3(0, 0, -10)));
  REQUIRE(landed.size() == 4);
  // The edges bear all that acts on the beams, which have no mass to speak of.
  for (int edge = 0; edge < 4; ++edge) {
    CHECK(landed.at(floor.edge(edge))(2) == Approx(6 * F / 20).epsilon(1e-5));
    CHECK(landed.at(floor.edge(edge)).head<2>().norm() < 1e-6 * F);
  }
  for (const auto& [joint, demand] : by_joint(segment.bear({}, Vec3::Zero(), Vec3(0, 0, -10))))
    CHECK(demand.norm() < 1e-6);  // free fall
}

TEST_CASE("what hits a floor from below goes into its edges, more into those that are nearer, in balance") {
  Floor floor(PanelModel::membrane);
  FreeSegment segment = floor.segment();
  const double F = 1e5;
  const Vec3 at(1.5, 2, 0);
  const FreePush push{{}, floor.parts.panels[0], at, Vec3(0, 0, F)};
  const auto answer = segment.bear({&push, 1}, Vec3::Zero(), Vec3::Zero());
  const auto hit = by_joint(answer);
  // The beams weigh nothing: what the edges do to the slab keeps its own inertia and the impact in balance, so it is
  // nothing in sum, and in moment.
  Vec3 force = Vec3::Zero();
  for (int edge = 0; edge < 4; ++edge)
    force += hit.at(floor.edge(edge)).head<3>() * floor.length[static_cast<std::size_t>(edge)];
  CHECK(force.norm() < 1e-5 * F);
  // Held back in place instead (as heavy beams would): all of the impact goes into the edges, by their distance.
  const PanelPush impact{at, Vec3(0, 0, F)};
  const auto held = free_panel_edge_demands(floor.frame.building, floor.parts.panels[0], floor.length, {&impact, 1});
  double sum = 0, about_y = 0;
  const std::array<double, 4> place{3, 6, 3, 0};
  for (std::size_t edge = 0; edge < 4; ++edge) {
    sum += held[edge](2) * floor.length[edge];
    about_y += held[edge](2) * floor.length[edge] * place[edge];
    // Moments about the edges' middles: along x for the long ones, about y.
    if (edge % 2 == 0) about_y += (edge == 0 ? 1 : -1) * held[edge](3) * floor.length[edge];
    if (edge % 2 == 1) about_y += (edge == 1 ? 1 : -1) * -held[edge](4) * floor.length[edge];
  }
  CHECK(sum == Approx(-F));
  CHECK(about_y == Approx(-F * at.x()));
  CHECK(held[3](2) < held[1](2));  // the left edge bears more, downwards
}

TEST_CASE("a floor that only one edge holds hangs by it with force and moment") {
  Floor floor(PanelModel::cladding);
  const PanelPush weight{Vec3(3, 2, 0), Vec3(0, 0, -1000)};
  const auto held = free_panel_edge_demands(floor.frame.building, floor.parts.panels[0], {6, 0, 0, 0}, {&weight, 1});
  CHECK(held[0](2) == Approx(1000.0 / 6));
  CHECK(std::abs(held[0](4)) == Approx(1000.0 * 2 / 6));  // about the edge, 2 m from the middle
  for (std::size_t edge = 1; edge < 4; ++edge) CHECK(held[edge].norm() == 0);
}

TEST_CASE("a shell in flight bears at its edges what its stiffness takes up, and what it let go of is free") {
  // Two plates side by side on a beam between them: the left one is hit, and pulls at the common beam.
  Floor floor(PanelModel::shell);
  floor.frame.building.panels[0].joined = {true, true, true, true};
  // Any stiffness that keeps the plate in balance: springs between all its corners.
  const Building& building = floor.frame.building;
  const auto stiffness = [&](PanelId) -> Eigen::MatrixXd {
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(24, 24);
    const auto& nodes = building.panels[0].nodes;
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b) {
        if (a == b) continue;
        // A rigid arm from a to b with springs of all six freedoms at its end.
        Eigen::Matrix<double, 6, 6> arm = Eigen::Matrix<double, 6, 6>::Identity();
        const Vec3 r = building[nodes[static_cast<std::size_t>(b)]].position -
                       building[nodes[static_cast<std::size_t>(a)]].position;
        arm.topRightCorner<3, 3>() << 0, r.z(), -r.y(), -r.z(), 0, r.x(), r.y(), -r.x(), 0;
        Eigen::Matrix<double, 6, 24> gap = Eigen::Matrix<double, 6, 24>::Zero();
        gap.block<6, 6>(0, 6 * a) = arm;
        gap.block<6, 6>(0, 6 * b) = -Eigen::Matrix<double, 6, 6>::Identity();
        K += 1e7 * gap.transpose() * gap;
      }
    return K;
  };
  const FreePush push{{}, floor.parts.panels[0], Vec3(1.5, 1, 0), Vec3(0, 0, 1e5)};
  // The corner between the first and the last edge hangs on nothing.
  const auto broken = [&](JointId joint) { return joint != floor.edge(0) && joint != floor.edge(3); };
  for (const bool whole : {true, false}) {
    FreeSegment segment = whole ? floor.segment(all_hold, stiffness) : floor.segment(broken, stiffness);
    const auto answer = segment.bear({&push, 1}, Vec3::Zero(), Vec3::Zero());
    const auto demands = by_joint(answer);
    REQUIRE(demands.size() == (whole ? 4 : 2));
    CHECK(answer.imbalance < 1e-6);
    // The beams have no mass: the plate is in balance by itself, so its edges bear nothing in sum.
    Vec3 force = Vec3::Zero();
    for (const auto& [joint, demand] : demands)
      force.z() += demand(2) * floor.length[static_cast<std::size_t>(building[joint].end)];
    CHECK(std::abs(force.z()) < 1e-4 * 1e5);
  }
}

TEST_CASE("a floor goes with the part that holds two of its opposite edges, and by itself when none does") {
  Floor floor(PanelModel::membrane);
  const Building& building = floor.frame.building;
  const auto edges = [&](const std::array<double, 4>& length) {
    return [length](PanelId) -> std::optional<std::array<double, 4>> { return length; };
  };
  CHECK(connected_parts(building, floor.parts, all_hold, edges(floor.length)).size() == 1);
  const auto alone = connected_parts(building, floor.parts, all_hold, edges({6, 4, 0, 0}));
  REQUIRE(alone.size() == 2);
  CHECK(alone[0].members.size() == 4);
  CHECK(alone[1].members.empty());
  CHECK(alone[1].panels == floor.parts.panels);
  CHECK(alone[1].panel_mass == floor.parts.panel_mass);
  // The beam along y at the left is torn off at both its ends: the pair along x still holds it.
  const MemberId left = floor.parts.members[3];
  const auto torn = [&](JointId joint) { return joint != building.joint(left, 0) && joint != building.joint(left, 1); };
  const auto two = connected_parts(building, floor.parts, torn, edges(floor.length));
  REQUIRE(two.size() == 2);
  CHECK(two[0].panels == floor.parts.panels);
}

TEST_CASE("a free bar gives way by l^3/(320 E I) in the middle, l^3/(105 E I) at its end, l/(3 E A) along itself") {
  const Bar bar;
  FreeSegment segment(bar.frame.building, bar.parts, all_hold);
  const Building& building = bar.frame.building;
  const Member& member = building[bar.parts.members[0]];
  const Section& section = building[member.section];
  const Material& material = building[member.material];
  const double l = Bar::length, EI = material.youngs_modulus * section.Iy, EA = material.youngs_modulus * section.area;
  const double GA = section.shear_area_z > 0 ? material.shear_modulus * section.shear_area_z : 0;
  // Bending moments of a free bar in balance with its own even inertia: q x^2/2 to the middle, x (1 - x/l)^2 from the
  // end. Of the shear forces: the integrals of (x/l)^2 twice to the middle, l/12, and of (1 - 4 s + 3 s^2)^2, 2 l/15.
  const double shear_middle = GA > 0 ? l / 12 / GA : 0, shear_end = GA > 0 ? 2 * l / 15 / GA : 0;
  const std::vector<FreePush> pushes{{bar.parts.members[0], {}, Vec3(l / 2, 0, 0), Vec3(0, 0, 1)},
                                     {bar.parts.members[1], {}, Vec3(l, 0, 0), Vec3(0, 0, 1)},
                                     {bar.parts.members[0], {}, Vec3(0, 0, 0), Vec3(1, 0, 0)}};
  const FreeSegment::Flexibility flexibility = segment.flexibility(pushes);
  CHECK(flexibility.compliance(0, 0) == Approx(l * l * l / (320 * EI) + shear_middle).epsilon(rounding));
  CHECK(flexibility.compliance(1, 1) == Approx(l * l * l / (105 * EI) + shear_end).epsilon(rounding));
  CHECK(flexibility.compliance(2, 2) == Approx(l / (3 * EA)).epsilon(rounding));
  CHECK(std::abs(flexibility.compliance(0, 2)) < rounding * flexibility.compliance(2, 2));
  CHECK(flexibility.compliance(0, 1) == Approx(flexibility.compliance(1, 0)).epsilon(1e-15));
  // Each newton adds l/8 to the moment of the joints in the middle.
  REQUIRE(flexibility.demands.size() == 2);
  for (const auto& [joint, step] : flexibility.demands)
    for (int place = 0; place < 2; ++place) CHECK(std::abs(step(4, place)) == Approx(l / 8).epsilon(rounding));
}

TEST_CASE("a single free member gives way as a bar does though no joint of it could break") {
  FrameBuilder frame;
  const NodeId a = frame.node("A", 0, 0, 0), b = frame.node("B", 6, 0, 0);
  FreeSegmentParts parts;
  parts.members = {frame.member("AB", MemberKind::beam, a, b)};
  parts.nodes = {a, b};
  parts.member_mass = {300};
  parts.node_mass = {0, 0};
  FreeSegment segment(frame.building, parts, all_hold);
  CHECK_FALSE(segment.can_break());
  const Section& section = frame.building[frame.building[parts.members[0]].section];
  const Material& material = frame.building[frame.building[parts.members[0]].material];
  const FreePush push{parts.members[0], {}, Vec3(0, 0, 0), Vec3(1, 0, 0)};
  const auto flexibility = segment.flexibility({&push, 1});
  CHECK(flexibility.compliance(0, 0) == Approx(6 / (3 * material.youngs_modulus * section.area)).epsilon(rounding));
  CHECK(flexibility.demands.empty());
}
