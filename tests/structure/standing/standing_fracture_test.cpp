// Panels that break where they stand: what is broken out, what the frame bears afterwards, and that nothing is lost.
#include <catch2/catch.hpp>
#include <cmath>

#include "loads/tributary_loads.h"
#include "simulation/fracture/broken_panel.h"
#include "support/scratch_folder.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/frame.h"
#include "topple/structure/simulation.h"

using namespace topple::structure;
using topple::fracture::Method;

namespace {

/// One storey of four posts and beams with a slab of 6 m x 6 m, and a wall on one side.
const char* const model_text = R"({"topple": 1, "title": "One bay",
 "materials": {"S355": {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7850},
               "C30": {"youngs_modulus": 30e9, "poisson_ratio": 0.2, "density": 2400, "compressive_strength": 30e6,
                       "tensile_strength": 2.9e6}},
 "sections": {"tube": {"shape": "box", "depth": 0.3, "width": 0.3, "thickness": 0.015}},
 "building": {"posts": [2, 2], "storeys": 1, "bay": [6, 6], "storey_height": 4, "base": "fixed",
              "post": {"section": "tube", "material": "S355"}, "beam": {"section": "tube", "material": "S355"},
              "slab": {"thickness": 0.2, "material": "C30"},
              "wall": {"thickness": 0.15, "material": "C30", "sides": ["x-"]}}})";

Building building() { return parse_model(model_text, "bay.json", Purpose::demolish); }

Scenario scenario(const std::string& events, const std::string& method) {
  const topple::test::ScratchFolder folder;
  std::FILE* file = std::fopen((folder / "bay.json").string().c_str(), "w");
  REQUIRE(file != nullptr);
  std::fputs(model_text, file);
  std::fclose(file);
  return parse_scenario(
             "{\"topple\": 1, \"model\": \"bay.json\", \"duration\": 6, \"debris\": {\"smallest_volume\": 1e-9}, "
             "\"fracture\": {\"method\": \"" +
                 method + "\"}, \"events\": [" + events + "]}",
             "s.json", folder.path())
      .second;
}

/// Onto the slab, straight down, from 1 m above its upper face.
const char* const shoot_slab =
    R"({"at": 0.1, "projectile": {"from": [3, 3, 5.4], "velocity": [0, 0, -40], "mass": 300, "radius": 0.3}})";
const char* const shoot_wall =
    R"({"at": 0.1, "projectile": {"from": [-3, 3, 2], "velocity": [40, 0, 0], "mass": 300, "radius": 0.3}})";

PanelId panel_of(const Building& b, PanelKind kind) {
  for (std::size_t i = 0; i < b.panels.size(); ++i)
    if (b.panels[i].kind == kind) return PanelId(i);
  FAIL("no such panel");
  return {};
}

const SimulationEvent* find(const Simulation& simulation, SimulationEvent::Kind kind) {
  for (const SimulationEvent& event : simulation.events())
    if (event.kind == kind) return &event;
  return nullptr;
}

/// Steps until the panel has broken; the event of the impact that did it.
const SimulationEvent& run_to_fracture(Simulation& simulation) {
  while (!simulation.finished() && !find(simulation, SimulationEvent::Kind::panel_fractured)) simulation.step();
  REQUIRE(find(simulation, SimulationEvent::Kind::panel_fractured) != nullptr);
  const SimulationEvent* impact = find(simulation, SimulationEvent::Kind::impact);
  REQUIRE(impact != nullptr);
  return *impact;
}

/// Force and moments about the panel's first node of what is handed to beams and nodes.
Vec3 force_and_moments(const Building& b, PanelId panel, const TributaryLoads& handed) {
  const Mat3& axes = b[panel].axes;
  Vec3 sum = Vec3::Zero();
  const auto add = [&](double up, const Vec3& place) {
    const Vec3 local = axes * (place - b[b[panel].nodes[0]].position);
    sum += up * Vec3(1, local.x(), local.y());
  };
  for (const topple::solver::BeamLoad& load : handed.beams) {
    const Member& member = b.members[static_cast<std::size_t>(load.beam)];
    const Vec3 start = b[member.nodes[0]].position;
    const double first = (member.axes.transpose() * load.first.head<3>()).z();
    const double last = (member.axes.transpose() * load.last.head<3>()).z();
    const double length = load.to - load.from;
    const double total = (first + last) / 2 * length;
    if (total == 0) continue;
    const double centre = load.from + length * (first + 2 * last) / (3 * (first + last));
    add(total, start + centre * member.axes.row(0).transpose());
  }
  for (const topple::solver::NodeLoad& load : handed.nodes)
    add(load.load(2), b.nodes[static_cast<std::size_t>(load.node)].position);
  return sum;
}

}  // namespace

