// Shells that stand with members and other shells along their edges: a standing frame against the analysis of the whole
// mesh, undamaged, shot through, and with an edge that has let go; and a building of such walls that is hit.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <map>

#include "simulation_run.h"
#include "support/scratch_folder.h"
#include "topple/solver/static_analysis.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/frame.h"
#include "topple/structure/join_shells.h"
#include "topple/structure/simulation.h"

using namespace topple::structure;
using topple::solver::FrameModel;
using topple::solver::StaticSolution;

namespace {

/// W1 (6 m x 3 m) stands on its lower edge, between a post and W2, with a beam over it and W3 on that; no member lies
/// between W1 and W2, whose meshes do not fit each other at first.
const std::string walls_text = R"({"topple": 1, "title": "Walls",
 "materials": {"c": {"youngs_modulus": 30e9, "poisson_ratio": 0.2, "density": 2400, "compressive_strength": 30e6},
               "s": {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7850}},
 "sections": {"beam": {"shape": "I", "depth": 0.3, "width": 0.2, "web": 0.01, "flange": 0.015},
              "post": {"shape": "box", "depth": 0.3, "width": 0.2, "thickness": 0.015}},
 "joints": {"spring": {"stiffness": {"ry": 2e7}}},
 "nodes": {"A0": [0, 0, 0], "B0": [6, 0, 0], "C0": [10, 0, 0], "A1": [0, 0, 3], "B1": [6, 0, 3], "C1": [10, 0, 3],
           "A2": [0, 0, 6], "B2": [6, 0, 6]},
 "members": {"PA": {"kind": "post", "nodes": ["A0", "A1"], "section": "post", "material": "s"},
             "PC": {"kind": "post", "nodes": ["C0", "C1"], "section": "post", "material": "s"},
             "AB": {"kind": "beam", "nodes": ["A1", "B1"], "section": "beam", "material": "s", OFFSETS
                    "joints": [null, "spring"]},
             "PB": {"kind": "post", "nodes": ["B2", "B1"], "section": "post", "material": "s"}},
 "panels": {
   "W1": {"kind": "wall", "nodes": ["A0", "B0", "B1", "A1"], "thickness": 0.2, "material": "c", "model": "shell",
          "mesh": [6, 3], "openings": [[[1, 1], [2, 1], [2, 2], [1, 2]]]},
   "W2": {"kind": "wall", "nodes": ["B0", "C0", "C1", "B1"], "thickness": 0.15, "material": "c", "model": "shell",
          "mesh": [3, 2]},
   "W3": {"kind": "wall", "nodes": ["A1", "B1", "B2", "A2"], "thickness": 0.12, "material": "c", "model": "shell",
          "mesh": [4, 2]}},
 "supports": {"A0": "fixed", "B0": "fixed", "C0": "pinned", "W1:1": "fixed"},
 "loads": {"dead": {"self_weight": 1.0, "panels": {"W1": {"pressure": 2000}},
                    "nodes": {"A2": {"x": 5e4, "y": 3000, "z": -20000}},
                    "members": {"AB": [{"uniform": {"z": -8e3, "y": 500}},
                                       {"trapezoid": {"z": [-1e3, -9e3]}, "from": 0.7, "to": 4.1},
                                       {"point": {"z": -3e4, "rx": 400}, "at": 2.5}]}}}})";

std::string text(const std::string& offsets = "") {
  std::string own = walls_text;
  own.replace(own.find("OFFSETS"), 7, offsets);
  return own;
}

Building as_drawn(const std::string& model) { return parse_model(model, "walls.json", Purpose::demolish); }
Building readied(const std::string& model) {
  Building building = as_drawn(model);
  join_shells(building);
  return building;
}

/// What is different in the whole mesh: elements of W1 that are gone, and nodes at which it has let go.
struct Damage {
  bool hole = false, top_edge = false;
};
bool in_hole(const Vec3& at) { return at.x() > 3 && at.x() < 5 && at.z() > 1 && at.z() < 2; }

struct WholeMesh {
  FrameModel model;
  StaticSolution answer;
  std::map<std::string, Vec6> at_nodes;
};

