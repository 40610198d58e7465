// Debris that breaks further in a running simulation.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>

#include "support/scratch_folder.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/simulation.h"

using namespace topple::structure;

namespace {

/// A mast with an arm on each side, 8 m up; the left arm is the longer. Its foot is strong: only a tool takes it.
std::string model(double strength) {
  return R"({"topple": 1, "title": "Mast",
 "materials": {"S355": {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7850}},
 "sections": {"tube": {"shape": "box", "depth": 0.2, "width": 0.2, "thickness": 0.01}},
 "joints": {"weak": {"capacity": {"tension": 1e6, "compression": 1e6, "shear_y": 3e5, "shear_z": 3e5, "torsion": 5e4,
                                  "moment_y": 6e4, "moment_z": 6e4}, "strength": )" +
         std::to_string(strength) + R"(}},
 "nodes": {"F": [0, 0, 0], "H": [0, 0, 8], "L": [-4, 0, 8], "R": [3, 0, 8]},
 "members": {"PM": {"kind": "post", "nodes": ["F", "H"], "section": "tube", "material": "S355"},
             "BL": {"nodes": ["H", "L"], "section": "tube", "material": "S355", "joints": ["weak", null]},
             "BR": {"nodes": ["H", "R"], "section": "tube", "material": "S355", "joints": ["weak", null]}},
 "supports": {"F": "fixed"}})";
}

/// The scenario's model is `model.json`.
Simulation simulation_of(const std::string& model, const std::string& scenario) {
  const topple::test::ScratchFolder folder;
  std::ofstream(folder / "model.json") << model;
  auto [building, course] = parse_scenario(scenario, "s.json", folder.path());
  return Simulation(std::move(building), std::move(course));
}

Simulation falling(double strength) {
  return simulation_of(
      model(strength),
      R"({"topple": 1, "model": "model.json", "standing": "static", "duration": 20, "failure": {"bracing": "none"},
          "events": [{"at": 0.1, "remove": {"supports": ["F"]}},
                     {"at": 0.15, "projectile": {"from": [-3, 1.2, 7], "velocity": [0, -30, 0], "mass": 40, "radius": 0.2}}]})");
}

}  // namespace

TEST_CASE("a mast that topples breaks its arms off where it lands, and loses no momentum in the splits") {
  for (const double strength : {1.0, 1e6}) {
    Simulation simulation = falling(strength);
    std::size_t splits = 0, broken = 0;
    double mass = 0;
    while (!simulation.finished()) {
      simulation.step();
      for (const BodyView& body : simulation.bodies()) REQUIRE(body.pose.position.allFinite());
    }
    for (const SimulationEvent& event : simulation.events()) {
      splits += event.kind == SimulationEvent::Kind::split;
      if (event.kind != SimulationEvent::Kind::joint_broke) continue;
      ++broken;
      CHECK(event.joint.cause == BreakCause::impact);
      // It breaks as its capacity is reached, which is found to the last digits of the time.
      CHECK(event.joint.demand == Approx(event.joint.capacity).epsilon(1e-9));
    }
    for (const BodyView& body : simulation.bodies())
      if (body.radius == 0) mass += body.mass;
    const double length = 8 + 4 + 3, area = 0.2 * 0.2 - 0.18 * 0.18;
    CHECK(mass == Approx(7850 * area * length));
    CHECK((splits > 0) == (strength == 1));
    CHECK((broken > 0) == (strength == 1));
    CHECK(simulation.ledger().momentum_error < 1e-10);
    CHECK(std::abs(simulation.ledger().residual()) < 0.01);
  }
}

namespace {

/// Two posts side by side, a little inside each other and joined halfway up. They stand free, and a ball hits one of
/// them.
Simulation standing_pair() {
  return simulation_of(
      R"({"topple": 1, "title": "Pair",
 "materials": {"S355": {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7850}},
 "sections": {"tube": {"shape": "box", "depth": 0.2, "width": 0.2, "thickness": 0.01}},
 "joints": {"weak": {"capacity": {"tension": 1e5, "compression": 1e5, "shear_y": 1e5, "shear_z": 1e5, "torsion": 1e4,
                                  "moment_y": 1e4, "moment_z": 1e4}}},
 "nodes": {"F": [0, 0, 0], "M": [0, 0, 2], "T": [0, 0, 4], "G": [0.19, 0, 0], "N": [0.19, 0, 2], "U": [0.19, 0, 4]},
 "members": {"P1": {"kind": "post", "nodes": ["F", "M"], "section": "tube", "material": "S355"},
             "P2": {"kind": "post", "nodes": ["M", "T"], "section": "tube", "material": "S355"},
             "Q1": {"kind": "post", "nodes": ["G", "N"], "section": "tube", "material": "S355"},
             "Q2": {"kind": "post", "nodes": ["N", "U"], "section": "tube", "material": "S355"},
             "R": {"nodes": ["M", "N"], "section": "tube", "material": "S355", "joints": ["weak", null]}},
 "supports": {"F": "fixed", "G": "fixed"}})",
      R"({"topple": 1, "model": "model.json", "duration": 0.5, "failure": {"bracing": "none"},
          "events": [{"at": 0.1, "remove": {"supports": ["F", "G"]}},
                     {"at": 0.15, "projectile": {"from": [-3, 0, 1.9], "velocity": [40, 0, 0], "mass": 200, "radius": 0.2}}]})");
}

}  // namespace

TEST_CASE("pieces that a body breaks into do not go through each other") {
  Simulation simulation = standing_pair();
  bool apart = false;
  double least = 1;
  while (!simulation.finished()) {
    simulation.step();
    const BodyView *struck = nullptr, *other = nullptr;
    for (const BodyView& body : simulation.bodies())
      for (const MemberId member : body.members) {
        if (simulation.building()[member].name == "P1") struck = &body;
        if (simulation.building()[member].name == "Q1") other = &body;
      }
    if (!struck || struck == other) continue;
    apart = true;
    for (const double z : {0.5, 1.5, 2.5, 3.5})
      least = std::min(least, (other->pose * Vec3(Vec3(0.19, 0, z) - other->rest_centre)).x() -
                                  (struck->pose * Vec3(Vec3(0, 0, z) - struck->rest_centre)).x());
  }
  CHECK(apart);
  CHECK(least > 0.2 - 0.02);
}
