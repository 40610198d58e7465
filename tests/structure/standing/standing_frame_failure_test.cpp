// What breaks, when, and what is left: against closed forms of beams and portals.
#include <catch2/catch.hpp>

#include "structure/frame_builder.h"
#include "topple/structure/standing_frame.h"

namespace {

using namespace topple::test;

constexpr double q = 1000;         // N/m
constexpr double rounding = 1e-9;  // relative; statically determinate or closed-form answers, condition below 1e6

FailureRules quiet(double sudden = 1) {
  FailureRules rules;
  rules.bracing = BracingRule::none;
  rules.mechanism = MechanismRule::detach;
  rules.sudden = sudden;
  return rules;
}

/// A beam built in at both ends under q, `length` long; its second joint takes `moment`.
FrameBuilder built_in_beam(double length, double moment) {
  FrameBuilder frame;
  const NodeId a = frame.node("A", 0, 0, 3), b = frame.node("B", length, 0, 3);
  JointCapacity capacity = same_capacity(unlimited);
  capacity.value[5] = moment;
  const MemberId beam = frame.member("AB", MemberKind::beam, a, b, same_capacity(unlimited), capacity);
  frame.support(a);
  frame.support(b);
  frame.load(beam, -q);
  return frame;
}

}  // namespace

TEST_CASE("a portal that loses a post's foot hangs on the other post") {
  FrameBuilder frame;
  const double span = 6, height = 4;
  const NodeId a0 = frame.node("A0", 0, 0, 0), a1 = frame.node("A1", 0, 0, height);
  const NodeId b1 = frame.node("B1", span, 0, height), b0 = frame.node("B0", span, 0, 0);
  const MemberId pa = frame.member("PA", MemberKind::post, a0, a1, same_capacity(1e9));
  const MemberId pb = frame.member("PB", MemberKind::post, b0, b1, same_capacity(1e9));
  const MemberId beam = frame.member("AB", MemberKind::beam, a1, b1, same_capacity(1e9), same_capacity(1e9));
  frame.support(a0);
  frame.support(b0);
  frame.load(beam, -q);
  StandingFrame standing(frame.building, CombinationId(0u), quiet());
  const JointId foot = frame.building.joint(pa, 0);
  CHECK(standing.demand(foot)(0) == Approx(-q * span / 2).epsilon(rounding));

  standing.break_joint(frame.building.joint(pb, 0), BreakCause::tool);
  const auto breaks = standing.settle(10);
  REQUIRE(breaks.size() == 1);
  CHECK(breaks[0].cause == BreakCause::tool);
  CHECK(breaks[0].position == Vec3(span, 0, 0));
  CHECK(standing.demand(foot)(0) == Approx(-q * span).epsilon(rounding));
  // The post's local z is global x's... whatever the axes: the moment is q L^2/2 about global y alone.
  CHECK(standing.demand(foot).tail<3>().norm() == Approx(q * span * span / 2).epsilon(rounding));
  CHECK(standing.stands(pb));
  CHECK(standing.extract_detached().empty());
  CHECK_FALSE(standing.pending());
}

