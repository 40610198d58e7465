// A shell panel that stands: its superelement against a global mesh with the same hole, balls through it, cracks.
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <optional>

#include "standing/panel_superelement.h"
#include "topple/solver/static_analysis.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/simulation.h"

using namespace topple::structure;

namespace {

const std::string wall_text = R"({"topple": 1, "title": "Wall",
 "materials": {"c": {"youngs_modulus": 30e9, "poisson_ratio": 0.2, "density": 2400, "compressive_strength": 30e6,
                     "tensile_strength": 2.9e6}},
 "joints": {"foot": {"capacity_per_length": {"tension": 6e5, "compression": 5e6, "shear_y": 6e5, "shear_z": 3e5}}},
 "nodes": {"A0": [0, 0, 0], "B0": [6, 0, 0], "B1": [6, 0, 3], "A1": [0, 0, 3]},
 "panels": {"W": {"kind": "wall", "nodes": ["A0", "B0", "B1", "A1"], "thickness": 0.2, "material": "c",
                  "model": "shell", "mesh": [12, 6], "joint": "foot"}},
 "supports": {"W:1": "fixed"},
 "loads": {"dead": {"self_weight": 1.0, "panels": {"W": {"pressure": 2000}},
                    "nodes": {"A1": {"y": 3000, "z": -20000}}}}})";

Building wall(const std::string& text = wall_text) { return parse_model(text, "wall.json", Purpose::demolish); }

/// Elements of the 12 x 6 mesh whose centre lies in the hole: 1.5 m < x < 3 m, 1 m < z < 2 m, three by two of them.
bool in_hole(const Vec3& centre) { return centre.x() > 1.5 && centre.x() < 3 && centre.z() > 1 && centre.z() < 2; }
const std::vector<Vec2> hole{{1.5, 1}, {3, 1}, {3, 2}, {1.5, 2}};

topple::solver::StaticSolution global_answer(const Building& b, bool with_hole, Frame& frame) {
  frame = make_frame(b);
  const PartLoads loads = part_loads(b, CombinationId(0u));
  topple::solver::LoadSet set = on_frame(b, frame, loads, load_set(b, loads));
  if (with_hole) {
    topple::solver::FrameModel left = frame.model;
    left.shells.clear();
    std::vector<topple::solver::ShellLoad> on_shells;
    std::vector<char> has(left.nodes.size(), 0);
    for (std::size_t k = 0; k < frame.model.shells.size(); ++k) {
      const auto& nodes = frame.model.shells[k].node;
      Vec3 centre = Vec3::Zero();
      for (const int node : nodes) centre += frame.model.nodes[static_cast<std::size_t>(node)] / 4;
      if (in_hole(centre)) continue;
      for (const topple::solver::ShellLoad& load : set.shells)
        if (load.shell == static_cast<int>(k)) {
          on_shells.push_back(load);
          on_shells.back().shell = static_cast<int>(left.shells.size());
        }
      for (const int node : nodes) has[static_cast<std::size_t>(node)] = 1;
      left.shells.push_back(frame.model.shells[k]);
    }
    for (std::size_t n = 0; n < has.size(); ++n)
      if (!has[n]) left.supports.push_back({static_cast<int>(n), Vec6::Constant(unlimited)});
    set.shells = on_shells;
    topple::solver::StaticAnalysis analysis(left);
    return analysis.solve(std::span(&set, 1)).front();
  }
  topple::solver::StaticAnalysis analysis(frame.model);
  return analysis.solve(std::span(&set, 1)).front();
}

PanelRemains with_hole() {
  PanelRemains remains;
  remains.share = 1 - 1.5 / 18;
  remains.holes = {hole};
  remains.edge_length = {6, 3, 6, 3};
  return remains;
}

Scenario shipped(const std::string& name) { return read_scenario(find_scenario(name)).second; }

const SimulationEvent* find(const Simulation& simulation, SimulationEvent::Kind kind) {
  for (const SimulationEvent& event : simulation.events())
    if (event.kind == kind) return &event;
  return nullptr;
}

}  // namespace

