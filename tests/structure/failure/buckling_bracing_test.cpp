// Posts that give way sideways: against Euler, and against the classic rule of bracing.
#include <algorithm>
#include <catch2/catch.hpp>

#include "structure/frame_builder.h"
#include "topple/structure/error.h"
#include "topple/structure/standing_frame.h"

namespace {

using namespace topple::test;

constexpr double EI = 200e9 * 1e-4;  // about the weak axis of FrameBuilder's bar

FailureRules buckling(bool second_order = false) {
  FailureRules rules;
  rules.bracing = BracingRule::buckling;
  rules.sudden = 1;
  rules.second_order = second_order;
  return rules;
}
FailureRules classic() {
  FailureRules rules = buckling();
  rules.bracing = BracingRule::classic;
  return rules;
}

Vec6 down(double force) { return (Vec6() << 0, 0, -force, 0, 0, 0).finished(); }

/// A post with a fixed foot that can break and a free head.
struct Post {
  explicit Post(double height) {
    frame.load_case();
    const NodeId foot = frame.node("F", 0, 0, 0);
    head = frame.node("H", 0, 0, height);
    post = frame.member("P", MemberKind::post, foot, head, same_capacity(1e12));
    frame.support(foot);
  }
  FrameBuilder frame;
  NodeId head;
  MemberId post;
};

/// Two posts on top of each other, fixed below, held sideways at mid-height and at the top by struts to fixed nodes.
struct BracedPost {
  static constexpr double storey = 5;
  BracedPost() {
    frame.load_case();
    const NodeId foot = frame.node("F", 0, 0, 0);
    const NodeId middle = frame.node("M", 0, 0, storey);
    head = frame.node("H", 0, 0, 2 * storey);
    lower = frame.member("P1", MemberKind::post, foot, middle, same_capacity(1e12));
    upper = frame.member("P2", MemberKind::post, middle, head, same_capacity(1e12));
    frame.support(foot);
    for (const auto& [name, node, z] : {std::tuple("M", middle, storey), std::tuple("H", head, 2 * storey)})
      for (int axis = 0; axis < 2; ++axis) {
        const NodeId wall =
            frame.node(std::string("W") + name + std::to_string(axis), axis == 0 ? 4 : 0, axis == 0 ? 0 : 4, z);
        const MemberId strut = frame.member(std::string("S") + name + std::to_string(axis), MemberKind::beam, node,
                                            wall, same_capacity(1e12));
        // Pinned to the post: it holds it sideways and does not bend with it.
        const JointId joint = frame.building.joint(strut, 0);
        frame.building.joints[static_cast<std::size_t>(joint.index)].stiffness.tail<5>().setZero();
        frame.support(wall);
        if (node == middle) struts.push_back(strut);
      }
  }
  FrameBuilder frame;
  NodeId head;
  MemberId lower, upper;
  std::vector<MemberId> struts;
};

}  // namespace

TEST_CASE("a post that stands free buckles at pi2 EI/(2 L)2, and is named") {
  const double height = 8, euler = M_PI * M_PI * EI / (4 * height * height);
  for (const double share : {0.99, 1.01}) {
    const Post post(height);
    StandingFrame standing(post.frame.building, CombinationId(0u), buckling());
    standing.add_load(post.head, down(share * euler));
    const auto breaks = standing.settle(10);
    CHECK(standing.stands(post.post) == (share < 1));
    REQUIRE(breaks.size() == (share < 1 ? 0u : 1u));
    if (share < 1) continue;
    CHECK(breaks[0].cause == BreakCause::buckling);
    CHECK(breaks[0].joint == post.frame.building.joint(post.post, 0));
    CHECK(breaks[0].demand == Approx(share * euler));
    CHECK(breaks[0].capacity == Approx(euler).epsilon(1e-6));
  }
  Post loaded(height);
  loaded.frame.load(loaded.head, down(1.01 * euler));
  CHECK_THROWS_WITH(StandingFrame(loaded.frame.building, CombinationId(0u), buckling()),
                    Catch::Contains("post P buckles"));
}

TEST_CASE("a post that loses its bracing snaps by the classic rule at once, by buckling when it bears too much") {
  // Fixed below, held at the top: 20.19 EI/L2 over both storeys; in one storey it bears more than twice as much.
  const double whole = 20.1907 * EI / std::pow(2 * BracedPost::storey, 2);
  for (const double share : {0.97, 1.03}) {
    for (const bool by_buckling : {true, false}) {
      const BracedPost post;
      StandingFrame standing(post.frame.building, CombinationId(0u), by_buckling ? buckling() : classic());
      standing.add_load(post.head, down(share * whole));
      REQUIRE(standing.settle(10).empty());
      for (MemberId strut : post.struts) standing.remove(strut);
      const auto breaks = standing.settle(10);
      CAPTURE(share, by_buckling);
      const bool falls = !by_buckling || share > 1;
      REQUIRE(breaks.empty() == !falls);
      if (!falls) continue;
      CHECK(breaks[0].cause == (by_buckling ? BreakCause::buckling : BreakCause::bracing));
      // Classic: the joint that the struts braced, at mid-height. The critical shape of a column that is clamped below
      // and pinned above is a sine from the pin down, highest after a quarter of its wave: inside the upper post.
      CHECK(breaks[0].joint == post.frame.building.joint(post.upper, 0));
      CHECK(bool(breaks[0].inside) == by_buckling);
      if (!by_buckling) continue;
      const double place = 2 * BracedPost::storey * (1 - M_PI / 2 / 4.4934094579090642);
      CHECK(*breaks[0].inside == Approx(place / BracedPost::storey - 1).epsilon(1e-4));
      CHECK(breaks[0].position.z() == Approx(place).epsilon(1e-4));
    }
  }
}

