// Drawn models: read, bound, cut where their parts come apart; nothing of them is lost.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>

#include "support/scratch_folder.h"
#include "test_paths.h"
#include "topple/fracture/gltf_reader.h"
#include "topple/fracture/mesh_files.h"
#include "topple/fracture/prism.h"
#include "topple/structure/drawn_model.h"
#include "topple/structure/error.h"
#include "topple/structure/files.h"

using namespace topple::structure;
namespace fracture = topple::fracture;

namespace {

double check_pieces(const DrawnModel& model) {
  double sum = 0;
  for (const DrawnModel::Piece& piece : model.pieces()) {
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
  std::ofstream(folder / "s.json") << R"({"topple": 1, "model": "bay.json", "duration": 3,
    "events": [{"at": 0.1, "cut": {"joints": ["T:1", "T:2"]}}]})";
  auto [building, scenario] = read_scenario(folder / "s.json");
  Simulation simulation(building, scenario);
  std::vector<DrawnMesh> meshes = read_drawn_meshes(simulation.building(), folder / "bay.json");
  REQUIRE(meshes.size() == 1);
  CHECK(meshes[0].name == "bar");
  // Turned from y up to z up: the bar lies around z = 4 m.
  for (const fracture::Vec3& p : meshes[0].mesh.positions) CHECK(std::abs(p.z() - 4) < 0.21);
  DrawnModel model(simulation.building(), std::move(meshes));
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
  for (const DrawnModel::Piece& piece : model.pieces()) {
    if (piece.body.value < 0) continue;
    fallen += piece.volume;
    for (const fracture::Vec3& p : piece.mesh->positions) {
      CHECK(p.x() > -1e-6);
      CHECK(p.x() < 6 + 1e-6);
    }
  }
  CHECK(fallen == Approx(6 * 0.4 * 0.6).epsilon(1e-6));
  // What is written is read again as it was: three meshes, the beam's on the ground.
  std::ofstream(folder / "out.glb", std::ios::binary) << drawn_model_glb(model, simulation);
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
  auto [building, scenario] = read_scenario(std::string(TOPPLE_SOURCE_DIR "/models/scenarios/seed_house_hit.json"));
  Simulation simulation(std::move(building), std::move(scenario));
  DrawnModel model(simulation.building(),
                   read_drawn_meshes(simulation.building(), TOPPLE_SOURCE_DIR "/models/seed_house.json"));
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