TEST_CASE("a two-way slab with holes hands on what remains, with its moments, and nothing when nothing remains") {
  const Building b = building();
  const PanelId slab = panel_of(b, PanelKind::slab);
  const EdgeMembers edges(b);
  PanelAction action;
  action.pressure = 1000;
  const std::array<bool, 4> all{true, true, true, true};
  const auto handed = [&](const std::vector<std::vector<Vec2>>& holes) {
    return force_and_moments(b, slab, tributary_loads_of_broken(b, edges, slab, action, all, {}, holes));
  };
  const std::vector<Vec2> triangle{{1, 1}, {3, 1}, {1, 4}}, corner{{5, 5}, {6, 5}, {6, 6}, {5, 6}};
  // Area 36 - 3 - 1; first moments 108 less area times centroid of each hole.
  const Vec3 expected(36 - 3 - 1, 108 - 3 * (5.0 / 3) - 5.5, 108 - 3 * 2 - 5.5);
  CHECK((handed({triangle, corner}) + 1000 * expected).norm() < 1e-9 * 1000 * expected.norm());
  // A pinhole changes little: no load jumps from one pair of edges to the other.
  const std::vector<Vec2> pinhole{{3, 3}, {3.001, 3}, {3, 3.001}};
  const TributaryLoads whole = tributary_loads(b, edges, slab, action, all),
                       pricked = tributary_loads_of_broken(b, edges, slab, action, all, {}, {pinhole});
  for (std::size_t edge = 0; edge < 4; ++edge)
    CHECK((whole.edge_force[edge] - pricked.edge_force[edge]).norm() < 1e-6 * whole.edge_force[edge].norm());
  CHECK(handed({{{0, 0}, {6, 0}, {6, 6}}, {{0, 0}, {6, 6}, {0, 6}}}).norm() < 1e-8 * 36000);
}

TEST_CASE("chunks and what remains of a panel have together its mass, centre and inertia, hit after hit") {
  const Building b = building();
  for (const PanelKind kind : {PanelKind::slab, PanelKind::wall})
    for (const Method method : {Method::voronoi, Method::quadrilateral, Method::local}) {
      const PanelId id = panel_of(b, kind);
      const MassProperties whole = panel_mass(b, b[id], 4321);
      topple::fracture::PanelSettings settings;
      settings.method = method;
      BrokenPanel panel(b, id, 4321, {}, settings);
      MassProperties out;
      for (const double place : {0.3, 0.5, 0.8}) {
        const Vec3 at = b[b[id].nodes[0]].position + place * (b[b[id].nodes[2]].position - b[b[id].nodes[0]].position);
        for (const PanelChunk& chunk : panel.hit(at, 0.6)) out.add(chunk.rest);
        CHECK_FALSE(panel.holds(at));
        MassProperties sum = panel.rest();
        sum.add(out);
        CHECK(sum.mass == Approx(4321).epsilon(1e-12));
        CHECK((sum.centre - whole.centre).norm() < 1e-12);
        CHECK((sum.inertia - whole.inertia).norm() < 1e-11 * whole.inertia.norm());
        CHECK(topple::fracture::audit(*panel.mesh()).sound());
        CHECK(panel.remains().share == Approx(1 - out.mass / 4321).epsilon(1e-12));
      }
      // Only the third edge holds: what the holes cut off from it leaves, and nothing else.
      const double before = panel.volume();
      double left = 0;
      for (const PanelChunk& chunk : panel.hold({false, false, true, false})) left += chunk.volume;
      CHECK(panel.volume() + left == Approx(before).epsilon(1e-12));
      CHECK(panel.volume() > 0);
      for (const PanelChunk& chunk : panel.hold({false, false, false, false})) left += chunk.volume;
      CHECK(panel.volume() == 0);
      CHECK(left == Approx(before).epsilon(1e-12));
    }
}