TEST_CASE("a shell panel that stands is its global mesh, whole and with a hole") {
  const Building b = wall();
  StandingFrame frame(b, CombinationId(0u), FailureRules{});
  const double mass = frame.mass(PanelId(0u));
  CHECK(mass == Approx(6 * 3 * 0.2 * 2400).epsilon(1e-12));
  for (const bool broken : {false, true}) {
    if (broken) {
      frame.fracture(PanelId(0u), with_hole());
      (void)frame.settle(1000);
      CHECK(frame.mass(PanelId(0u)) == Approx(mass * 16.5 / 18).epsilon(1e-12));
    }
    Frame mesh;
    const topple::solver::StaticSolution expected = global_answer(b, broken, mesh);
    double largest = 0, difference = 0;
    for (std::size_t n = 0; n < 4; ++n) {
      largest = std::max(largest, expected.displacements[n].norm());
      difference = std::max(difference, (frame.displacement(NodeId(n)) - expected.displacements[n]).norm());
    }
    CHECK(largest > 1e-5);
    CHECK(difference < 1e-9 * largest);
    // The joint of the lower edge bears what the supports of the global mesh do, per metre.
    Vec6 sum = Vec6::Zero();
    for (const int support : mesh.edge_supports.front()) sum += expected.reactions[static_cast<std::size_t>(support)];
    const Vec6 demand = frame.demand(b.joint(PanelId(0u), 0));
    CHECK(demand(0) == Approx(-sum(2) / 6).epsilon(1e-9));  // outwards is down
    CHECK(std::abs(demand(2)) == Approx(std::abs(sum(1)) / 6).epsilon(1e-9));
    // Energies close on the way.
    const FrameEnergy e = frame.energy();
    CHECK(e.elastic - e.elastic_at_start ==
          Approx(e.gravity_work + e.other_work + e.contact_work - e.freed).epsilon(1e-9).margin(1e-9 * e.elastic));
    CHECK((broken ? e.freed > 0 : e.freed == 0));
  }
  CHECK(frame.counters().refactorisations + frame.counters().low_rank >= 1);
}

TEST_CASE("a hole that fits no element is known to the mesh's fineness") {
  // The same hole as an opening from the start, through whose vertices a global mesh has lines.
  const std::vector<Vec2> odd{{1.63, 0.93}, {3.21, 0.93}, {3.21, 2.11}, {1.63, 2.11}};
  std::string coarse = wall_text, open = wall_text;
  coarse.replace(coarse.find("[12, 6]"), 7, "[24, 12]");
  open.replace(open.find("\"mesh\": [12, 6]"), 15,
               "\"mesh\": [24, 12], \"openings\": [[[1.63, 0.93], [3.21, 0.93], [3.21, 2.11], [1.63, 2.11]]]");
  const Building b = wall(coarse);
  StandingFrame frame(b, CombinationId(0u), FailureRules{});
  const std::vector<Vec6> whole{frame.displacement(NodeId(2u)), frame.displacement(NodeId(3u))};
  PanelRemains remains;
  remains.share = 1 - 1.58 * 1.18 / 18;
  remains.holes = {odd};
  remains.edge_length = {6, 3, 6, 3};
  frame.fracture(PanelId(0u), remains);
  (void)frame.settle(1000);
  Frame mesh;
  const auto expected = global_answer(wall(open), false, mesh);
  for (const std::size_t n : {2u, 3u}) {
    const Vec6 right = expected.displacements[n], found = frame.displacement(NodeId(n));
    // Elements of 0.25 m that the hole cuts keep the share of their stiffness that is there, wherever it lies in them:
    // a part of what the hole itself changes.
    CHECK((right - whole[n - 2]).head<3>().norm() > 0.05 * right.head<3>().norm());
    CHECK((found - right).head<3>().norm() < 0.2 * (right - whole[n - 2]).head<3>().norm());
  }
}

TEST_CASE("a push on a shell panel gives way as the global mesh does") {
  const Building b = wall();
  StandingFrame frame(b, CombinationId(0u), FailureRules{});
  Frame mesh = make_frame(b);
  const Vec3 point(2.5, 0, 2.5);  // a node of the mesh
  int node = -1;
  for (std::size_t n = 0; n < mesh.model.nodes.size(); ++n)
    if ((mesh.model.nodes[n] - point).norm() < 1e-9) node = static_cast<int>(n);
  REQUIRE(node >= 0);
  topple::solver::LoadSet set;
  Vec6 push = Vec6::Zero();
  push(1) = 1;
  set.nodes = {{node, push}};
  topple::solver::StaticAnalysis analysis(mesh.model);
  const auto expected = analysis.solve(std::span(&set, 1)).front();
  ContactPlace place;
  place.panel = PanelId(0u);
  place.point = point;
  const StandingFrame::UnitResponse response = frame.respond(place, Vec3::UnitY());
  CHECK(response.compliance == Approx(expected.displacements[static_cast<std::size_t>(node)](1)).epsilon(1e-9));
}

