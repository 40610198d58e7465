// Panels that break in a running simulation: when, into what, and that nothing is lost on the way.
#include <catch2/catch.hpp>
#include <cmath>

#include "simulation/debris/part_shapes.h"
#include "simulation/fracture/broken_panel.h"
#include "simulation/fracture/panel_chunks.h"
#include "support/scratch_folder.h"
#include "topple/fracture/mesh.h"
#include "topple/fracture/polygon.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/simulation.h"

using namespace topple::structure;

namespace {

/// One storey of four posts and beams with a slab and, on one side, a wall that hangs on weak joints.
const char* const model_text = R"({"topple": 1, "title": "One bay",
 "materials": {"S355": {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7850},
               "C30": {"youngs_modulus": 30e9, "poisson_ratio": 0.2, "density": 2400, "compressive_strength": 30e6}},
 "sections": {"tube": {"shape": "box", "depth": 0.3, "width": 0.3, "thickness": 0.015}},
 "joints": {"weak": {"capacity_per_length": {"tension": 2e4, "compression": 2e4, "shear_y": 2e4, "shear_z": 2e4}}},
 "building": {"posts": [2, 2], "storeys": 1, "bay": [6, 6], "storey_height": 4, "base": "fixed",
              "post": {"section": "tube", "material": "S355"}, "beam": {"section": "tube", "material": "S355"},
              "slab": {"thickness": 0.2, "material": "C30"},
              "wall": {"thickness": 0.15, "material": "C30", "joint": "weak", "sides": ["x-"]}}})";

Building building() { return parse_model(model_text, "bay.json", Purpose::demolish); }

Scenario scenario(const std::string& events, const std::string& method) {
  const topple::test::ScratchFolder folder;
  std::FILE* file = std::fopen((folder / "bay.json").string().c_str(), "w");
  REQUIRE(file != nullptr);
  std::fputs(model_text, file);
  std::fclose(file);
  return parse_scenario(
             "{\"topple\": 1, \"model\": \"bay.json\", \"standing\": \"static\", \"duration\": 8, \"debris\": "
             "{\"smallest_volume\": 1e-9}, "
             "\"fracture\": {\"method\": \"" +
                 method + "\"}, \"events\": [" + events + "]}",
             "s.json", folder.path())
      .second;
}

const char* const drop_slab = R"({"at": 0.2, "remove": {"panels": ["WY-1-1-1"], "members": ["B*"]}})";
const char* const shoot_wall =
    R"({"at": 0.1, "projectile": {"from": [-3, 3, 2], "velocity": [40, 0, 0], "mass": 300, "radius": 0.3}})";

std::size_t count(const Simulation& simulation, SimulationEvent::Kind kind) {
  std::size_t n = 0;
  for (const SimulationEvent& event : simulation.events()) n += event.kind == kind ? 1 : 0;
  return n;
}

double chunk_mass(const Simulation& simulation) {
  double sum = 0;
  for (const BodyView& body : simulation.bodies()) sum += body.chunk ? body.mass : 0;
  return sum;
}

}  // namespace

TEST_CASE("chunks of a panel have together its mass, centre and inertia") {
  const Building b = building();
  const PartShapes shapes(b);
  for (const PanelId id : {PanelId(0), PanelId(1)}) {
    const MassProperties whole = panel_mass(b, b[id], 1234);
    for (const auto method : {topple::fracture::Method::voronoi, topple::fracture::Method::quadrilateral,
                              topple::fracture::Method::local}) {
      topple::fracture::PanelSettings settings;
      settings.method = method;
      const auto chunks = break_panel(b, id, 1234, shapes.corners(id), whole.centre, 0.8, settings);
      REQUIRE(chunks.size() > 4);
      MassProperties sum;
      double volume = 0;
      for (const PanelChunk& chunk : chunks) {
        sum.add(chunk.rest);
        volume += chunk.volume;
        CHECK(topple::fracture::audit(*chunk.mesh).sound());
        REQUIRE(chunk.hull.size() >= 6);
        // The collision shape lies within the panel's own: nothing starts inside a beam.
        for (const Vec3& corner : chunk.hull) {
          const Vec3 at = corner + chunk.rest.centre;
          const Bounds& bounds = shapes.bounds(Part(id));
          CHECK((at - bounds.low).minCoeff() > -0.2);
          CHECK((bounds.high - at).minCoeff() > -0.2);
        }
      }
      CHECK(volume == Approx(panel_volume(b, b[id])).epsilon(1e-12));
      CHECK(sum.mass == Approx(1234).epsilon(1e-12));
      CHECK((sum.centre - whole.centre).norm() < 1e-12);
      CHECK((sum.inertia - whole.inertia).norm() < 1e-11 * whole.inertia.norm());
    }
  }
}

