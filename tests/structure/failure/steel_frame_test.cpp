// The shipped frame with ductile joints: its capacities are those of the tables, and it does what its page says.
#include <catch2/catch.hpp>
#include <cmath>

#include "topple/structure/collapse_report.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/simulation.h"

using namespace topple::structure;

namespace {

// AISC Steel Construction Manual, table 1-1: plastic modulus (in3) and second moment (in4) about the strong axis.
constexpr double inch = 0.0254, yield = 345e6, modulus = 200e9;
struct Shape {
  double plastic, second_moment, length;
  [[nodiscard]] double moment() const { return plastic * std::pow(inch, 3) * yield; }
  /// At yield, of a member bent in double curvature (ASCE 41-13, equation 9-1).
  [[nodiscard]] double turn() const { return moment() * length / (6 * modulus * second_moment * std::pow(inch, 4)); }
};
constexpr Shape column{85.3, 394, 3.6}, beam{29.3, 156, 6};

}  // namespace

TEST_CASE(
    "the steel frame's joints bear the plastic moments of their sections and turn by 9 times the angle at yield") {
  const auto [building, scenario] = read_scenario(find_scenario("steel_frame_hinges"));
  const NameIndex names(building);
  const auto capacity = [&](const char* joint) { return building[*names.joint(joint)].capacity; };
  const auto about_y = static_cast<std::size_t>(Sense::moment_y);
  for (const auto& [joint, shape, axial] :
       {std::tuple("BX-1-1-1:1", beam, 0.0), std::tuple("P-1-1-1:1", column, 0.05)}) {
    INFO(joint);
    const JointCapacity is = capacity(joint);
    CHECK(is.value[about_y] == Approx(shape.moment()).epsilon(2e-3));  // the tables have three figures
    CHECK(is.ductility[about_y] == Approx(9 * shape.turn() * (1 - axial)).epsilon(0.01));
    CHECK(is.interaction == Interaction::max);
  }
}

TEST_CASE("the steel frame hangs by plastic hinges when it has lost a column, and falls when it loses another") {
  auto [building, scenario] = read_scenario(find_scenario("steel_frame_hinges"));
  Simulation simulation(std::move(building), std::move(scenario));
  const NameIndex names(simulation.building());
  const NodeId above = *names.node("N-2-1-1");
  std::size_t yielded = 0, broken = 0;
  double sag = 0;
  while (!simulation.finished() && simulation.time() < 6) {
    simulation.step();
    if (simulation.time() > 3.99 && sag == 0) {
      sag = -simulation.frame().displacement(above).z();
      for (const SimulationEvent& event : simulation.events()) {
        yielded += event.kind == SimulationEvent::Kind::joint_yielded ? 1 : 0;
        broken += event.kind == SimulationEvent::Kind::joint_broke ? 1 : 0;
      }
      CHECK(simulation.bodies().empty());
      // Who reads the summary is told of them, though nothing broke.
      StepTimes times;
      times.add(simulation);
      CHECK_THAT(collapse_text(simulation, times),
                 Catch::Contains("broke:  0 of 68 joints\n  yielded: 12 joints, which"));
    }
  }
  // Of the three beams that meet over the lost column, on both floors, both ends.
  CHECK(yielded == 12);
  CHECK(broken == 0);
  // Chords of beams turn by sag over length: elastic ones by no more than the angle at yield, hinges by the rest,
  // within their limit.
  CHECK(sag / beam.length > 4 * beam.turn());
  CHECK(sag / beam.length < 10 * beam.turn());
  CHECK(sag == Approx(0.47).margin(0.02));
  CHECK(simulation.bodies().size() > 5);
  CHECK_FALSE(simulation.frame().stands(above));
}