WholeMesh analysed(const Building& b, const Damage& damage) {
  const Frame frame = make_frame(b);
  const PartLoads loads = part_loads(b, CombinationId(0u));
  topple::solver::LoadSet set = on_frame(b, frame, loads, load_set(b, loads));
  WholeMesh mesh;
  mesh.model = frame.model;
  mesh.model.shells.clear();
  std::vector<topple::solver::ShellLoad> on_shells;
  const PanelMesh& wall = frame.meshes[0];
  std::map<int, int> twin;
  if (damage.top_edge)
    for (std::size_t i = 1; i + 1 < wall.edge_nodes[2].size(); ++i) {
      twin[wall.edge_nodes[2][i]] = static_cast<int>(mesh.model.nodes.size());
      mesh.model.nodes.push_back(frame.model.nodes[static_cast<std::size_t>(wall.edge_nodes[2][i])]);
    }
  std::vector<char> has(mesh.model.nodes.size(), 0);
  for (const auto& beam : mesh.model.beams)
    for (const int node : beam.node) has[static_cast<std::size_t>(node)] = 1;
  for (std::size_t k = 0; k < frame.model.shells.size(); ++k) {
    topple::solver::Shell shell = frame.model.shells[k];
    const bool of_wall = static_cast<int>(k) >= wall.first_shell &&
                         k < static_cast<std::size_t>(wall.first_shell) + wall.elements.size();
    Vec3 centre = Vec3::Zero();
    for (const int node : shell.node) centre += frame.model.nodes[static_cast<std::size_t>(node)] / 4;
    if (damage.hole && of_wall && in_hole(centre)) continue;
    if (of_wall)
      for (int& node : shell.node)
        if (twin.contains(node)) node = twin.at(node);
    for (topple::solver::ShellLoad load : set.shells)
      if (load.shell == static_cast<int>(k)) {
        load.shell = static_cast<int>(mesh.model.shells.size());
        on_shells.push_back(load);
      }
    for (const int node : shell.node) has[static_cast<std::size_t>(node)] = 1;
    mesh.model.shells.push_back(shell);
  }
  for (std::size_t n = 0; n < has.size(); ++n)
    if (!has[n]) mesh.model.supports.push_back({static_cast<int>(n), Vec6::Constant(unlimited)});
  set.shells = on_shells;
  topple::solver::StaticAnalysis analysis(mesh.model);
  mesh.answer = analysis.solve(std::span(&set, 1)).front();
  return mesh;
}

/// Every node of the readied building moves as the node of the whole mesh at its place does.
void check_same(const Building& b, const StandingFrame& frame, const WholeMesh& mesh) {
  double largest = 0, difference = 0;
  for (std::size_t n = 0; n < b.nodes.size(); ++n) {
    std::size_t found = mesh.model.nodes.size();
    for (std::size_t m = 0; m < mesh.model.nodes.size() && found == mesh.model.nodes.size(); ++m)
      if ((mesh.model.nodes[m] - b.nodes[n].position).norm() < 1e-9) found = m;
    REQUIRE(found < mesh.model.nodes.size());
    largest = std::max(largest, mesh.answer.displacements[found].norm());
    difference = std::max(difference, (frame.displacement(NodeId(n)) - mesh.answer.displacements[found]).norm());
  }
  CHECK(largest > 1e-4);
  CHECK(difference < 1e-9 * largest);
}

void check_energy(const StandingFrame& frame, bool freed) {
  const FrameEnergy e = frame.energy();
  CHECK(e.elastic - e.elastic_at_start ==
        Approx(e.gravity_work + e.other_work + e.contact_work - e.freed).epsilon(1e-9).margin(1e-9 * e.elastic));
  CHECK((freed ? e.freed > 0 : e.freed == 0));
}

PanelRemains with_hole() {
  PanelRemains remains;
  remains.share = 1 - 2.0 / 17;
  remains.holes = {{{3, 1}, {5, 1}, {5, 2}, {3, 2}}};
  remains.edge_length = {6, 3, 6, 3};
  return remains;
}

}  // namespace

