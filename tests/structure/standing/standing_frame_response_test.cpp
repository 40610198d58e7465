// Answers of a standing frame to a unit force, and what it does when nothing changes.
#include <catch2/catch.hpp>

#include "structure/frame_builder.h"
#include "topple/structure/standing_frame.h"

namespace {

using namespace topple::test;

constexpr double E = 200e9, Iy = 2e-4, Iz = 1e-4;
constexpr double rounding = 1e-9;  // relative

FailureRules quiet() {
  FailureRules rules;
  rules.bracing = BracingRule::none;
  rules.sudden = 1;
  return rules;
}

FrameBuilder beam_with_mass(double length, bool both_ends) {
  FrameBuilder frame;
  const NodeId a = frame.node("A", 0, 0, 3), b = frame.node("B", length, 0, 3);
  frame.member("AB", MemberKind::beam, a, b, same_capacity(1e12), same_capacity(1e12));
  frame.support(a);
  if (both_ends) frame.support(b);
  frame.load(MemberId(0u), -1000);
  return frame;
}

}  // namespace

TEST_CASE("a cantilever's tip gives way by L^3/3EI and takes 33/140 of its mass along") {
  const double length = 5;
  const FrameBuilder frame = beam_with_mass(length, false);
  const StandingFrame standing(frame.building, CombinationId(0u), quiet());
  const auto response = standing.respond({MemberId(0u), {}, Vec3(length, 0, 3.1)}, Vec3(0, 0, -1));
  CHECK(response.compliance == Approx(length * length * length / (3 * E * Iy)).epsilon(rounding));
  CHECK(response.rayleigh_mass == Approx(33.0 / 140 * 1000 * length / 10).epsilon(rounding));
  REQUIRE(response.demands.size() == 1);
  CHECK(response.demands[0].first == JointId(0u));
  CHECK(std::abs(response.demands[0].second(4)) == Approx(length).epsilon(rounding));
  CHECK(std::abs(response.demands[0].second(2)) == Approx(1).epsilon(rounding));
  const auto sideways = standing.respond({MemberId(0u), {}, Vec3(length, 0, 3)}, Vec3(0, 1, 0));
  CHECK(sideways.compliance == Approx(length * length * length / (3 * E * Iz)).epsilon(rounding));
}

TEST_CASE("the middle of a built-in beam gives way by L^3/192EI and takes 13/35 of its mass along") {
  const double length = 6;
  const FrameBuilder frame = beam_with_mass(length, true);
  const StandingFrame standing(frame.building, CombinationId(0u), quiet());
  const auto response = standing.respond({MemberId(0u), {}, Vec3(length / 2, 0, 3)}, Vec3(0, 0, -1));
  CHECK(response.compliance == Approx(length * length * length / (192 * E * Iy)).epsilon(rounding));
  CHECK(response.rayleigh_mass == Approx(13.0 / 35 * 1000 * length / 10).epsilon(rounding));
}

TEST_CASE("a break in an impact tells how far the unloaded place moved") {
  // Under q the middle of a built-in beam hangs q L^4/384EI, that of the cantilever left over 17 q L^4/384EI.
  const double length = 6, unit = 1000 * length * length * length * length / (384 * E * Iy);
  const FrameBuilder frame = beam_with_mass(length, true);
  StandingFrame standing(frame.building, CombinationId(0u), quiet());
  const ContactPlace middle{MemberId(0u), {}, Vec3(length / 2, 0, 3)};
  JointBreak broken;
  broken.joint = JointId(1u);
  const double shift = standing.break_in_impact(std::vector{broken}, middle, Vec3(0, 0, -1));
  CHECK(shift == Approx(16 * unit).epsilon(rounding));
  CHECK(standing.pending());
  CHECK(standing.settle(10).empty());
  CHECK(standing.respond(middle, Vec3(0, 0, -1)).compliance ==
        Approx(length * length * length / (24 * E * Iy)).epsilon(rounding));
  broken.joint = JointId(0u);
  CHECK(standing.break_in_impact(std::vector{broken}, middle, Vec3(0, 0, -1)) == 0);
  CHECK_FALSE(standing.stands(MemberId(0u)));
}

TEST_CASE("displacements do not depend on strength, to the bit") {
  const auto sag = [](double strength) {
    FrameBuilder frame = grid_building(3, 3, 3, 6, 3.5, same_capacity(1e9 * strength), same_capacity(1e9 * strength));
    frame.self_weight(7850);
    StandingFrame standing(frame.building, CombinationId(0u), {});
    standing.settle(4);
    return standing.roof_sag();
  };
  const double usual = sag(1);
  CHECK(usual > 0);
  CHECK(usual == sag(1e6));
}

