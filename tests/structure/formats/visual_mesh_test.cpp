// Drawn models: read, bound, cut where their parts come apart; nothing of them is lost.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>

#include "support/scratch_folder.h"
#include "support/source_tree.h"
#include "topple/fracture/gltf_reader.h"
#include "topple/fracture/mesh_files.h"
#include "topple/fracture/prism.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/visual_mesh.h"

using namespace topple::structure;
namespace fracture = topple::fracture;

namespace {

double check_pieces(const VisualMesh& model) {
  double sum = 0;
  for (const VisualMesh::Piece& piece : model.pieces()) {
    const fracture::MeshAudit audit = fracture::audit(*piece.mesh, 1e-9, true);
    CHECK(audit.open_edges == 0);
    CHECK(audit.volume > 0);
    sum += audit.volume;
  }
  return sum;
}

/// A frame of one bay: two posts and a beam, the beam's joints broken by a tool at 0.1 s.
const char* const bay_text = R"({"topple": 1, "title": "Bay",
 "materials": {"S": {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7850}},
 "sections": {"tube": {"shape": "box", "depth": 0.3, "width": 0.3, "thickness": 0.015}},
 "joints": {"j": {"capacity": {"force": [1e8, 1e8, 1e8], "moment": [1e8, 1e8, 1e8]}}},
 "nodes": {"A": [0, 0, 0], "B": [0, 0, 4], "C": [6, 0, 4], "D": [6, 0, 0]},
 "members": {"P": {"kind": "post", "nodes": ["A", "B"], "section": "tube", "material": "S"},
             "Q": {"kind": "post", "nodes": ["D", "C"], "section": "tube", "material": "S"},
             "T": {"nodes": ["B", "C"], "section": "tube", "material": "S", "joints": ["j", "j"]}},
 "supports": {"A": "fixed", "D": "fixed"},
 "meshes": {"lintel": {"file": "lintel.glb", "bind": BIND}}})";

/// A bar from x = -0.5 to 6.5 m around the beam, in the file's axes (y up).
void write_bar(const std::filesystem::path& file) {
  fracture::Polygon section{{-0.5, -0.2}, {6.5, -0.2}, {6.5, 0.2}, {-0.5, 0.2}};
  fracture::Mesh bar =
      fracture::prism_mesh(section, {{0, 1, 2}, {0, 2, 3}}, 0.6);  // x along, y up after the lift below
  for (fracture::Vec3& p : bar.positions) p.y() += 4;
  std::ofstream(file, std::ios::binary) << fracture::glb_text(bar, {"bar", fracture::Vec3::Zero(), {}});
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
  return text;
}

}  // namespace

TEST_CASE("a drawn bar is cut where the beam's joints broke, and each piece follows its part") {
  const topple::test::ScratchFolder folder;
  write_bar(folder / "lintel.glb");
  std::ofstream(folder / "bay.json") << replaced(bay_text, "BIND", "\"nearest\"");
  std::ofstream(folder / "s.json") << R"({"topple": 1, "model": "bay.json", "standing": "static", "duration": 3,
    "events": [{"at": 0.1, "cut": {"joints": ["T:1", "T:2"]}}]})";
  auto [building, scenario] = read_scenario(folder / "s.json");
  Simulation simulation(building, scenario);
  std::vector<DrawnMesh> meshes = read_drawn_meshes(simulation.building(), folder / "bay.json");
  REQUIRE(meshes.size() == 1);
  CHECK(meshes[0].name == "bar");
  // Turned from y up to z up: the bar lies around z = 4 m.
  for (const fracture::Vec3& p : meshes[0].mesh.positions) CHECK(std::abs(p.z() - 4) < 0.21);
  VisualMesh model(simulation.building(), std::move(meshes));
  CHECK(model.volume() == Approx(7 * 0.4 * 0.6).epsilon(1e-6));  // single precision in the file
  CHECK(model.pieces().size() == 1);
  simulation.step();
  model.update(simulation);
  CHECK(model.pieces().size() == 1);  // all of it stands
  while (!simulation.finished()) {
    simulation.step();
    model.update(simulation);
  }
  // Three pieces: over each post what lies beyond the joint's plane, and between them the beam's.
  REQUIRE(model.pieces().size() == 3);
  CHECK(check_pieces(model) == Approx(model.volume()).epsilon(1e-12));
  double fallen = 0;
  for (const VisualMesh::Piece& piece : model.pieces()) {
    if (piece.body.value < 0) continue;
    fallen += piece.volume;
    for (const fracture::Vec3& p : piece.mesh->positions) {
      CHECK(p.x() > -1e-6);
      CHECK(p.x() < 6 + 1e-6);
    }
  }
  CHECK(fallen == Approx(6 * 0.4 * 0.6).epsilon(1e-6));
  // What is written is read again as it was: three meshes, the beam's on the ground.
  std::ofstream(folder / "out.glb", std::ios::binary) << visual_mesh_glb(model, simulation);
  const auto written = fracture::read_gltf((folder / "out.glb").string());
  REQUIRE(written.size() == 3);
  double lowest = 10;
  for (const auto& one : written) {
    CHECK(fracture::audit(one.mesh, 1e-9, true).open_edges == 0);
    for (const fracture::Vec3& p : one.mesh.positions) lowest = std::min(lowest, p.z());
  }
  CHECK(lowest < 0.3);
}