TEST_CASE("readying a building divides members at the meshes along them, and names the nodes between shells") {
  Building b = as_drawn(text());
  const std::size_t given = b.nodes.size(), members = b.members.size();
  join_shells(b);
  const NameIndex names(b);
  // W3 halves W1's lines at 1.5 m and 4.5 m: AB has six, at 1 to 5 m, and these two.
  CHECK(names.member("AB/8"));
  CHECK_FALSE(names.member("AB/9"));
  CHECK(b[*names.joint("AB:2")].stiffness(4) == 2e7);
  CHECK(b[*names.joint("AB:2")].member == *names.member("AB/8"));
  CHECK(names.member("PB/2"));
  CHECK(names.node("W1:2/1"));
  CHECK(b[*names.node("W1:2/1")].position.x() == 6);
  CHECK(b.panels[0].edge_nodes[1].front() == b.panels[1].edge_nodes[3].back());
  CHECK(b.panels[0].joined == std::array<bool, 4>{false, true, true, true});
  CHECK(b.panels[1].joined == std::array<bool, 4>{false, true, false, true});
  CHECK(b.nodes.size() > given);
  CHECK(b.members.size() > members);
  // Again: nothing is left to do.
  const std::size_t now = b.nodes.size();
  join_shells(b);
  CHECK(b.nodes.size() == now);
  // And it is needed.
  CHECK_THROWS_AS(StandingFrame(as_drawn(text()), CombinationId(0u), FailureRules{}), std::invalid_argument);
  std::string taken = text();
  taken.replace(taken.find("\"A2\": [0"), 4, "\"W1:2/1\"");
  for (std::size_t at; (at = taken.find("\"A2\"")) != std::string::npos;) taken.replace(at, 4, "\"W1:2/1\"");
  CHECK_THROWS_AS(readied(taken), InputError);
}

TEST_CASE("walls that share edges with members and each other stand as the whole mesh does") {
  for (const std::string offsets : {"", "\"offsets\": [[0.2, 0, 0.25], [-0.1, 0.05, 0.25]],"}) {
    CAPTURE(offsets);
    const Building b = readied(text(offsets));
    StandingFrame frame(b, CombinationId(0u), FailureRules{});
    check_same(b, frame, analysed(as_drawn(text(offsets)), {}));
    check_energy(frame, false);
    // The mass is that of what is drawn.
    double mass = 0;
    for (std::size_t p = 0; p < 3; ++p) mass += frame.mass(PanelId(p));
    CHECK(mass == Approx(2400 * (17 * 0.2 + 12 * 0.15 + 18 * 0.12)).epsilon(1e-12));
  }
}

TEST_CASE("a hole changes what members and neighbours bear as in the whole mesh, and an edge that lets go") {
  const Building b = readied(text()), drawn = as_drawn(text());
  StandingFrame frame(b, CombinationId(0u), FailureRules{});
  frame.fracture(PanelId(0u), with_hole());
  (void)frame.settle(1000);
  check_same(b, frame, analysed(drawn, {true, false}));
  check_energy(frame, true);
  frame.break_joint(b.joint(PanelId(0u), 2), BreakCause::tool);
  (void)frame.settle(1000);
  check_same(b, frame, analysed(drawn, {true, true}));
  check_energy(frame, true);
  // The order does not matter.
  StandingFrame other(b, CombinationId(0u), FailureRules{});
  other.break_joint(b.joint(PanelId(0u), 2), BreakCause::tool);
  (void)other.settle(1000);
  check_same(b, other, analysed(drawn, {false, true}));
  other.fracture(PanelId(0u), with_hole());
  (void)other.settle(1000);
  check_same(b, other, analysed(drawn, {true, true}));
  check_energy(other, true);
}

TEST_CASE("edge joints of a wall bear together what acts on it") {
  const Building b = readied(text());
  StandingFrame frame(b, CombinationId(0u), FailureRules{});
  const std::array<double, 4> length{6, 3, 6, 3};
  const auto sum = [&] {
    Vec3 held = Vec3::Zero();
    for (int edge = 0; edge < 4; ++edge) {
      const Vec3 along = (b[b.panels[0].nodes[(static_cast<std::size_t>(edge) + 1) % 4]].position -
                          b[b.panels[0].nodes[static_cast<std::size_t>(edge)]].position)
                             .normalized();
      const Vec3 normal = b.panels[0].axes.row(2), outwards = along.cross(normal);
      const Vec6 demand = frame.demand(b.joint(PanelId(0u), edge));
      held += length[static_cast<std::size_t>(edge)] * (demand(0) * outwards + demand(1) * along + demand(2) * normal);
    }
    return held;
  };
  // Weight down and pressure against the normal, which points to -y.
  const auto load = [&](double area) { return Vec3(0, 2000 * area, -9.80665 * 2400 * 0.2 * area); };
  CHECK((sum() + load(17)).norm() < 1e-8 * load(17).norm());
  frame.fracture(PanelId(0u), with_hole());
  (void)frame.settle(1000);
  CHECK((sum() + load(15)).norm() < 1e-8 * load(15).norm());
  frame.break_joint(b.joint(PanelId(0u), 3), BreakCause::tool);
  (void)frame.settle(1000);
  CHECK(frame.demand(b.joint(PanelId(0u), 3)).norm() == 0);
  CHECK((sum() + load(15)).norm() < 1e-8 * load(15).norm());
}