TEST_CASE("a chunk's collision shape is about its centre of mass, at the panel's edges too") {
  // Pieces of the edges lose what lies under the beams beside them: a shape to one side of the centre of mass would let
  // them hang by it through the ground.
  const Building b = building();
  const PartShapes shapes(b);
  const PanelId slab(0);
  const Panel& panel = b[slab];
  const MassProperties whole = panel_mass(b, panel, 1234);
  std::size_t pieces = 0;
  for (int trial = 0; trial < 12; ++trial) {
    topple::fracture::PanelSettings settings;
    settings.cell = 0.35;
    settings.seed = static_cast<std::uint64_t>(trial);
    for (const PanelChunk& chunk : break_panel(b, slab, 1234, shapes.corners(slab), whole.centre, 5, settings)) {
      topple::fracture::Polygon outline;
      for (std::size_t i = 0; i < chunk.hull.size(); i += 2) outline.push_back((panel.axes * chunk.hull[i]).head<2>());
      CHECK(topple::fracture::contains(outline, Vec2::Zero()));
      ++pieces;
    }
  }
  CHECK(pieces > 1000);
}

TEST_CASE("a slab that falls a storey breaks where it lands, and nothing is lost") {
  for (const std::string method : {"voronoi", "quadrilateral", "local"}) {
    CAPTURE(method);
    Simulation simulation(building(), scenario(drop_slab, method));
    const PanelId slab = simulation.building().panels[0].kind == PanelKind::slab ? PanelId(0) : PanelId(1);
    while (!simulation.finished()) simulation.step();
    CHECK(count(simulation, SimulationEvent::Kind::panel_fractured) == 1);
    CHECK(simulation.body_of(slab).value == -2);
    // Its whole weight lies there in pieces (6 x 6 x 0.2 m of 2400 kg/m3).
    CHECK(chunk_mass(simulation) == Approx(6 * 6 * 0.2 * 2400).epsilon(1e-12));
    CHECK(simulation.bodies().size() > 3);
    // The ledger closes as well as it does without fracture: contacts are accounted by the collision engine's own sums.
    CHECK(std::abs(simulation.ledger().residual()) < 0.02);
    for (const BodyView& body : simulation.bodies()) {
      CHECK(body.pose.position.z() > -0.05);
      CHECK(body.pose.position.z() < 4);
    }
  }
}