TEST_CASE("a mesh bound by name follows that part alone") {
  const topple::test::ScratchFolder folder;
  write_bar(folder / "lintel.glb");
  std::ofstream(folder / "bay.json") << replaced(bay_text, "BIND", R"({"bar": "P"})");
  const Building building = read_model(folder / "bay.json", Purpose::demolish);
  const auto meshes = read_drawn_meshes(building, folder / "bay.json");
  REQUIRE(meshes.size() == 1);
  CHECK(building[meshes[0].member].name == "P");
  std::ofstream(folder / "bad.json") << replaced(bay_text, "BIND", R"({"bar": "X"})");
  CHECK_THROWS_AS(read_drawn_meshes(read_model(folder / "bad.json", Purpose::demolish), folder / "bad.json"),
                  InputError);
}

TEST_CASE("the drawn facade of the seed building comes down with it, closed and whole") {
  auto [building, scenario] = read_scenario(find_scenario("seed_house_hit"));
  Simulation simulation(std::move(building), std::move(scenario));
  VisualMesh model(simulation.building(),
                   read_drawn_meshes(simulation.building(), topple::test::in_source_tree("models/seed_house.json")));
  CHECK(model.pieces().size() == 108);
  // Six bands round 18 m x 24 m of 0.6 m x 0.3 m, and 84 frames of 2.024 m3.
  CHECK(model.volume() == Approx(6 * 84 * 0.18 + 84 * 2.024).epsilon(1e-5));
  while (simulation.time() < 3) {
    simulation.step();
    model.update(simulation);
  }
  CHECK(model.pieces().size() > 108);
  CHECK(check_pieces(model) == Approx(model.volume()).epsilon(1e-11));
}

TEST_CASE("a mesh with a density weighs on the parts that carry it") {
  const topple::test::ScratchFolder folder;
  write_bar(folder / "lintel.glb");
  const auto with = [&](const std::string& bind, const std::string& more) {
    std::ofstream(folder / "bay.json") << replaced(bay_text, "BIND}", bind + more + "}");
    return read_model(folder / "bay.json", Purpose::demolish);
  };
  const double bar = 7 * 0.4 * 0.6 * 800;  // kg
  const Building plain = with("\"nearest\"", ", \"density\": 0"), bound = with(R"({"bar": "T"})", ", \"density\": 800"),
                 nearest = with("\"nearest\"", ", \"density\": 800");
  CHECK(plain.materials.size() == 1);
  const StandingFrame light(plain, CombinationId(0u), {}), heavy(bound, CombinationId(0u), {}),
      shared(nearest, CombinationId(0u), {});
  CHECK(heavy.mass(MemberId(2u)) == Approx(light.mass(MemberId(2u)) + bar).epsilon(1e-6));
  CHECK(heavy.mass(MemberId(0u)) == light.mass(MemberId(0u)));
  double before = 0, after = 0, reaction = 0;
  for (std::size_t m = 0; m < 3; ++m) {
    before += light.mass(MemberId(m));
    after += shared.mass(MemberId(m));
  }
  CHECK(after == Approx(before + bar).epsilon(1e-6));
  // Half a metre of seven beyond either post, and what is nearer to a post than to the beam.
  CHECK(shared.mass(MemberId(2u)) > light.mass(MemberId(2u)) + 0.8 * bar);
  CHECK(shared.mass(MemberId(0u)) == Approx(shared.mass(MemberId(1u))).epsilon(1e-3));
  for (const NodeId foot : {NodeId(0u), NodeId(3u)}) reaction += shared.reaction(foot)(2);
  CHECK(reaction == Approx(9.80665 * after).epsilon(1e-9));
  std::ofstream(folder / "bad.json") << replaced(bay_text, "BIND", "\"nearest\", \"density\": \"much\"");
  CHECK_THROWS_AS(read_model(folder / "bad.json", Purpose::demolish), InputError);
}