TEST_CASE("the wall is shot through with each method, where the ball touches it, and stands on") {
  for (const std::string name : {"wall_hit", "wall_hit_quadrilateral", "wall_hit_local"}) {
    CAPTURE(name);
    const auto [model, scenario] = read_scenario(find_scenario(name));
    Simulation simulation(model, scenario);
    const double whole = simulation.frame().mass(PanelId(0u));
    while (!simulation.finished() && !find(simulation, SimulationEvent::Kind::panel_fractured)) simulation.step();
    const SimulationEvent* fractured = find(simulation, SimulationEvent::Kind::panel_fractured);
    REQUIRE(fractured);
    // The ball's path meets the wall's face (y = -0.1 m) where the swept contact says.
    const double time = (8 - 0.3 - 0.1) / 40;
    CHECK((fractured->position - Vec3(2.6, -0.1, 2.1 - 9.80665 * time * time / 2)).norm() < 5e-3);
    CHECK(simulation.frame().stands(PanelId(0u)));
    double chunks = 0, dust = 0;
    for (const BodyView& body : simulation.bodies()) chunks += body.chunk ? body.mass : 0;
    for (const SimulationEvent& event : simulation.events())
      dust += event.kind == SimulationEvent::Kind::limited ? event.mass : 0;
    CHECK(chunks > 0);
    CHECK(dust < 0.003 * whole);
    CHECK(chunks + dust + simulation.frame().mass(PanelId(0u)) == Approx(whole).epsilon(1e-9));
    const SimulationEvent* impact = find(simulation, SimulationEvent::Kind::impact);
    REQUIRE(impact);
    CHECK(impact->speed_out > 0);
    CHECK(impact->speed_out < impact->speed_in);
    while (!simulation.finished()) simulation.step();
    CHECK(simulation.at_rest());
    CHECK(simulation.frame().stands(PanelId(0u)));
    // Of the gravity work too, which is a thirtieth of what the ball brings in: what is left is rounding of free spins.
    const Ledger& ledger = simulation.ledger();
    CHECK(std::abs(ledger.residual()) * (std::abs(ledger.gravity_work) + ledger.work_put_in) <
          0.001 * std::abs(ledger.gravity_work));
  }
}

TEST_CASE("a ball leaves a hole that it fits through, however coarse the cells") {
  for (const auto method :
       {topple::fracture::Method::voronoi, topple::fracture::Method::quadrilateral, topple::fracture::Method::local}) {
    CAPTURE(static_cast<int>(method));
    const auto [model, scenario] = read_scenario(find_scenario("wall_hit"));
    Scenario coarse = scenario;
    coarse.fracture->method = method;
    coarse.fracture->cell = 1.3;
    coarse.fracture->local.length = {0.05, 0.4};
    Simulation simulation(model, coarse);
    while (!simulation.finished() && !find(simulation, SimulationEvent::Kind::panel_fractured)) simulation.step();
    const SimulationEvent* fractured = find(simulation, SimulationEvent::Kind::panel_fractured);
    REQUIRE(fractured);
    const double radius = 0.3;
    for (int i = 0; i < 24; ++i) {
      const double angle = 2 * M_PI * i / 24;
      const Vec3 beside = 0.94 * radius * Vec3(std::cos(angle), 0, std::sin(angle));
      const auto met = simulation.ray_cast(fractured->position + beside - Vec3(0, 0.05, 0), Vec3::UnitY());
      CHECK((!met || met->panel != PanelId(0u)));
    }
    CHECK(simulation.frame().stands(PanelId(0u)));
  }
}