TEST_CASE("a slab that is shot stands on with a hole in it, and the ball goes on with what momentum is left") {
  for (const std::string method : {"voronoi", "quadrilateral", "local"}) {
    CAPTURE(method);
    Simulation simulation(building(), scenario(shoot_slab, method));
    const Building& b = simulation.building();
    const PanelId slab = panel_of(b, PanelKind::slab);
    const double whole = simulation.frame().mass(slab);
    const SimulationEvent impact = run_to_fracture(simulation);
    CHECK(simulation.frame().stands(slab));
    CHECK(simulation.body_of(slab).value == -1);

    // The point of fracture is the swept contact's: straight below, on the upper face.
    const SimulationEvent& fractured = *find(simulation, SimulationEvent::Kind::panel_fractured);
    CHECK((fractured.position - Vec3(3, 3, 4.1)).norm() < 1e-2);
    double chunks = 0, plug = 0, ball_mass = 0;
    for (const BodyView& body : simulation.bodies()) {
      if (body.radius > 0) ball_mass = body.mass;
      if (!body.chunk) continue;
      chunks += body.mass;
      CHECK(topple::fracture::audit(*body.chunk).sound());
    }
    plug = chunks;  // nothing hung loose after one hit in the middle
    CHECK(chunks > 0);
    CHECK(chunks + simulation.frame().mass(slab) == Approx(whole).epsilon(1e-12));
    // Ball and plug leave together: their momentum is at most what the ball had, and the ball is still fast.
    CHECK(impact.speed_out * (ball_mass + plug) < ball_mass * impact.speed_in);
    const double punch = 2.9e6 * M_PI * 0.2 * 0.8, work = punch * 0.2 / 2;
    const double before = std::sqrt(impact.speed_in * impact.speed_in - 2 * work / ball_mass);
    // The plug has what the punch gave the slab: no more than it would get if beams took nothing of it.
    const double alone = before * ball_mass / (ball_mass + plug),
                 given = plug / whole * (impact.speed_in - before) * ball_mass / (ball_mass + plug);
    CHECK(impact.speed_out > alone);
    CHECK(impact.speed_out < alone + given);
    // The punch: tensile strength over the cone at 45 degrees, 2.9 MPa x pi x 0.2 m x (2 x 0.3 + 0.2) m.
    CHECK(impact.peak_force == Approx(punch).epsilon(1e-12));
    CHECK(std::abs(simulation.ledger().residual()) < 1e-3);  // up to here: nothing but the law of impact

    const auto mesh = simulation.broken_panel(slab);
    REQUIRE(mesh);
    const auto audit = topple::fracture::audit(*mesh);
    CHECK(audit.sound());
    CHECK(audit.volume == Approx(simulation.frame().mass(slab) / 2400).epsilon(1e-9));
    // A ray through the hole meets the ground, one beside it the slab.
    const auto through = simulation.ray_cast(Vec3(3, 3, 30), -Vec3::UnitZ());
    CHECK((!through || through->panel != slab));
    const auto beside = simulation.ray_cast(Vec3(0.7, 0.7, 30), -Vec3::UnitZ());
    REQUIRE(beside);
    CHECK(beside->panel == slab);
    CHECK(beside->distance == Approx(30 - 4.1).margin(5e-3));  // collision shapes have a skin

    while (!simulation.finished()) simulation.step();
    CHECK(simulation.frame().stands(slab));
    // Contacts of hulls are accounted by the collision engine's own sums, which close to a few per cent.
    CHECK(std::abs(simulation.ledger().residual()) < 0.04);
    CHECK(simulation.ledger().momentum_error < 1e-12);
  }
}

TEST_CASE("a fast ball is through a wall before joints beside it feel it, and flies on through the hole") {
  // Edge beams of the seed building bear 15 kN across; the wall's punching force is 1 MN.
  auto [model, seed] = parse_scenario(
      std::string(
          R"({"topple": 1, "model": "seed_building", "combination": "collapse", "duration": 0.5, "fracture": {"method": "voronoi", "cell": 0.5}, "events": [)") +
          shoot_wall + "]}",
      "s.json", ".");
  Simulation simulation(std::move(model), std::move(seed));
  const SimulationEvent impact = run_to_fracture(simulation);
  const double out = impact.speed_out;
  CHECK(out > 15);
  while (!simulation.finished()) simulation.step();
  CHECK(find(simulation, SimulationEvent::Kind::joint_broke) == nullptr);
  for (const BodyView& body : simulation.bodies()) {
    if (body.radius == 0) continue;
    // 0.35 s after the impact: not far behind free flight, as chunks that it pushes may touch the rim of the hole.
    CHECK(body.pose.position.x() > 0.6 * out * (0.5 - impact.time));
    CHECK(body.pose.position.x() < out * (0.5 - impact.time));
  }
}

