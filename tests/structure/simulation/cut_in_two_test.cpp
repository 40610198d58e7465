// A slender post beside a stiff bracket: when it buckles it is cut in two inside, its lower piece stands on, the upper
// one hangs on, and both weigh on what holds them.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <string_view>

#include "structure/simulation_run.h"
#include "support/scratch_folder.h"
#include "topple/fracture/solid_cut.h"
#include "topple/structure/collapse_animation.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/visual_mesh.h"

namespace {

using namespace topple::structure;
using namespace topple::test;

constexpr double height = 6, load = 1.2e6, wall = 0.005, width = 0.1;
const double post_area = width * width - std::pow(width - 2 * wall, 2);
const double EI = 210e9 * (std::pow(width, 4) - std::pow(width - 2 * wall, 4)) / 12;
const double post_mass = 7850 * post_area * height;

/// Head H on the post P and at the end of a cantilever B from K; the load comes after half a second.
Simulation bracket(const std::string& more_events = "", const std::string& joints = "null, null") {
  const std::string model = R"({"topple": 1, "title": "Post and bracket",
 "materials": {"S355": {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7850}},
 "sections": {"tube": {"shape": "box", "depth": 0.1, "width": 0.1, "thickness": 0.005},
              "stiff": {"shape": "box", "depth": 0.6, "width": 0.6, "thickness": 0.02}},
 "joints": {"weak": {"stiffness": {"ry": 0, "rz": 0}, "capacity": {"tension": 100}}},
 "nodes": {"F": [0, 0, 0], "H": [0, 0, 6], "K": [4, 0, 6]},
 "members": {"P": {"kind": "post", "nodes": ["F", "H"], "section": "tube", "material": "S355", "joints": [)" +
                            joints + R"(]},
             "B": {"nodes": ["H", "K"], "section": "stiff", "material": "S355"}},
 "supports": {"F": "fixed", "K": "fixed"}})";
  const topple::test::ScratchFolder folder;
  std::ofstream(folder / "bracket.json") << model;
  auto [building, course] = parse_scenario(
      R"({"topple": 1, "model": "bracket.json", "standing": "static", "duration": 20, "failure": {"sudden": 1},
 "events": [{"at": 0.5, "load": {"nodes": {"H": {"z": -1.2e6}}}})" +
          more_events + "]}",
      "s.json", folder.path());
  return Simulation(std::move(building), std::move(course));
}

const BodyView& body_named(const Simulation& simulation, std::string_view name) {
  for (const BodyView& body : simulation.bodies())
    if (body.name == name) return body;
  FAIL("no body " << name);
  throw 0;
}

void run_to(Simulation& simulation, double time) {
  while (simulation.time() < time - 1e-9 && !simulation.finished()) simulation.step();
}

Vec3 moved(const BodyView& body, const Vec3& point) { return body.pose * (point - body.rest_centre); }

}  // namespace

TEST_CASE("a post that buckles inside is cut in two, and its pieces stand and hang where they were") {
  Simulation simulation = bracket();
  run(simulation);
  CHECK(simulation.at_rest());
  const auto breaks = of_kind(simulation, SimulationEvent::Kind::joint_broke);
  REQUIRE(breaks.size() == 1);
  const JointBreak& line = breaks[0].joint;
  CHECK(breaks[0].name == "P");
  CHECK(line.cause == BreakCause::buckling);
  // Clamped below, and above in a bracket that is a thousand times as stiff: cut about the middle.
  REQUIRE(line.inside);
  CHECK(*line.inside == Approx(0.5).margin(0.02));
  CHECK(breaks[0].position.z() == Approx(*line.inside * height));
  const double clamped = 4 * M_PI * M_PI * EI / (height * height);
  CHECK(line.capacity > 0.97 * clamped);
  CHECK(line.capacity < clamped);
  CHECK(!simulation.frame().stands(MemberId(0u)));
  CHECK(simulation.frame().stands(MemberId(1u)));
  CHECK(simulation.body_of(MemberId(0u)).value == -2);

  REQUIRE(simulation.bodies().size() == 2);
  const BodyView &lower = body_named(simulation, "P#1"), &upper = body_named(simulation, "P#2");
  CHECK(lower.chunk_of == PieceKind::post);
  CHECK(lower.mass == Approx(*line.inside * post_mass).epsilon(1e-12));
  CHECK(lower.mass + upper.mass == Approx(post_mass).epsilon(1e-12));
  CHECK(lower.rest_centre.z() == Approx(*line.inside / 2 * height));
  CHECK(topple::fracture::audit(*upper.chunk).sound());
  CHECK(topple::fracture::audit(*upper.chunk).volume ==
        Approx((1 - *line.inside) * height * width * width).epsilon(1e-9));
  // The foot is fixed; the head sinks with the bracket.
  const double sunk = simulation.frame().displacement(NodeId(1u))(2);
  CHECK(sunk < -0.01);
  CHECK((moved(lower, Vec3::Zero())).norm() < 1e-3);
  CHECK((moved(lower, Vec3(0, 0, 3)) - Vec3(0, 0, 3)).norm() < 2e-3);
  CHECK((moved(upper, Vec3(0, 0, 6)) - Vec3(0, 0, 6)).norm() < 0.06);

  // The bracket bears the load, itself and the upper piece, within the band of the pieces' pull.
  const double bracket_mass = 7850 * (0.36 - 0.56 * 0.56) * 4, g = 9.80665;
  const double reaction = simulation.frame().reaction(NodeId(2u))(2);
  CHECK(reaction - load - bracket_mass * g == Approx(upper.mass * g).epsilon(0.06));
  const Ledger& ledger = simulation.ledger();
  CHECK(ledger.momentum_error < 1e-10);
  CHECK(std::abs(ledger.residual()) < 0.01);
}