TEST_CASE("a sudden loss is checked at R0 + f (R - R0) and settles at R") {
  // Built in: q L^2/12 at the joint. Cantilever: q L^2/2. With f = 2 the peak is (1/12 + 2 (1/2 - 1/12)) = 11/12 q L^2.
  const double length = 5, peak = 11.0 / 12 * q * length * length;
  for (const double margin : {1.001, 0.999}) {
    const FrameBuilder frame = built_in_beam(length, margin * peak);
    StandingFrame standing(frame.building, CombinationId(0u), quiet(2));
    const MemberId beam(0u);
    const JointId held = frame.building.joint(beam, 1);
    CHECK(standing.utilisation(held).value == Approx(1 / (11 * margin)).epsilon(rounding));
    standing.break_joint(frame.building.joint(beam, 0), BreakCause::tool);
    const auto breaks = standing.settle(10);
    CHECK(standing.largest_utilisation_so_far(held) == Approx(1 / margin).epsilon(rounding));
    if (margin > 1) {
      CHECK(breaks.size() == 1);
      CHECK(standing.stands(beam));
      CHECK(standing.utilisation(held).value == Approx(6 / (11 * margin)).epsilon(rounding));
      // At rest R is the new R0: weakening to just above the static demand breaks nothing.
      standing.set_strength_factor(held, 1.001 * 6 / 11);
      CHECK(standing.pending());
      CHECK(standing.settle(10).empty());
      CHECK(standing.stands(beam));
    } else {
      REQUIRE(breaks.size() == 2);
      CHECK(breaks[1].joint == held);
      CHECK(breaks[1].cause == BreakCause::overload);
      CHECK(breaks[1].sense == Sense::moment_y);
      CHECK(breaks[1].demand == Approx(peak).epsilon(rounding));
      CHECK_FALSE(standing.stands(beam));
      const auto detached = standing.extract_detached();
      REQUIRE(detached.size() == 1);
      CHECK(detached[0].members == std::vector<MemberId>{beam});
      CHECK_FALSE(detached[0].mechanism);
    }
  }
}

TEST_CASE("a load that an event adds at once counts with the sudden factor, a contact load does not") {
  const double length = 4, force = 3000;
  for (const bool contact : {false, true}) {
    FrameBuilder frame;
    const NodeId a = frame.node("A", 0, 0, 3), b = frame.node("B", length, 0, 3);
    const MemberId beam = frame.member("AB", MemberKind::beam, a, b, same_capacity(1e5));
    frame.support(a);
    frame.load(beam, -q);
    StandingFrame standing(frame.building, CombinationId(0u), quiet(2));
    Vec6 load = Vec6::Zero();
    load(2) = -force;
    if (contact)
      standing.set_contact_load({7, {beam, {}, Vec3(length, 0, 3)}, load.head<3>()});
    else
      standing.add_load(b, load);
    CHECK(standing.settle(10).empty());
    const JointId root = frame.building.joint(beam, 0);
    const double at_rest = q * length * length / 2 + force * length;
    CHECK(std::abs(standing.demand(root)(4)) == Approx(at_rest).epsilon(rounding));
    CHECK(standing.largest_utilisation_so_far(root) ==
          Approx((at_rest + (contact ? 0 : force * length)) / 1e5).epsilon(rounding));
    if (contact) {
      standing.remove_contact_load(7);
      standing.settle(10);
      CHECK(std::abs(standing.demand(root)(4)) == Approx(q * length * length / 2).epsilon(rounding));
    }
  }
}

TEST_CASE("an overhang breaks at its root when it is longer than the joints bear") {
  // n bays of 3 m that lost their far support: the root bears q (3 n)^2/2, the joint at bay k only q (3 (n - k))^2/2.
  const double bay = 3, capacity = 0.5 * q * (3.5 * bay) * (3.5 * bay);
  for (int bays = 1; bays <= 6; ++bays) {
    FrameBuilder frame;
    std::vector<NodeId> nodes{frame.node("N0", 0, 0, 3)};
    std::vector<MemberId> beams;
    for (int i = 1; i <= bays; ++i) {
      nodes.push_back(frame.node("N" + std::to_string(i), i * bay, 0, 3));
      beams.push_back(frame.member("B" + std::to_string(i), MemberKind::beam, nodes[nodes.size() - 2], nodes.back(),
                                   same_capacity(capacity)));
      frame.load(beams.back(), -q);
    }
    frame.support(nodes.front());
    frame.support(nodes.back());
    StandingFrame standing(frame.building, CombinationId(0u), quiet());
    standing.remove_support(nodes.back());
    const auto breaks = standing.settle(10);
    const auto detached = standing.extract_detached();
    if (bays <= 3) {
      CHECK(breaks.empty());
      CHECK(detached.empty());
    } else {
      REQUIRE(breaks.size() == 1);
      CHECK(breaks[0].joint == frame.building.joint(beams[0], 0));
      REQUIRE(detached.size() == 1);
      CHECK(detached[0].members == beams);
      CHECK(standing.intact(frame.building.joint(beams[1 % beams.size()], 0)));
    }
  }
}

