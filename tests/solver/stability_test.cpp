// What cannot stand is told, with the nodes that move and how.
#include <catch2/catch.hpp>

#include "frames.h"

using namespace topple::test;

namespace {

Mechanism mechanism_of(const FrameModel& model, std::string* message = nullptr) {
  try {
    StaticAnalysis analysis(model);
  } catch (const Instability& e) {
    if (message) *message = e.what();
    return e.mechanism;
  }
  FAIL("a mechanism was accepted");
  return {};
}

FrameModel portal_on_pins(double foot_spring) {
  FrameModel model;
  model.nodes = {Vec3(0, 0, 0), Vec3(0, 0, 3), Vec3(5, 0, 3), Vec3(5, 0, 0)};
  add_beam(model, 0, 1);
  add_beam(model, 1, 2);
  add_beam(model, 3, 2);
  for (std::size_t end : {0U, 1U}) model.beams[1].end_stiffness[end](4) = 0;
  const Vec6 pin = components(rigid, rigid, rigid, rigid, foot_spring, rigid);
  model.supports = {{0, pin}, {3, pin}};
  return model;
}

}  // namespace

TEST_CASE("a portal with four hinges sways, and the answer says which nodes and that they move along x") {
  std::string message;
  const Mechanism m = mechanism_of(portal_on_pins(0), &message);
  REQUIRE(m.nodes.size() >= 2);
  CHECK(message.find("along x") != std::string::npos);
  // Posts turn by 1/3 as their heads move by 1.
  CHECK(std::abs(m.motion[1](0)) == Approx(1).epsilon(1e-6));
  CHECK(m.motion[2](0) == Approx(m.motion[1](0)).epsilon(1e-6));
  CHECK(std::abs(m.motion[0](4)) == Approx(1.0 / 3).epsilon(1e-6));
  CHECK(std::abs(m.motion[1](1)) < 1e-6);
}

TEST_CASE("a weak spring that steadies the portal is inside the warning band, a normal one is not") {
  LoadSet loads;
  loads.nodes = {{1, unit(0, 1)}};
  StaticAnalysis weak(portal_on_pins(3e-3));
  (void)weak.solve(std::span(&loads, 1));
  CHECK(weak.statistics().nearly_unstable);
  CHECK(weak.statistics().digits_left < 7);
  StaticAnalysis firm(portal_on_pins(1e6));
  (void)firm.solve(std::span(&loads, 1));
  CHECK_FALSE(firm.statistics().nearly_unstable);
  CHECK(firm.statistics().digits_left > 8);
}

TEST_CASE("a frame without supports floats") {
  FrameModel model = tower(2, 3);
  model.supports.clear();
  const Mechanism m = mechanism_of(model);
  CHECK(m.nodes.size() == model.nodes.size());
}

TEST_CASE("a large frame on rollers slides though each of its pivots is far above rounding but the last") {
  FrameModel model = tower(5, 12);
  for (Support& support : model.supports) support.stiffness = components(0, rigid, rigid, 0, 0, 0);
  const Mechanism m = mechanism_of(model);
  CHECK(m.nodes.size() == model.nodes.size());
  for (const Vec6& u : m.motion) CHECK(std::abs(u(0)) == Approx(1).epsilon(1e-4));
}

TEST_CASE("only what hangs loose moves in the mechanism of one hinged beam") {
  FrameModel model = tower(2, 2);
  model.nodes.emplace_back(20, 0, 3.5);
  add_beam(model, 5, static_cast<int>(model.nodes.size()) - 1);
  model.beams.back().end_stiffness[0](4) = 0;
  const Mechanism m = mechanism_of(model);
  CHECK(m.nodes == std::vector<int>{static_cast<int>(model.nodes.size()) - 1});
}

TEST_CASE("a node that nothing holds is named") {
  FrameModel model = single_beam(3, fixed(), Vec6::Zero());
  model.nodes.emplace_back(1, 1, 1);
  std::string message;
  const Mechanism m = mechanism_of(model, &message);
  CHECK(m.nodes == std::vector<int>{2});
  CHECK(message.find("node 2") != std::string::npos);
}

TEST_CASE("a truss node may turn, in any direction in space, unless a moment acts on it") {
  // A tripod of bars with hinges at every end.
  FrameModel model;
  model.nodes = {Vec3(0, 0, 4), Vec3(3, 0.3, 0), Vec3(-2, 2, 0.1), Vec3(-1, -3, 0)};
  for (int foot = 1; foot < 4; ++foot) {
    add_beam(model, foot, 0);
    for (Vec6& end : model.beams.back().end_stiffness) end(4) = end(5) = 0;
    model.supports.push_back({foot, components(rigid, rigid, rigid, 0, 0, 0)});
  }
  LoadSet down, moment;
  down.nodes = {{0, unit(2, -1000)}};
  moment.nodes = {{0, unit(4, 10)}};
  for (Beam& b : model.beams) b.end_stiffness[0](3) = 0;
  const StaticSolution s = solve_one(model, down);
  double vertical = 0;
  for (const Vec6& reaction : s.reactions) vertical += reaction(2);
  CHECK(vertical == Approx(1000).epsilon(1e-12));
  CHECK(s.displacements[0].tail<3>().norm() < 1e-12);
  StaticAnalysis analysis(model);
  CHECK_THROWS_AS(analysis.solve(std::span(&moment, 1)), Instability);
}

TEST_CASE("impossible models are refused by name") {
  FrameModel model = single_beam(3, fixed(), Vec6::Zero());
  model.beams[0].Iz = 0;
  CHECK_THROWS_WITH(StaticAnalysis(model), Catch::Contains("beam 0") && Catch::Contains("Iz"));
  model = single_beam(3, fixed(), Vec6::Zero());
  model.beams[0].node[1] = 7;
  CHECK_THROWS_WITH(StaticAnalysis(model), Catch::Contains("node 7"));
  model = single_beam(3, fixed(), Vec6::Zero());
  LoadSet loads;
  loads.beams = {point_load(0, 3.5, unit(2, 1))};
  StaticAnalysis analysis(model);
  CHECK_THROWS_WITH(analysis.solve(std::span(&loads, 1)), Catch::Contains("outside"));
}