TEST_CASE("a piece of a cut post comes loose where its joint cannot bear it, and falls with what it hangs on") {
  // Pinned above by a joint that bears 100 N of tension: a third of what hangs on it weighs.
  Simulation loose = bracket("", "null, \"weak\"");
  run(loose);
  const auto breaks = of_kind(loose, SimulationEvent::Kind::joint_broke);
  REQUIRE(breaks.size() == 2);
  CHECK(breaks[0].name == "P");
  CHECK(*breaks[0].joint.inside == Approx(1 - M_PI / 2 / 4.4934094579090642).epsilon(1e-3));
  CHECK(breaks[1].name == "P:2");
  CHECK(breaks[1].joint.sense == Sense::tension);
  CHECK(breaks[1].joint.capacity == 100);
  CHECK(body_named(loose, "P#2").pose.position.z() < 3);
  CHECK((moved(body_named(loose, "P#1"), Vec3::Zero())).norm() < 1e-3);

  Simulation held = bracket(R"(, {"at": 5, "remove": {"supports": ["K"]}})");
  run_to(held, 5.3);
  const auto of_bracket =
      std::find_if(held.bodies().begin(), held.bodies().end(), [](const BodyView& body) { return body.name == "B"; });
  REQUIRE(of_bracket != held.bodies().end());
  const Vec3 head(0, 0, height);
  CHECK(moved(*of_bracket, head).z() < height - 0.2);
  CHECK((moved(*of_bracket, head) - moved(body_named(held, "P#2"), head)).norm() < 0.05);
  CHECK((moved(body_named(held, "P#1"), Vec3::Zero())).norm() < 1e-3);
}

TEST_CASE("a run in which a post is cut in two comes out the same again, and from a snapshot") {
  Simulation first = bracket(), second = bracket(), third = bracket();
  run(first);
  run(second);
  CHECK(first.hash() == second.hash());
  run_to(third, 1.0);
  const Snapshot snapshot = third.save();
  Simulation resumed = bracket();
  resumed.restore(snapshot);
  CHECK(resumed.hash() == third.hash());
  run(resumed);
  CHECK(resumed.hash() == first.hash());
}

TEST_CASE("what is drawn around a post that is cut in two goes with its pieces") {
  Simulation simulation = bracket();
  DrawnMesh cladding;
  cladding.name = "cladding";
  cladding.member = MemberId(0u);
  // A box of 0.4 m around it.
  const std::array<Vec3, 8> corner{Vec3(-0.2, -0.2, 0), Vec3(0.2, -0.2, 0), Vec3(0.2, 0.2, 0), Vec3(-0.2, 0.2, 0),
                                   Vec3(-0.2, -0.2, 6), Vec3(0.2, -0.2, 6), Vec3(0.2, 0.2, 6), Vec3(-0.2, 0.2, 6)};
  const std::array<std::array<std::size_t, 4>, 6> faces{
      {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
  for (const auto& face : faces) {
    const int first = static_cast<int>(cladding.mesh.positions.size());
    const Vec3 normal = (corner[face[1]] - corner[face[0]]).cross(corner[face[2]] - corner[face[0]]).normalized();
    for (const std::size_t k : face) {
      cladding.mesh.positions.push_back(corner[k]);
      cladding.mesh.normals.push_back(normal);
      cladding.mesh.texture.emplace_back(0, 0);
    }
    cladding.mesh.triangles.push_back({first, first + 1, first + 2});
    cladding.mesh.triangles.push_back({first, first + 2, first + 3});
  }
  VisualMesh model(simulation.building(), {cladding});
  while (simulation.time() < 1) {
    simulation.step();
    model.update(simulation);
  }
  REQUIRE(model.pieces().size() == 2);
  double volume = 0;
  for (const VisualMesh::Piece& piece : model.pieces()) {
    CHECK(topple::fracture::audit(*piece.mesh, 1e-9, true).open_edges == 0);
    volume += piece.volume;
    const double middle = topple::fracture::solid_properties(*piece.mesh, 1).centre.z();
    CHECK(piece.body.value == body_named(simulation, middle < 3 ? "P#1" : "P#2").id.value);
  }
  CHECK(volume == Approx(0.4 * 0.4 * 6).epsilon(1e-12));
}

TEST_CASE("the pieces of a cut post are in the animation, the post until it is cut") {
  Simulation simulation = bracket();
  CollapseAnimation animation(simulation, 30);
  while (simulation.time() < 1) {
    simulation.step();
    animation.add_due(simulation);
  }
  const std::string glb = animation.glb();
  for (const char* name : {"\"P\"", "\"P#1\"", "\"P#2\""}) CHECK(glb.find(name) != std::string::npos);
}