TEST_CASE("a push on a wall between members gives way as the whole mesh does") {
  const Building b = readied(text());
  StandingFrame frame(b, CombinationId(0u), FailureRules{});
  FrameModel mesh = make_frame(as_drawn(text())).model;
  const Vec3 point(3, 0, 2);
  topple::solver::LoadSet set;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    if ((mesh.nodes[n] - point).norm() < 1e-9) set.nodes.push_back({static_cast<int>(n), Vec6::Unit(1)});
  REQUIRE(set.nodes.size() == 1);
  const auto node = static_cast<std::size_t>(set.nodes.front().node);
  topple::solver::StaticAnalysis analysis(mesh);
  const StaticSolution expected = analysis.solve(std::span(&set, 1)).front();
  ContactPlace place;
  place.panel = PanelId(0u);
  place.point = point;
  CHECK(frame.respond(place, Vec3::UnitY()).compliance == Approx(expected.displacements[node](1)).epsilon(1e-9));
}

TEST_CASE("a wall hangs on each edge that holds, and falls without any") {
  const Building b = readied(text());
  StandingFrame frame(b, CombinationId(0u), FailureRules{});
  frame.break_joint(b.joint(PanelId(2u), 0), BreakCause::tool);
  (void)frame.settle(1000);
  CHECK(frame.stands(PanelId(2u)));  // by the post PB
  CHECK(frame.extract_detached().empty());
  frame.break_joint(b.joint(PanelId(2u), 1), BreakCause::tool);
  (void)frame.settle(1000);
  CHECK_FALSE(frame.stands(PanelId(2u)));
  const NameIndex names(b);
  for (const char* name : {"AB", "PB", "PB/2", "PA", "PC"}) CHECK(frame.stands(*names.member(name)));
  CHECK(frame.stands(PanelId(0u)));
  CHECK(frame.stands(PanelId(1u)));
  const std::vector<Detached> left = frame.extract_detached();
  REQUIRE(left.size() == 1);
  CHECK(left[0].panels == std::vector<PanelId>{PanelId(2u)});
  CHECK(left[0].members.empty());
  check_energy(frame, true);
}

TEST_CASE("members that a wall alone holds leave with it") {
  // W3 stands on PB alone, and PB on its foot: when that breaks both are one part.
  const Building b = readied(text());
  StandingFrame frame(b, CombinationId(0u), FailureRules{});
  const NameIndex names(b);
  frame.break_joint(b.joint(PanelId(2u), 0), BreakCause::tool);
  (void)frame.settle(1000);
  frame.break_joint(*names.joint("PB:2"), BreakCause::tool);
  (void)frame.settle(1000);
  CHECK(frame.stands(PanelId(2u)));  // its lower corner is on the node, and PB hangs on it
  CHECK(frame.stands(*names.member("PB")));
  frame.remove(PanelId(0u));
  frame.remove(PanelId(1u));
  frame.break_joint(*names.joint("AB:2"), BreakCause::tool);
  (void)frame.settle(1000);
  CHECK_FALSE(frame.stands(PanelId(2u)));
  CHECK(frame.stands(*names.member("AB")));
  // PC, which stands on a pin, has lost its hold as well.
  std::vector<Detached> left = frame.extract_detached();
  std::erase_if(left, [](const Detached& part) { return part.panels.empty(); });
  REQUIRE(left.size() == 1);
  CHECK(left[0].panels == std::vector<PanelId>{PanelId(2u)});
  CHECK(left[0].members == names.members_matching("PB*"));
}

