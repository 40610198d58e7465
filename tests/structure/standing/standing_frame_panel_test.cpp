// Panels on a standing frame: what they weigh, what they lie on, when they fall.
#include <catch2/catch.hpp>

#include "structure/frame_builder.h"
#include "topple/structure/standing_frame.h"

namespace {

using namespace topple::test;

constexpr double rounding = 1e-9;  // relative

/// A table: four posts, four beams of 6 m by 4 m, one slab under pressure. Nodes A, B, C, D go round.
struct Table {
  explicit Table(PanelModel model, double beam_capacity = 1e12, double edge_capacity = 1e12) {
    const double x[] = {0, 6, 6, 0}, y[] = {0, 0, 4, 4};
    for (int i = 0; i < 4; ++i) {
      foot[i] = frame.node(std::string(1, char('A' + i)) + "0", x[i], y[i], 0);
      top[i] = frame.node(std::string(1, char('A' + i)) + "1", x[i], y[i], 3);
      frame.support(foot[i]);
    }
    for (int i = 0; i < 4; ++i)
      post[i] = frame.member("P" + std::to_string(i), MemberKind::post, foot[i], top[i], same_capacity(1e12));
    for (int i = 0; i < 4; ++i)
      beam[i] = frame.member("E" + std::to_string(i + 1), MemberKind::beam, top[i], top[(i + 1) % 4],
                             same_capacity(beam_capacity), same_capacity(beam_capacity));
    slab = frame.panel("S", model, {top[0], top[1], top[2], top[3]}, same_capacity(edge_capacity));
    frame.load(slab, pressure);
  }
  [[nodiscard]] double post_force(const StandingFrame& standing) const {
    double sum = 0;
    for (const MemberId one : post) sum += standing.demand(frame.building.joint(one, 0))(0);
    return sum;
  }
  static constexpr double pressure = 2000, weight = 2000 * 24;
  FrameBuilder frame;
  NodeId foot[4], top[4];
  MemberId post[4], beam[4];
  PanelId slab;
};

FailureRules quiet() {
  FailureRules rules;
  rules.bracing = BracingRule::none;
  rules.sudden = 1;
  return rules;
}

}  // namespace

TEST_CASE("masses are the downward loads over gravity") {
  Table table(PanelModel::cladding);
  FrameBuilder& frame = table.frame;
  frame.load(table.beam[0], -500);
  frame.load(table.top[2], (Vec6() << 3e4, 0, -7000, 0, 0, 0).finished());
  frame.self_weight(7850);
  StandingFrame standing(frame.building, CombinationId(0u), quiet());
  const double g = 10;
  CHECK(standing.mass(table.slab) == Approx((2000 + 7850 * 0.2 * g) * 24 / g).epsilon(rounding));
  CHECK(standing.mass(table.beam[0]) == Approx((500 + 7850 * 0.04 * g) * 6 / g).epsilon(rounding));
  CHECK(standing.mass(table.post[1]) == Approx(7850 * 0.04 * 3).epsilon(rounding));
  CHECK(standing.node_mass(table.top[2]) == Approx(700).epsilon(rounding));
  CHECK(standing.node_mass(table.top[1]) == 0);
}

TEST_CASE("a slab that loses a beam spans between the opposite pair that is left, then falls") {
  const Table table(PanelModel::cladding);
  const Building& building = table.frame.building;
  StandingFrame standing(building, CombinationId(0u), quiet());
  CHECK(table.post_force(standing) == Approx(-Table::weight).epsilon(rounding));
  // Two ways, 45 degrees: the 4 m beams carry a triangle, p 4^2/4 = 8000 N each, the 6 m beams 16000 N.
  CHECK(standing.demand(building.joint(table.slab, 1)).head<3>().norm() * 4 == Approx(8000).epsilon(rounding));
  CHECK(standing.demand(building.joint(table.slab, 0)).head<3>().norm() * 6 == Approx(16000).epsilon(rounding));

  standing.remove(table.beam[1]);
  CHECK(standing.settle(10).empty());
  CHECK_FALSE(standing.intact(building.joint(table.slab, 1)));
  CHECK(standing.stands(table.slab));
  CHECK(standing.demand(building.joint(table.slab, 0)).head<3>().norm() * 6 == Approx(24000).epsilon(rounding));
  CHECK(standing.demand(building.joint(table.slab, 3)).norm() == Approx(0).margin(1e-9));
  CHECK(table.post_force(standing) == Approx(-Table::weight).epsilon(rounding));

  standing.remove(table.beam[2]);
  CHECK(standing.settle(10).empty());
  CHECK_FALSE(standing.stands(table.slab));
  const auto detached = standing.extract_detached();
  REQUIRE(detached.size() == 1);
  CHECK(detached[0].panels == std::vector<PanelId>{table.slab});
  CHECK(detached[0].members.empty());
  CHECK(std::abs(table.post_force(standing)) < 1e-6 * Table::weight);
}