TEST_CASE("a post breaks where its critical shape bends most: at a joint that can break, or inside") {
  const double length = 8;
  enum class Ends { pinned, clamped_below, clamped, sways };
  for (const Ends ends : {Ends::pinned, Ends::clamped_below, Ends::clamped, Ends::sways})
    for (const bool breakable : {true, false}) {
      FrameBuilder frame;
      frame.load_case();
      const NodeId foot = frame.node("F", 0, 0, 0), head = frame.node("H", 0, 0, length);
      const JointCapacity capacity = breakable ? same_capacity(1e12) : JointCapacity();
      const MemberId post = frame.member("P", MemberKind::post, foot, head, capacity, capacity);
      const auto pin = [&](int end) {
        frame.building.joints[static_cast<std::size_t>(frame.building.joint(post, end).index)]
            .stiffness.tail<2>()
            .setZero();
      };
      if (ends == Ends::pinned) pin(0);
      if (ends == Ends::pinned || ends == Ends::clamped_below) pin(1);
      frame.support(foot);
      Vec6 guided = Vec6::Constant(unlimited);
      guided(2) = 0;
      if (ends == Ends::sways) guided(0) = guided(1) = 0;
      frame.building.supports.push_back({head, guided});

      StandingFrame standing(frame.building, CombinationId(0u), buckling());
      const double kL = ends == Ends::clamped ? 2 * M_PI : ends == Ends::clamped_below ? 4.4934094579090642 : M_PI;
      const double critical = kL * kL * EI / (length * length);
      standing.add_load(head, down(0.99 * critical));
      CHECK(standing.settle(10).empty());
      standing.add_load(head, down(0.02 * critical));
      const auto breaks = standing.settle(10);
      CAPTURE(static_cast<int>(ends), breakable);
      REQUIRE(!breaks.empty());
      CHECK(breaks[0].cause == BreakCause::buckling);
      CHECK(breaks[0].capacity == Approx(critical).epsilon(1e-6));
      CHECK(breaks[0].demand == Approx(1.01 * critical).epsilon(1e-6));
      const auto detached = standing.extract_detached();
      // Clamped ends bend as much as the middle, and a joint that can break goes first.
      if (ends == Ends::sways || (ends == Ends::clamped && breakable)) {
        CHECK(!breaks[0].inside);
        if (breakable)
          CHECK(breaks[0].joint == frame.building.joint(post, 0));
        else  // both ends bend as much: that of one of them
          CHECK(frame.building[breaks[0].joint].member == post);
        continue;
      }
      CHECK(!standing.stands(post));
      const double place = ends == Ends::clamped_below ? 1 - M_PI / 2 / kL : 0.5;
      REQUIRE(breaks[0].inside);
      CHECK(*breaks[0].inside == Approx(place).epsilon(1e-5));
      CHECK((breaks[0].position - Vec3(0, 0, place * length)).norm() < 1e-4);
      const auto cut =
          std::find_if(detached.begin(), detached.end(), [](const Detached& part) { return bool(part.cut); });
      REQUIRE(cut != detached.end());
      CHECK(cut->members == std::vector<MemberId>{post});
      CHECK(*cut->cut == *breaks[0].inside);
      CHECK(cut->hinges.size() == 2);
      CHECK(breaks[0].energy > 0);
    }
}

TEST_CASE("second order: an axial load makes a sway larger as the differential equation says") {
  const double height = 8, push = 1000, euler = M_PI * M_PI * EI / (4 * height * height);
  for (const double share : {0.1, 0.3, 0.6, 0.9, 0.98}) {
    const Post post(height);
    const double P = share * euler, k = std::sqrt(P / EI), kL = k * height;
    StandingFrame standing(post.frame.building, CombinationId(0u), buckling(true));
    standing.add_load(post.head, down(P) + (Vec6() << 0, push, 0, 0, 0, 0).finished());
    CHECK(standing.settle(10).empty());
    // One cubic member for the post: its critical load is 0.75 % above Euler's.
    const double sway = push * height * height * height / (3 * EI) * 3 * (std::tan(kL) - kL) / (kL * kL * kL);
    const double sway_y = standing.displacement(post.head)(1);
    CHECK(sway_y == Approx(sway).epsilon(0.01 * share / (1 - share)));
    // Balance on the displaced post holds whatever the shape between its ends.
    const Vec6 foot = standing.demand(post.frame.building.joint(post.post, 0));
    CHECK(foot.tail<3>().norm() == Approx(push * height + P * sway_y).epsilon(1e-6));
  }
}