TEST_CASE("beams lose the load of a slab that is broken out, in the same settle") {
  const Building b = building();
  const PanelId slab = panel_of(b, PanelKind::slab);
  Building bare = b;
  StandingFrame frame(b, CombinationId(0u), FailureRules{}), without(b, CombinationId(0u), FailureRules{});
  const double before = frame.energy().elastic;
  PanelRemains gone;
  gone.share = 0;
  gone.holes = {{{0, 0}, {6, 0}, {6, 6}}, {{0, 0}, {6, 6}, {0, 6}}};
  frame.fracture(slab, gone);
  CHECK_FALSE(frame.stands(slab));
  CHECK(frame.pending());
  (void)frame.settle(1000);
  without.remove(slab);
  (void)without.settle(1000);
  for (std::size_t n = 0; n < b.nodes.size(); ++n) {
    const Vec6 difference = frame.displacement(NodeId(n)) - without.displacement(NodeId(n));
    CHECK(difference.norm() < 1e-12);
  }
  // Energies close: what was elastic became work done on what left, or was freed.
  const FrameEnergy e = frame.energy();
  CHECK(e.elastic < before);
  CHECK(e.elastic - e.elastic_at_start ==
        Approx(e.gravity_work + e.other_work + e.contact_work - e.freed).epsilon(1e-9).margin(1e-9 * before));
}

TEST_CASE("a slab with a hole loads its beams by where what remains lies, and its energies close") {
  const Building b = building();
  const PanelId slab = panel_of(b, PanelKind::slab);
  StandingFrame frame(b, CombinationId(0u), FailureRules{});
  const double whole = frame.mass(slab);
  PanelRemains half;
  half.share = 0.5;
  half.holes = {{{0, 0}, {3, 0}, {3, 6}, {0, 6}}};
  half.edge_length = {3, 6, 3, 0};
  frame.fracture(slab, half);
  const std::vector<JointBreak> broken = frame.settle(1000);
  // The fourth edge has nothing left to hold: its joint is gone, and the slab spans between the first and the third.
  REQUIRE(broken.size() == 1);
  CHECK(broken[0].joint == b.joint(slab, 3));
  CHECK(broken[0].cause == BreakCause::impact);
  CHECK(frame.stands(slab));
  CHECK(frame.mass(slab) == Approx(whole / 2).epsilon(1e-12));
  const FrameEnergy e = frame.energy();
  CHECK(e.elastic - e.elastic_at_start ==
        Approx(e.gravity_work + e.other_work + e.contact_work - e.freed).epsilon(1e-9).margin(1e-9 * e.elastic));
}

TEST_CASE("a second ball flies through the hole of the first") {
  const std::string two =
      std::string(shoot_wall) +
      R"(,{"at": 1.5, "projectile": {"from": [-3, 3, 2], "velocity": [40, 0, 0], "mass": 30, "radius": 0.05}})";
  Simulation simulation(building(), scenario(two, "quadrilateral"));
  while (!simulation.finished()) simulation.step();
  int fractured = 0, impacts = 0;
  for (const SimulationEvent& event : simulation.events()) {
    fractured += event.kind == SimulationEvent::Kind::panel_fractured ? 1 : 0;
    impacts +=
        event.kind == SimulationEvent::Kind::impact && event.body_name == "projectile 2" && event.name == "WY-1-1-1"
            ? 1
            : 0;
  }
  CHECK(fractured == 1);
  CHECK(impacts == 0);
}

TEST_CASE("a standing panel breaks in the same way in every run") {
  const auto run = [] {
    Simulation simulation(building(), scenario(std::string(shoot_wall) + "," + shoot_slab, "local"));
    while (!simulation.finished()) simulation.step();
    return simulation.hash();
  };
  CHECK(run() == run());
}