TEST_CASE("an overloaded slab edge breaks and the slab goes the other way until it falls") {
  // Edge 2 and 4 bear 8000 N over 4 m: 2000 N/m. Edge 1 and 3 bear 16000/6 = 2667 N/m, and 4000 N/m when alone.
  for (const double capacity : {2700.0, 2600.0}) {
    const Table table(PanelModel::cladding, 1e12, capacity);
    StandingFrame standing(table.frame.building, CombinationId(0u), quiet());
    const auto breaks = standing.settle(10);
    if (capacity > 2667) {
      CHECK(breaks.empty());
      continue;
    }
    // Both long edges go at once; the short pair then bears 48000/2/4 = 6000 N/m and goes too.
    REQUIRE(breaks.size() == 4);
    CHECK(breaks[0].joint == table.frame.building.joint(table.slab, 0));
    CHECK(breaks[1].joint == table.frame.building.joint(table.slab, 2));
    CHECK(breaks[0].sense == Sense::shear_z);
    CHECK(breaks[0].demand == Approx(16000.0 / 6).epsilon(rounding));
    CHECK(breaks[2].demand == Approx(6000).epsilon(rounding));
    CHECK(breaks[2].generation == 1);
    CHECK_FALSE(standing.stands(table.slab));
    CHECK(standing.extract_detached().size() == 1);
  }
}

TEST_CASE("a slab goes with the part that holds a pair of its edges, and stays when a pair stays") {
  const Table table(PanelModel::cladding);
  const Building& building = table.frame.building;
  {
    StandingFrame standing(building, CombinationId(0u), quiet());
    for (int i = 0; i < 4; ++i) standing.break_joint(building.joint(table.post[i], 0), BreakCause::tool);
    standing.settle(10);
    const auto detached = standing.extract_detached();
    REQUIRE(detached.size() == 1);
    CHECK(detached[0].members.size() == 8);
    CHECK(detached[0].panels == std::vector<PanelId>{table.slab});
    CHECK(standing.intact(building.joint(table.slab, 2)));
  }
  {
    StandingFrame standing(building, CombinationId(0u), quiet());
    for (int end = 0; end < 2; ++end) standing.break_joint(building.joint(table.beam[3], end), BreakCause::tool);
    standing.settle(10);
    const auto detached = standing.extract_detached();
    REQUIRE(detached.size() == 1);
    CHECK(detached[0].members == std::vector<MemberId>{table.beam[3]});
    CHECK(detached[0].panels.empty());
    CHECK(standing.stands(table.slab));
    CHECK_FALSE(standing.intact(building.joint(table.slab, 3)));
  }
}

TEST_CASE("a load resting on a slab goes by the lever rule to the edges across the shorter span") {
  const Table table(PanelModel::cladding);
  const Building& building = table.frame.building;
  StandingFrame standing(building, CombinationId(0u), quiet());
  const double before_near = standing.demand(building.joint(table.slab, 0)).norm();
  const double before_far = standing.demand(building.joint(table.slab, 2)).norm();
  standing.set_contact_load({1, {{}, table.slab, Vec3(2, 1, 3.1)}, Vec3(0, 0, -1200)});
  standing.settle(10);
  // 1 m from edge 1 of a 4 m span: three quarters there.
  CHECK(standing.demand(building.joint(table.slab, 0)).norm() - before_near == Approx(900.0 / 6).epsilon(1e-7));
  CHECK(standing.demand(building.joint(table.slab, 2)).norm() - before_far == Approx(300.0 / 6).epsilon(1e-7));
  CHECK(table.post_force(standing) == Approx(-Table::weight - 1200).epsilon(rounding));
  standing.remove(table.slab);
  standing.settle(10);
  CHECK(std::abs(table.post_force(standing)) < 1e-6 * Table::weight);
}