TEST_CASE("joints over capacity at the start break in the first generation, and the limit of generations holds") {
  // Three equal built-in beams of different strength, all overloaded: the most used goes first, one in each generation.
  FrameBuilder frame;
  const double length = 5, moment = q * length * length / 12;
  std::vector<MemberId> beams;
  for (int i = 0; i < 3; ++i) {
    const NodeId a = frame.node("A" + std::to_string(i), 0, i, 3),
                 b = frame.node("B" + std::to_string(i), length, i, 3);
    beams.push_back(frame.member("M" + std::to_string(i), MemberKind::beam, a, b,
                                 same_capacity(moment * (0.9 - 0.1 * i)), same_capacity(1e9)));
    // One segment: the far ends hang on one support line through stiff ties.
    if (i > 0) frame.member("T" + std::to_string(i), MemberKind::brace, NodeId(static_cast<std::size_t>(2 * i - 1)), b);
    frame.support(a);
    frame.support(b);
    frame.load(beams.back(), -q);
  }
  StandingFrame standing(frame.building, CombinationId(0u), quiet());
  CHECK(standing.pending());
  auto breaks = standing.settle(1);
  REQUIRE(breaks.size() == 1);
  CHECK(breaks[0].joint == frame.building.joint(beams[2], 0));
  CHECK(breaks[0].cause == BreakCause::overload);
  CHECK(standing.pending());
  breaks = standing.settle(10);
  REQUIRE(breaks.size() == 2);
  CHECK(breaks[0].joint == frame.building.joint(beams[1], 0));
  CHECK(breaks[1].joint == frame.building.joint(beams[0], 0));
  CHECK(breaks[0].generation == 0);
  CHECK(breaks[1].generation == 1);
  CHECK_FALSE(standing.pending());
}

TEST_CASE("equal joints break together, in order of id") {
  FrameBuilder frame;
  const double length = 5;
  const NodeId a = frame.node("A", 0, 0, 3), b = frame.node("B", length, 0, 3);
  const MemberId beam = frame.member("AB", MemberKind::beam, a, b, same_capacity(q * length * length / 13),
                                     same_capacity(q * length * length / 13));
  frame.support(a);
  frame.support(b);
  frame.load(beam, -q);
  StandingFrame standing(frame.building, CombinationId(0u), quiet());
  const auto breaks = standing.settle(10);
  REQUIRE(breaks.size() == 2);
  CHECK(breaks[0].joint < breaks[1].joint);
  CHECK(breaks[1].generation == 0);
  CHECK(standing.extract_detached().size() == 1);
}

TEST_CASE("a beam that keeps one pin only leaves as a mechanism") {
  FrameBuilder frame = built_in_beam(5, 1e9);
  frame.building.joints[1].stiffness(4) = 0;
  StandingFrame standing(frame.building, CombinationId(0u), quiet());
  standing.break_joint(JointId(0u), BreakCause::tool);
  const auto breaks = standing.settle(10);
  REQUIRE(breaks.size() == 2);
  CHECK(breaks[1].joint == JointId(1u));
  const auto detached = standing.extract_detached();
  REQUIRE(detached.size() == 1);
  CHECK(detached[0].mechanism);
  CHECK(detached[0].members.size() == 1);
}