TEST_CASE("a click breaks the wall where its ray meets it") {
  const auto [model, scenario] = read_scenario(find_scenario("wall_hit"));
  Scenario quiet = scenario;
  quiet.events.clear();
  quiet.until_rest = false;
  Simulation simulation(model, quiet);
  simulation.step();
  const Vec3 eye(1, -9, 4), towards = (Vec3(4.2, 0, 1.4) - eye).normalized();
  const auto ray = simulation.ray_cast(eye, towards);
  REQUIRE(ray);
  REQUIRE(ray->panel == PanelId(0u));
  Projectile ball;
  ball.mass = 200;
  ball.radius = 0.1;
  ball.from = eye;
  ball.velocity = 200 * towards;
  simulation.apply(ball);
  for (int i = 0; i < 20 && !find(simulation, SimulationEvent::Kind::panel_fractured); ++i) simulation.step();
  const SimulationEvent* fractured = find(simulation, SimulationEvent::Kind::panel_fractured);
  REQUIRE(fractured);
  // A ball touches the face before its centre's ray does, by r (1 - cos) / cos along it; it falls 8 mm on its way.
  const double cosine = towards.y();
  const double early = ball.radius / cosine - ball.radius * cosine;
  CHECK((fractured->position - ray->point).norm() < early + 0.03);
}

TEST_CASE("stress beyond the tensile strength cracks a wall at its foot, and one within it does not") {
  std::string strong = wall_text, weak = wall_text;
  const std::string pressure = "\"pressure\": 2000";
  // A cantilever of 3 m under 2 kPa bends with 9 kN m/m: 1.35 MPa less 0.07 MPa of weight; ten times that is too much.
  strong.replace(strong.find("\"joint\": \"foot\""), 15, "\"groups\": [\"w\"]");
  const std::string point = ",\n                    \"nodes\": {\"A1\": {\"y\": 3000, \"z\": -20000}}";
  strong.erase(strong.find(point), point.size());
  weak = strong;
  weak.replace(weak.find(pressure), pressure.size(), "\"pressure\": 20000");
  Scenario scenario = shipped("wall_hit");
  scenario.standing = GENERATE(StandingRule::statics, StandingRule::dynamics);
  scenario.events.clear();
  Simulation standing(wall(strong), scenario), cracking(wall(weak), scenario);
  for (int i = 0; i < 3; ++i) standing.step(), cracking.step();
  CHECK_FALSE(find(standing, SimulationEvent::Kind::panel_fractured));
  const SimulationEvent* crack = find(cracking, SimulationEvent::Kind::panel_fractured);
  REQUIRE(crack);
  CHECK(crack->position.z() < 0.5);  // in the lowest row of elements
  const auto stress = standing.frame().stress(PanelId(0u));
  REQUIRE(stress);
  // At the centre of the lowest row, 0.25 m up: bending of 2.75 m cantilevers, within what the free ends change.
  const double bending = 2000 * 2.75 * 2.75 / 2 * 6 / 0.04;
  CHECK(stress->tension == Approx(bending).epsilon(0.15));
}

TEST_CASE("walls that are loaded alike crack in the same step, and none is left out") {
  // Two walls side by side, each a cantilever that 20 kPa crack at its foot.
  std::string text = wall_text;
  const auto put = [&](const std::string& old, const std::string& now) {
    text.replace(text.find(old), old.size(), now);
  };
  put("\"A1\": [0, 0, 3]}",
      "\"A1\": [0, 0, 3],\n \"C0\": [0, 9, 0], \"D0\": [6, 9, 0], \"D1\": [6, 9, 3], \"C1\": [0, 9, 3]}");
  put("\"joint\": \"foot\"}}",
      "\"groups\": [\"w\"]},\n \"V\": {\"kind\": \"wall\", \"nodes\": [\"C0\", \"D0\", \"D1\", \"C1\"], "
      "\"thickness\": 0.2, \"material\": \"c\", \"model\": \"shell\", \"mesh\": [12, 6]}}");
  put("\"supports\": {\"W:1\": \"fixed\"}", "\"supports\": {\"W:1\": \"fixed\", \"V:1\": \"fixed\"}");
  put("\"panels\": {\"W\": {\"pressure\": 2000}},\n                    \"nodes\": {\"A1\": {\"y\": 3000, \"z\": "
      "-20000}}",
      "\"panels\": {\"W\": {\"pressure\": 20000}, \"V\": {\"pressure\": 20000}}");
  Scenario scenario = shipped("wall_hit");
  scenario.standing = GENERATE(StandingRule::statics, StandingRule::dynamics);
  scenario.events.clear();
  Simulation simulation(wall(text), scenario);
  std::map<std::string, std::int64_t> first;
  for (int i = 0; i < 10; ++i) simulation.step();
  for (const SimulationEvent& event : simulation.events())
    if (event.kind == SimulationEvent::Kind::panel_fractured) first.emplace(event.name, event.step);
  REQUIRE(first.size() == 2);
  CHECK(first.at("W") == 1);
  CHECK(first.at("V") == 1);
}