TEST_CASE("a slab that comes down with its beams breaks where they land, and what its edges hold stays with them") {
  // The posts are taken away: slab and beams fall as one body, which a boulder of 20 t meets from below in the middle
  // of the slab.
  const char* const drop_bay =
      R"({"at": 0.1, "remove": {"panels": ["WY-1-1-1"], "members": ["P*"]}},
         {"at": 0.1, "projectile": {"from": [3, 3, 1.2], "velocity": [0, 0, 9], "mass": 20000, "radius": 0.8}})";
  for (const std::string method : {"voronoi", "quadrilateral", "local"}) {
    CAPTURE(method);
    Simulation simulation(building(), scenario(drop_bay, method));
    const PanelId slab = simulation.building().panels[0].kind == PanelKind::slab ? PanelId(0) : PanelId(1);
    const SimulationEvent* broken = nullptr;
    double rest_before = 0;
    while (!simulation.finished() && !broken) {
      rest_before = 0;
      for (const BodyView& body : simulation.bodies())
        if (body.members.size() == 4) rest_before = body.mass;
      simulation.step();
      for (const SimulationEvent& event : simulation.events())
        if (event.kind == SimulationEvent::Kind::panel_fractured) broken = &event;
    }
    REQUIRE(broken != nullptr);
    CHECK(simulation.building()[slab].name == broken->name);
    // What the ball touched is no part of the slab any more; the beams still hold the rest.
    CHECK(std::hypot(broken->position.x() - 3, broken->position.y() - 3) < 0.3);
    const topple::collision::BodyId with_beams = simulation.body_of(MemberId(4));
    REQUIRE(with_beams.value >= 0);
    CHECK(simulation.body_of(slab) == with_beams);
    double rest = 0, chunks = 0;
    for (const BodyView& body : simulation.bodies()) {
      if (body.id == with_beams) rest = body.mass;
      if (body.chunk) chunks += body.mass;
    }
    CHECK(chunks > 0.1 * 0.2 * 2400);
    CHECK(rest + chunks == Approx(rest_before).epsilon(1e-12));
    CHECK(simulation.ledger().momentum_error < 1e-10);
    const std::shared_ptr<const topple::fracture::Mesh> drawn = simulation.broken_panel(slab);
    REQUIRE(drawn);
    const double volume = topple::fracture::audit(*drawn, 1e-9).volume;
    CHECK(volume * 2400 + chunks == Approx(6 * 6 * 0.2 * 2400).epsilon(1e-12));

    // Whatever breaks where the bay comes down on the ball and the ground: nothing of it is lost.
    while (!simulation.finished()) simulation.step();
    double all = 0;
    for (const BodyView& body : simulation.bodies())
      if (body.radius == 0) all += body.mass;
    double built = 6 * 6 * 0.2 * 2400;
    for (const Member& member : simulation.building().members)
      if (member.name[0] == 'B') built += member.length * 7850 * simulation.building()[member.section].area;
    CHECK(all == Approx(built).epsilon(1e-12));
    CHECK(simulation.ledger().momentum_error < 1e-10);
    CHECK(std::abs(simulation.ledger().residual()) < 0.02);
  }
}

TEST_CASE("a bay that comes down softly, or whose slab cannot break, keeps its slab whole") {
  for (const bool soft : {true, false}) {
    Scenario plain = scenario(R"({"at": 0.1, "remove": {"panels": ["WY-1-1-1"], "members": ["P*"]}})", "voronoi");
    if (soft)
      plain.ground = 3.75;  // just below the beams
    else
      plain.fracture.reset();
    Simulation simulation(building(), plain);
    while (!simulation.finished()) simulation.step();
    CHECK(count(simulation, SimulationEvent::Kind::panel_fractured) == 0);
    CHECK(chunk_mass(simulation) == 0);
    CHECK(simulation.bodies().size() == 1);
  }
}

TEST_CASE("a wall that is pushed off its joints breaks at the contact, and what was hit out flies on") {
  // Slower than what crushes concrete, 30 MPa / sqrt(30 GPa x 2400 kg/m3) = 3.5 m/s: the joints give way before the
  // wall.
  const char* const push_wall =
      R"({"at": 0.1, "projectile": {"from": [-0.6, 3, 2], "velocity": [3.3, 0, 0], "mass": 30000, "radius": 0.3}})";
  Simulation simulation(building(), scenario(push_wall, "voronoi"));
  const SimulationEvent* broken = nullptr;
  while (!simulation.finished() && !broken) {
    simulation.step();
    for (const SimulationEvent& event : simulation.events())
      if (event.kind == SimulationEvent::Kind::panel_fractured) broken = &event;
  }
  REQUIRE(broken != nullptr);
  CHECK(broken->name == "WY-1-1-1");
  // The ball flies along y = 3 and falls g t^2/2 in the (0.6 - 0.3 - 0.075) m to the wall's face: the ray, corrected.
  const double time = (0.6 - 0.3 - 0.075) / 3.3;
  CHECK((broken->position - Vec3(-0.075, 3, 2 - 9.80665 * time * time / 2)).norm() < 0.02);
  double fastest = 0, slowest = 100;
  std::vector<Vec3> before;
  for (const BodyView& body : simulation.bodies()) before.push_back(body.pose.position);
  simulation.step();
  std::size_t i = 0;
  for (const BodyView& body : simulation.bodies()) {
    const double speed = (body.pose.position - before[i++]).x() * 60;
    if (!body.chunk) continue;
    fastest = std::max(fastest, speed);
    slowest = std::min(slowest, speed);
  }
  CHECK(fastest > 1);    // what the ball hit out
  CHECK(slowest < 0.5);  // the rest of the wall only begins to fall
}

