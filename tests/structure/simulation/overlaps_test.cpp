// Pieces that stay inside each other are told by name.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "frame_builder.h"
#include "simulation_run.h"
#include "topple/structure/collapse_report.h"
#include "topple/structure/simulation.h"

using namespace topple::structure;
using topple::test::FrameBuilder;
using topple::test::run;

namespace {

/// A cantilever 0.6 m above the ground, cut off; later a ball of that mass comes down softly on where it lies.
Simulation ball_on_a_beam(double mass) {
  FrameBuilder f;
  const NodeId a = f.node("A", 0, 0, 0.6), b = f.node("B", 4, 0, 0.6);
  f.member("AB", MemberKind::beam, a, b);
  f.support(a);
  f.load(MemberId(0u), -1000);
  Scenario scenario;
  scenario.standing = StandingRule::statics;
  scenario.combination = CombinationId(0u);
  scenario.duration = 12;
  scenario.ground = 0;
  Projectile ball;
  ball.from = {2, 0, 0.75};
  ball.mass = mass;
  ball.radius = 0.5;
  scenario.events = {{1, CutTool{{JointId(0u)}}}, {5, ball}};
  return Simulation(f.building, scenario);
}

}  // namespace

TEST_CASE("a ball of twelve thousand times a beam's mass that presses it into the ground is told with both names") {
  Simulation simulation = ball_on_a_beam(5e6);
  run(simulation);
  const BodyOverlaps& overlaps = simulation.overlaps();
  CHECK(overlaps.deep >= 1);
  CHECK(overlaps.depth > 0.02 * overlaps.thickness);
  CHECK(overlaps.thickness == Approx(0.2).epsilon(1e-9));  // the beam's, not the ball's
  CHECK((overlaps.body == "AB" || overlaps.with == "AB"));
  CHECK((overlaps.with == "ground" || overlaps.body != overlaps.with));
  CHECK(overlaps.time > 5);
  const auto summary = nlohmann::json::parse(summary_json(simulation, {}, 0))["overlaps"];
  CHECK(summary["deep"] == overlaps.deep);
  CHECK(summary["depth"] == overlaps.depth);
  CHECK(summary["parts"] == nlohmann::json({overlaps.body, overlaps.with}));
  CHECK(collapse_text(simulation, {}).find("warning: ") != std::string::npos);
}

TEST_CASE("a light ball on the same beam stays outside it, and nothing is told") {
  Simulation simulation = ball_on_a_beam(400);
  run(simulation);
  CHECK(simulation.overlaps().deep == 0);
  const auto summary = nlohmann::json::parse(summary_json(simulation, {}, 0))["overlaps"];
  CHECK(summary["deep"] == 0);
  CHECK(collapse_text(simulation, {}).find("warning: ") == std::string::npos);
}
