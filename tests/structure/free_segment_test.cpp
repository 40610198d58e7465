// What the joints of a free body bear, against closed forms of free bars.
#include <catch2/catch.hpp>

#include <Eigen/Geometry>

#include "simulation/free_segment.h"
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