TEST_CASE("a wall that is taken out leaves members and neighbours standing as if it had never been there") {
  const Building b = readied(text());
  StandingFrame frame(b, CombinationId(0u), FailureRules{});
  frame.remove(PanelId(0u));
  (void)frame.settle(1000);
  CHECK(frame.stands(PanelId(1u)));
  CHECK(frame.stands(PanelId(2u)));
  // The same from the beginning, with the mesh lines that W1 had left behind.
  Building without = b;
  without.panels.erase(without.panels.begin());
  without.edge_supports.clear();
  without.cases[0].panels.clear();
  const std::size_t first = 2 * without.members.size();
  without.joints.erase(without.joints.begin() + static_cast<std::ptrdiff_t>(first),
                       without.joints.begin() + static_cast<std::ptrdiff_t>(first) + 4);
  for (Joint& joint : without.joints)
    if (joint.panel.valid()) joint.panel = PanelId(static_cast<std::size_t>(joint.panel.index - 1));
  // Supports at W1's corners were also those of its edge: A0 and B0 are fixed anyway.
  StandingFrame expected(without, CombinationId(0u), FailureRules{});
  double largest = 0, difference = 0;
  for (std::size_t n = 0; n < b.nodes.size(); ++n) {
    if (!frame.stands(NodeId(n))) continue;
    largest = std::max(largest, expected.displacement(NodeId(n)).norm());
    difference = std::max(difference, (frame.displacement(NodeId(n)) - expected.displacement(NodeId(n))).norm());
  }
  CHECK(largest > 1e-4);
  CHECK(difference < 1e-9 * largest);
}

TEST_CASE("a scenario cuts a member along a wall where it says, and names all of its pieces") {
  const topple::test::ScratchFolder folder;
  std::ofstream(folder / "walls.json") << text();
  std::ofstream(folder / "s.json")
      << R"({"topple": 1, "model": "walls.json", "standing": "static", "duration": 3, "events": [
    {"at": 0.1, "cut": {"members": [{"member": "AB", "where": 0.4}]}}, {"at": 0.2, "remove": {"members": ["AB"]}}]})";
  const auto [building, scenario] = read_scenario(folder / "s.json");
  const NameIndex names(building);
  // 2.4 m is a line of W1's mesh too, and of W3's: one piece more.
  REQUIRE(names.member("AB/9"));
  CHECK_FALSE(names.member("AB/10"));
  bool on_line = false;
  for (const NodeId node : building.panels[0].edge_nodes[2])
    on_line = on_line || std::abs(building[node].position.x() - 2.4) < 1e-9;
  CHECK(on_line);
  Simulation simulation(building, scenario);
  while (simulation.frame().stands(*names.member("AB")) && !simulation.finished()) simulation.step();
  for (const MemberId piece : names.members_matching("AB*")) CHECK_FALSE(simulation.frame().stands(piece));
  CHECK(simulation.frame().stands(PanelId(2u)));  // W3 stands on W1 now
}

TEST_CASE("the house of shell walls is shot through, loses a post, and what is left of it stands") {
  const auto [building, scenario] = read_scenario(find_scenario("shell_house_hit"));
  Simulation simulation(building, scenario);
  double whole = 0;
  for (std::size_t p = 0; p < building.panels.size(); ++p) whole += simulation.frame().mass(PanelId(p));
  topple::test::run(simulation);
  const auto fractured = topple::test::of_kind(simulation, SimulationEvent::Kind::panel_fractured);
  REQUIRE(fractured.size() >= 2);
  CHECK(fractured[0].name == "WX-1-1-1");
  // The first ball meets the wall's face after (9 - 0.35 - 0.1) m.
  const double time = (9 - 0.35 - 0.1) / 45;
  CHECK((fractured[0].position - Vec3(4.0, -0.1, 1.6 - 9.80665 * time * time / 2)).norm() < 0.01);
  CHECK(simulation.at_rest());
  CHECK(std::abs(simulation.ledger().residual()) < 0.02);
  // The walls carry what the post did.
  const NameIndex names(building);
  CHECK_FALSE(simulation.frame().stands(*names.member("P-2-1-1")));
  CHECK(simulation.frame().stands(*names.member("P-2-1-2")));
  CHECK(simulation.frame().stands(*names.panel("WX-1-1-2")));
  double left = 0;
  for (std::size_t p = 0; p < building.panels.size(); ++p)
    if (simulation.frame().stands(PanelId(p))) left += simulation.frame().mass(PanelId(p));
  for (const BodyView& body : simulation.bodies()) left += body.chunk ? body.mass : 0;
  CHECK(left == Approx(whole).epsilon(2e-3));  // but for dust
}