TEST_CASE("the part of a mechanism that moves is released, what holds it breaks, the rest stands") {
  // Two portals side by side share the middle post. The left foot is a pin about global y; when the beam beside it
  // goes, that post can swing.
  FrameBuilder frame;
  const double span = 6, height = 4;
  const NodeId a0 = frame.node("A0", 0, 0, 0), a1 = frame.node("A1", 0, 0, height);
  const NodeId b0 = frame.node("B0", span, 0, 0), b1 = frame.node("B1", span, 0, height);
  const MemberId pa = frame.member("PA", MemberKind::post, a0, a1, same_capacity(1e9));
  const MemberId pb = frame.member("PB", MemberKind::post, b0, b1, same_capacity(1e9));
  const MemberId beam = frame.member("AB", MemberKind::beam, a1, b1, same_capacity(1e9), same_capacity(1e9));
  for (JointId joint : {frame.building.joint(pa, 0)})
    frame.building.joints[static_cast<std::size_t>(joint.index)].stiffness.tail<2>().setZero();
  frame.support(a0);
  frame.support(b0);
  frame.load(beam, -q);
  StandingFrame standing(frame.building, CombinationId(0u), quiet());
  standing.break_joint(frame.building.joint(beam, 0), BreakCause::tool);
  const auto breaks = standing.settle(10);
  REQUIRE(breaks.size() == 2);
  CHECK(breaks[1].joint == frame.building.joint(pa, 0));
  const auto detached = standing.extract_detached();
  REQUIRE(detached.size() == 1);
  CHECK(detached[0].mechanism);
  CHECK(detached[0].members == std::vector<MemberId>{pa});
  CHECK(detached[0].nodes == std::vector<NodeId>{a1});
  CHECK(standing.stands(beam));
  CHECK(standing.stands(pb));
  // The beam is now a cantilever from the other post.
  CHECK(standing.demand(frame.building.joint(pb, 0)).tail<3>().norm() == Approx(q * span * span / 2).epsilon(rounding));
}

TEST_CASE("the classic rule snaps a post joint that lost its last beam") {
  const FrameBuilder base = grid_building(2, 2, 2, 5, 3, same_capacity(1e12), same_capacity(1e12));
  for (const bool classic : {true, false}) {
    FrameBuilder frame = base;
    const NameIndex names(frame.building);
    frame.load(*names.node("N-1-1-2"), (Vec6() << 0, 0, -1000, 0, 0, 0).finished());
    FailureRules rules = quiet();
    rules.bracing = classic ? BracingRule::classic : BracingRule::none;
    StandingFrame standing(frame.building, CombinationId(0u), rules);
    // At N-1-1-1 two beams brace the joint of the upper post.
    standing.break_joint(*names.joint("BX-1-1-1:1"), BreakCause::tool);
    CHECK(standing.settle(10).size() == 1);
    standing.break_joint(*names.joint("BY-1-1-1:1"), BreakCause::tool);
    const auto breaks = standing.settle(10);
    REQUIRE(breaks.size() == (classic ? 2u : 1u));
    if (classic) {
      CHECK(breaks[1].joint == *names.joint("P-1-1-2:1"));
      CHECK(breaks[1].cause == BreakCause::bracing);
      // The lower post stands alone, the upper one hangs on the beams at its top.
      CHECK(standing.demand(*names.joint("P-1-1-1:1")).norm() == Approx(0).margin(1e-6));
      CHECK(standing.stands(*names.member("P-1-1-2")));
    }
  }
}

TEST_CASE("a structure that can move, or floats, is refused by the names of its nodes") {
  FrameBuilder frame = built_in_beam(5, 1e9);
  const NodeId c = frame.node("C", 0, 5, 3), d = frame.node("D", 5, 5, 3);
  frame.member("CD", MemberKind::beam, c, d);
  CHECK_THROWS_WITH(StandingFrame(frame.building, CombinationId(0u), quiet()),
                    Catch::Contains("node C") && Catch::Contains("CD"));
  FrameBuilder swinging;
  const NodeId a0 = swinging.node("A0", 0, 0, 0), a1 = swinging.node("A1", 0, 0, 3);
  swinging.member("PA", MemberKind::post, a0, a1, same_capacity(1));
  swinging.building.joints[0].stiffness(4) = 0;
  swinging.support(a0);
  swinging.load(a1, (Vec6() << 0, 0, -1, 0, 0, 0).finished());
  CHECK_THROWS_WITH(StandingFrame(swinging.building, CombinationId(0u), quiet()), Catch::Contains("A1"));
}

TEST_CASE("a combination with a settlement is refused by name") {
  FrameBuilder frame = built_in_beam(5, 1e9);
  frame.building.cases[0].settlements.push_back({NodeId(1u), 2, -0.01});
  CHECK_THROWS_WITH(StandingFrame(frame.building, CombinationId(0u), quiet()),
                    Catch::Contains("combinations.dead") && Catch::Contains("node B"));
}