TEST_CASE("what does not change is not computed") {
  FrameBuilder frame = grid_building(3, 3, 3, 6, 3.5, same_capacity(1e9), same_capacity(1e9));
  frame.self_weight(7850);
  StandingFrame standing(frame.building, CombinationId(0u), {});
  const FrameCounters start = standing.counters();
  CHECK(start.segmentations == 0);
  for (int i = 0; i < 100; ++i) CHECK(standing.settle(4).empty());
  const FrameCounters idle = standing.counters();
  CHECK(idle.solves == start.solves);
  CHECK(idle.segmentations == 0);
  CHECK(idle.unchanged == start.unchanged + 100);
  // A load laid on again with the same value is no change; strength alone needs a check but no solve.
  const ContactLoad resting{3, {MemberId(1u), {}, frame.building.nodes[12].position}, Vec3(0, 0, -100)};
  standing.set_contact_load(resting);
  CHECK(standing.pending());
  standing.settle(4);
  CHECK(standing.counters().solves == start.solves + 1);
  standing.set_contact_load(resting);
  CHECK_FALSE(standing.pending());
  standing.set_strength_factor(JointId(0u), 0.5);
  standing.settle(4);
  CHECK(standing.counters().solves == start.solves + 1);
}

TEST_CASE("only the building that is touched is solved") {
  FrameBuilder frame;
  std::vector<MemberId> posts;
  for (int i = 0; i < 5; ++i) {
    const NodeId a0 = frame.node("A" + std::to_string(i), 20 * i, 0, 0),
                 a1 = frame.node("B" + std::to_string(i), 20 * i, 0, 4);
    posts.push_back(frame.member("P" + std::to_string(i), MemberKind::post, a0, a1, same_capacity(1e9)));
    frame.support(a0);
    frame.load(a1, (Vec6() << 0, 0, -1000, 0, 0, 0).finished());
  }
  StandingFrame standing(frame.building, CombinationId(0u), quiet());
  CHECK(standing.standing_segments() == 5);
  const auto before = standing.counters().solves;
  standing.set_contact_load({1, {posts[2], {}, Vec3(40, 0, 4)}, Vec3(100, 0, 0)});
  standing.settle(4);
  CHECK(standing.counters().solves == before + 1);
  CHECK(standing.segment(posts[3]) == 3);
  standing.break_joint(frame.building.joint(posts[3], 0), BreakCause::tool);
  standing.settle(4);
  CHECK(standing.segment(posts[3]) == -1);
  CHECK(standing.segment(posts[4]) == 3);
  CHECK(standing.standing_segments() == 4);
}

TEST_CASE("two places of a cantilever give way together, and move its mass together") {
  const double length = 6, half = 3, a = 2, mass = 100;  // kg/m
  FrameBuilder frame;
  const NodeId foot = frame.node("A", 0, 0, 3), middle = frame.node("B", half, 0, 3),
               tip = frame.node("C", length, 0, 3);
  const MemberId first = frame.member("AB", MemberKind::beam, foot, middle, same_capacity(1e12));
  const MemberId second = frame.member("BC", MemberKind::beam, middle, tip);
  frame.support(foot);
  frame.load(first, -10 * mass);
  frame.load(second, -10 * mass);
  const StandingFrame standing(frame.building, CombinationId(0u), quiet());
  const std::array<ContactPlace, 2> places{{{first, {}, Vec3(a, 0, 3.1)}, {second, {}, Vec3(length, 0, 3.1)}}};
  const std::array<Vec3, 2> down{-Vec3::UnitZ(), -Vec3::UnitZ()};
  const auto both = standing.respond(places, down);
  CHECK(both.compliance(0, 0) == Approx(a * a * a / (3 * E * Iy)).epsilon(rounding));
  CHECK(both.compliance(1, 1) == Approx(length * length * length / (3 * E * Iy)).epsilon(rounding));
  CHECK(both.compliance(0, 1) == Approx(a * a * (3 * length - a) / (6 * E * Iy)).epsilon(rounding));
  CHECK(both.compliance(1, 0) == both.compliance(0, 1));
  // The shapes by the textbook, multiplied and summed in small steps (Simpson: exact to 1e-12 with a knot at a).
  const auto under = [](double force_at, double x) {
    return x < force_at ? x * x * (3 * force_at - x) / (6 * E * Iy)
                        : force_at * force_at * (3 * x - force_at) / (6 * E * Iy);
  };
  const int steps = 6000;
  const double h = length / steps;
  double product = 0;
  for (int i = 0; i < steps; ++i)
    for (const auto& [at, weight] : {std::pair(0.0, 1.0), std::pair(0.5, 4.0), std::pair(1.0, 1.0)})
      product += mass * h * weight / 6 * under(a, (i + at) * h) * under(length, (i + at) * h);
  CHECK(both.inertia(0, 1) == Approx(product).epsilon(rounding));
  for (std::size_t i = 0; i < 2; ++i) {
    const auto alone = standing.respond(places[i], down[i]);
    CHECK(both.places[i].compliance == Approx(alone.compliance).epsilon(1e-14));
    CHECK(both.places[i].rayleigh_mass == Approx(alone.rayleigh_mass).epsilon(1e-14));
    REQUIRE(both.places[i].demands.size() == alone.demands.size());
    CHECK(both.places[i].demands[0].second.isApprox(alone.demands[0].second, 1e-14));
  }
}