TEST_CASE("what is drawn over a chunk of a panel goes with it, standing or shattered") {
  for (const std::string method : {"wall_hit", "wall_hit_quadrilateral", "wall_hit_local"}) {
    for (const bool falls : {false, true}) {
      CAPTURE(method, falls);
      auto [building, scenario] = read_scenario(find_scenario(method));
      if (falls) {  // the wall falls down a storey and shatters on the ground
        scenario.ground = -4;
        scenario.events.clear();
        CutTool cut;
        cut.joints = {building.joint(PanelId(0u), 0)};
        scenario.events.push_back({0.1, cut});
      }
      scenario.debris.smallest_volume = 1e-9;
      Simulation simulation(std::move(building), std::move(scenario));
      // Plaster of 0.3 m around the wall of 6 m x 3 m x 0.2 m in the plane y = 0.
      fracture::Mesh around = fracture::prism_mesh({{0, 0}, {6, 0}, {6, 3}, {0, 3}}, {{0, 1, 2}, {0, 2, 3}}, 0.3);
      for (auto* all : {&around.positions, &around.normals})
        for (Vec3& v : *all) v = Vec3(v.x(), -v.z(), v.y());
      std::vector<DrawnMesh> meshes(1);
      meshes[0].name = "plaster";
      meshes[0].mesh = around;
      VisualMesh model(simulation.building(), std::move(meshes));
      while (!simulation.finished()) {
        simulation.step();
        model.update(simulation);
      }
      CHECK(check_pieces(model) == Approx(6 * 3 * 0.3).epsilon(1e-9));
      std::map<std::int64_t, double> followed;
      for (const VisualMesh::Piece& piece : model.pieces()) followed[piece.body.value] += piece.volume;
      std::size_t chunks = 0;
      for (const BodyView& body : simulation.bodies()) {
        if (!body.chunk) continue;
        ++chunks;
        // Half as thick again as the wall.
        CHECK(followed[body.id.value] == Approx(1.5 * fracture::audit(*body.chunk, 1e-9).volume).epsilon(1e-6));
      }
      CHECK(chunks > 3);
    }
  }
}

TEST_CASE("a visual mesh is bent with its members") {
  // A cantilever of 4 m with a load at its end, and the same with a pinned prop there.
  const auto cantilever = [](const std::string& joint, const std::string& more) {
    return parse_model(R"({"topple": 1, "title": "Arm",
 "materials": {"S": {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 1e-3}},
 "sections": {"s": {"area": 0.01, "Iy": 1e-4, "Iz": 2e-5, "J": 1e-6}},
 "joints": {"pin": {"stiffness": {"ry": 0, "rz": 0}}},
 "nodes": {"A": [0, 0, 0], "B": [4, 0, 0], "C": [4, 0, 3]},
 "members": {"AB": {"nodes": ["A", "B"], "section": "s", "material": "S", "joints": [null, )" +
                           joint + R"(]},
             "BC": {"nodes": ["B", "C"], "section": "s", "material": "S"}},
 "supports": {"A": "fixed")" +
                           more +
                           R"(}, "loads": {"dead": {"self_weight": 1.0, "nodes": {"B": {"z": -5e3, "y": 1e3}}}}})",
                       "arm.json", Purpose::demolish);
  };
  for (const bool pinned : {false, true}) {
    const Building b =
        pinned ? cantilever("\"pin\"", R"(, "C": {"rx": true, "ry": true, "rz": true})") : cantilever("null", "");
    fracture::Mesh bar = fracture::prism_mesh({{0, -0.2}, {4, -0.2}, {4, 0.2}, {0, 0.2}}, {{0, 1, 2}, {0, 2, 3}}, 0.4);
    std::vector<DrawnMesh> meshes(1);
    meshes[0].name = "bar";
    meshes[0].mesh = bar;
    meshes[0].member = MemberId(0u);
    VisualMesh model(b, std::move(meshes));
    Scenario scenario;
    scenario.standing = StandingRule::statics;
    scenario.model = "arm";
    scenario.combination = CombinationId(0u);
    Simulation simulation(b, scenario);
    const double EIy = 210e9 * 1e-4, EIz = 210e9 * 2e-5, L = 4;
    // A load P at the free end: w = P x^2 (3 L - x) / 6 EI, its slope P x (2 L - x) / 2 EI. With the moment released at
    // B and nothing else that turns there, the same: the end has no moment either way.
    for (const double x : {1.0, 2.5, 4.0}) {
      const auto shape = [&](double EI) { return x * x * (3 * L - x) / (6 * EI); };
      const auto slope = [&](double EI) { return x * (2 * L - x) / (2 * EI); };
      const std::int32_t bone = model.pieces().front().bones->front();
      CHECK(bone == 0);
      const Vec3 moved = displacement_with(b, bone, Vec3(x, 0, 0.15), bent_as(simulation.frame()));
      CHECK(moved.z() == Approx(-5e3 * shape(EIy)).epsilon(1e-3));  // the member's own weight is next to nothing
      CHECK(moved.y() == Approx(1e3 * shape(EIz)).epsilon(1e-3));
      CHECK(moved.x() == Approx(0.15 * 5e3 * slope(EIy)).epsilon(1e-3));  // above the axis, back as it droops
    }
  }
}