TEST_CASE("without the key nothing breaks, and a strength that is missing is named") {
  Scenario plain = scenario(drop_slab, "voronoi");
  plain.fracture.reset();
  Simulation simulation(building(), plain);
  while (!simulation.finished()) simulation.step();
  CHECK(count(simulation, SimulationEvent::Kind::panel_fractured) == 0);
  CHECK(chunk_mass(simulation) == 0);

  Building soft = building();
  for (Material& material : soft.materials) material.compressive_strength.reset();
  try {
    Simulation refused(soft, scenario(drop_slab, "voronoi"));
    FAIL("a panel without a strength was taken");
  } catch (const InputError& error) {
    CHECK(std::string(error.what()).find("materials.C30.compressive_strength: missing") != std::string::npos);
  }
}

TEST_CASE("cells too small for a panel are refused by the panel's name, before it is hit") {
  Building vast = building();
  for (Node& node : vast.nodes) node.position *= 100;
  topple::fracture::PanelSettings fine;
  fine.cell = 0.01;  // 60,000 in a row
  try {
    BrokenPanel::expect_fit(vast, vast.panels.front(), fine);
    FAIL("3.6e9 cells were taken");
  } catch (const InputError& error) {
    const std::string said = error.what();
    CHECK(said.find("panels." + vast.panels.front().name + ": fracture: cell is too small") != std::string::npos);
  }
  CHECK_NOTHROW(BrokenPanel::expect_fit(building(), vast.panels.front(), fine));
}

TEST_CASE("a collapse with broken panels is the same in every run") {
  const auto run = [] {
    Simulation simulation(building(), scenario(std::string(shoot_wall) + "," + drop_slab, "local"));
    while (!simulation.finished()) simulation.step();
    return simulation.hash();
  };
  CHECK(run() == run());
}

TEST_CASE("a floor that comes down on its beams tears off them where its edges bear too little") {
  // 17 t of slab, stopped with its beams within a step or two: some hundred kN/m along 24 m of edges.
  for (const double capacity : {5e4, 1e9}) {
    CAPTURE(capacity);
    std::string text = model_text;
    const auto replace = [&](const std::string& what, const std::string& by) {
      REQUIRE(text.find(what) != std::string::npos);
      text.replace(text.find(what), what.size(), by);
    };
    replace(
        R"("joints": {)",
        R"("joints": {"edge": {"capacity_per_length": {"tension": 1e9, "compression": 1e9, "shear_y": 1e9, "shear_z": )" +
            std::to_string(capacity) + "}}, ");
    replace(R"("slab": {"thickness": 0.2, "material": "C30"})",
            R"("slab": {"thickness": 0.2, "material": "C30", "joint": "edge"})");
    Scenario drop = scenario(R"({"at": 0.1, "remove": {"panels": ["WY-1-1-1"], "members": ["P*"]}})", "voronoi");
    Simulation simulation(parse_model(text, "bay.json", Purpose::demolish), drop);
    const PanelId slab = simulation.building().panels[0].kind == PanelKind::slab ? PanelId(0) : PanelId(1);
    while (!simulation.finished()) simulation.step();
    std::size_t torn = 0;
    for (const SimulationEvent& event : simulation.events()) {
      if (event.kind != SimulationEvent::Kind::joint_broke) continue;
      if (simulation.building()[event.joint.joint].panel != slab) continue;
      ++torn;
      CHECK(event.joint.cause == BreakCause::impact);
      CHECK(event.joint.sense == Sense::shear_z);
      // Torn at the instant at which the capacity is reached, which is found to the last digits of the time.
      CHECK(std::abs(event.joint.demand) == Approx(capacity).epsilon(1e-9));
    }
    CHECK((torn > 0) == (capacity < 1e6));
    // Torn off, it is no part of the body that its beams are.
    const bool with_beams =
        simulation.body_of(slab).value >= 0 && simulation.body_of(slab) == simulation.body_of(MemberId(4));
    CHECK(with_beams == (torn == 0));
    double all = 0, built = 6 * 6 * 0.2 * 2400;
    for (const BodyView& body : simulation.bodies()) all += body.mass;
    for (const Member& member : simulation.building().members)
      if (member.name[0] == 'B') built += member.length * 7850 * simulation.building()[member.section].area;
    CHECK(all == Approx(built).epsilon(1e-12));
    CHECK(std::abs(simulation.ledger().residual()) < 0.02);
  }
}
