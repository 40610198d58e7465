// Resultants of all that a plane passes, against statics done by hand, and resultants recovered at nodes of meshes.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "../example_model.h"
#include "topple/structure/analysis.h"
#include "topple/structure/formats/convert.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/formats/parse_cuts.h"

using namespace topple::structure;
namespace solver = topple::solver;

namespace {

// Sums of a few hundred forces: rounding of the largest of them.
constexpr double rounding = 1e-11;

SectionCut plane(const Vec3& at, const Vec3& normal, const Vec3& along) {
  SectionCut cut;
  cut.name = "cut";
  cut.at = at;
  cut.axes << normal.transpose(), along.transpose(), normal.cross(along).transpose();
  return cut;
}

AnalysisResult analysed(const Building& building, std::vector<SectionCut> cuts,
                        solver::SecondOrder order = solver::SecondOrder::none) {
  AnalysisRequest request;
  request.cuts = std::move(cuts);
  request.second_order = order;
  return analyse(building, request);
}

void check_close(const Vec6& found, const Vec6& wanted, double size) {
  CAPTURE(found.transpose(), wanted.transpose());
  CHECK((found - wanted).cwiseAbs().maxCoeff() <= rounding * size);
}

const std::string steel = R"("materials": {"s": {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7850}},
  "sections": {"b": {"shape": "box", "depth": 0.3, "width": 0.2, "thickness": 0.01}},)";

/// A cantilever of 5 m along x: 2 kN/m down, 7 kN down and 11 kN along x at its end.
Building cantilever() {
  return parse_model(R"({"topple": 1, )" + steel + R"("nodes": {"A": [0, 0, 0], "B": [5, 0, 0]},
    "members": {"AB": {"kind": "beam", "nodes": ["A", "B"], "section": "b", "material": "s"}}, "supports": {"A": "fixed"},
    "loads": {"p": {"nodes": {"B": {"x": 11e3, "z": -7e3}}, "members": {"AB": [{"uniform": {"z": -2e3}}]}}},
    "combinations": {"c": {"p": 1}}})",
                     "cantilever.json");
}

/// A wall 4 m wide and 6 m high in the x-z plane, fixed at its foot, meshed 5 x 7, so that no cut below lies on a line
/// of nodes: self weight, 900 N/m2 against its face, 40 kN along x in the middle of its top.
Building wall() {
  return parse_model(
      R"({"topple": 1, "gravity": 10, "materials": {"c": {"youngs_modulus": 30e9, "poisson_ratio": 0.2, "density": 2500}},
    "nodes": {"A": [0, 0, 0], "B": [4, 0, 0], "C": [4, 0, 6], "D": [0, 0, 6]},
    "panels": {"W": {"kind": "wall", "nodes": ["A", "B", "C", "D"], "thickness": 0.2, "material": "c", "model": "shell",
      "mesh": [5, 7]}},
    "supports": {"W:1": "fixed"},
    "loads": {"p": {"self_weight": 1, "panels": {"W": {"pressure": 900}}, "nodes": {"C": {"x": 20e3}, "D": {"x": 20e3}}}},
    "combinations": {"c": {"p": 1}}})",
      "wall.json");
}

}  // namespace

TEST_CASE("A cut through a beam has the shear and the moment of what hangs beyond it") {
  const double x = 1.7, rest = 5 - x;
  const AnalysisResult result = analysed(cantilever(), {plane(Vec3(x, 0, 0), Vec3::UnitX(), Vec3::UnitY()),
                                                        plane(Vec3(x, 0, 0), -Vec3::UnitX(), Vec3::UnitY())});
  Vec6 wanted;  // normal x, along y, across z
  wanted << 11e3, 0, -(7e3 + 2e3 * rest), 0, 7e3 * rest + 2e3 * rest * rest / 2, 0;
  check_close(result.combinations[0].cuts[0].force, wanted, 1e5);
  // Seen from the other side: action and reaction, in axes whose normal and third direction are turned round.
  wanted << 11e3, 0, -(7e3 + 2e3 * rest), 0, -wanted(4), 0;
  check_close(result.combinations[0].cuts[1].force, wanted, 1e5);
}

TEST_CASE("A cut through a wall has the weight, the wind and the shear of what stands above it") {
  const Building building = wall();
  for (const double z : {0.4, 2.9, 5.99}) {
    const double rest = 6 - z, weight = 0.2 * 2500 * 10 * 4 * rest;
    const AnalysisResult result = analysed(building, {plane(Vec3(2, 0, z), Vec3::UnitZ(), Vec3::UnitX())});
    // The normal of the wall is -y (x cross z): pressure acts along +y. Along x, across y.
    const double side = building.panels[0].axes(2, 1) < 0 ? 1 : -1, wind = side * 900 * 4 * rest;
    Vec6 wanted;
    wanted << -weight, 40e3, wind, 0, -wind * rest / 2, 40e3 * rest;
    CAPTURE(z);
    check_close(result.combinations[0].cuts[0].force, wanted, 1e6);
    REQUIRE(result.combinations[0].cuts[0].panels.size() == 1);
  }
}

TEST_CASE("A cut at the foot of a building balances its reactions") {
  // Posts, beams, a brace, a shell with an opening, a membrane slab, a rigid floor, springs, edges that are supported.
  const Building building = parse_model(topple::test::example_model, "example.json");
  const Vec3 at(1, 2, 0);
  const AnalysisResult result = analysed(building, {plane(at, Vec3::UnitZ(), Vec3::UnitX())});
  REQUIRE(result.combinations.size() == 2);
  for (const CombinationResult& c : result.combinations) {
    Vec6 sum = Vec6::Zero();
    const auto add = [&](const Vec3& place, const Vec6& reaction) {
      sum += reaction;
      sum.tail<3>() += (place - at).cross(Vec3(reaction.head<3>()));
    };
    for (std::size_t s = 0; s < building.supports.size(); ++s)
      add(building[building.supports[s].node].position, c.reactions[s]);
    add((building.nodes[0].position + building.nodes[2].position) / 2, c.edge_reactions[0]);
    Vec6 own;  // normal z, along x, across y
    own << -sum(2), -sum(0), -sum(1), -sum(5), -sum(3), -sum(4);
    CHECK(own.norm() > 1e5);
    // Reactions balance the loads to this much.
    check_close(c.cuts[0].force, own, 1e7);
  }
}

TEST_CASE("Cuts that slant through all kinds of parts are alike from both sides") {
  const Building building = parse_model(topple::test::example_model, "example.json");
  const Vec3 normal = Vec3(0.5, 0.3, 0.8).normalized(), along = normal.cross(Vec3::UnitY()).normalized();
  const Vec3 at(2.2, 2.6, 1.9);
  const AnalysisResult result = analysed(building, {plane(at, normal, along), plane(at, -normal, along)});
  for (const CombinationResult& c : result.combinations) {
    Vec6 turned = c.cuts[1].force;  // normal and across are turned round, action is against reaction
    turned(1) *= -1;
    turned(4) *= -1;
    check_close(c.cuts[0].force, turned, 1e7);
    CHECK(c.cuts[0].members.size() >= 4);
    CHECK(c.cuts[0].panels.size() == 2);
    CHECK(c.cuts[0].diaphragms.size() == 1);
  }
}

TEST_CASE("A rigid floor that is cut hands over half of a push to the second of two equal posts") {
  const Building building = parse_model(R"({"topple": 1, )" + steel + R"(
    "nodes": {"A": [0, 0, 0], "B": [6, 0, 0], "C": [0, 0, 3], "D": [6, 0, 3]},
    "members": {"AC": {"kind": "post", "nodes": ["A", "C"], "section": "b", "material": "s"},
                "BD": {"kind": "post", "nodes": ["B", "D"], "section": "b", "material": "s"}},
    "supports": {"A": "fixed", "B": "fixed"}, "diaphragms": {"floor": ["C", "D"]},
    "loads": {"p": {"nodes": {"C": {"x": 8e3}}}}, "combinations": {"c": {"p": 1}}})",
                                        "floor.json");
  const AnalysisResult result = analysed(building, {plane(Vec3(3, 0, 3), Vec3::UnitX(), Vec3::UnitY())});
  Vec6 wanted = Vec6::Zero();
  wanted(0) = -4e3;  // the second post holds back half of it
  check_close(result.combinations[0].cuts[0].force, wanted, 8e3);
  CHECK(result.combinations[0].cuts[0].diaphragms.size() == 1);
  CHECK(result.combinations[0].cuts[0].members.empty());
}

TEST_CASE("In second order the moment of a cut has the load's shift in it") {
  const Building building = parse_model(R"({"topple": 1, )" + steel + R"("nodes": {"A": [0, 0, 0], "B": [0, 0, 8]},
    "members": {"AB": {"kind": "post", "nodes": ["A", "B"], "section": "b", "material": "s"}}, "supports": {"A": "fixed"},
    "loads": {"p": {"nodes": {"B": {"z": -300e3, "x": 5e3}}}}, "combinations": {"c": {"p": 1}}})",
                                        "post.json");
  const Vec3 at(0, 0, 3);
  const AnalysisResult result =
      analysed(building, {plane(at, Vec3::UnitZ(), Vec3::UnitX()), plane(at, -Vec3::UnitZ(), Vec3::UnitX())},
               solver::SecondOrder::exact);
  const CombinationResult& c = result.combinations[0];
  const double shift = c.displacements[1].x();
  CHECK(shift > 0.04);
  Vec6 wanted;  // about the cut's point, at rest on the axis: H h + P d
  wanted << -300e3, 5e3, 0, 0, 0, 5e3 * 5 + 300e3 * shift;
  // The iteration of the axial force ends at 1e-12 of itself.
  check_close(c.cuts[0].force, wanted, 1e7);
  // From above the free body is that of the top, which has sunk: H times that is beyond the theory.
  CHECK(std::abs(c.cuts[1].force(5)) == Approx(wanted(5)).epsilon(2e-4));
}

TEST_CASE("Resultants at the nodes of a mesh are those of a heavy wall and of a bent plate") {
  // A standing wall under its own weight alone: -gamma t (h - z) along its height, linear, and nothing else.
  const Building standing = parse_model(
      R"({"topple": 1, "gravity": 10, "materials": {"c": {"youngs_modulus": 30e9, "poisson_ratio": 0, "density": 2500}},
    "nodes": {"A": [0, 0, 0], "B": [4, 0, 0], "C": [4, 0, 6], "D": [0, 0, 6]},
    "panels": {"P": {"kind": "wall", "nodes": ["A", "B", "C", "D"], "thickness": 0.1, "material": "c", "model": "shell", "mesh": [4, 6]}},
    "supports": {"P:1": "fixed"}, "loads": {"p": {"self_weight": 1}}, "combinations": {"c": {"p": 1}}})",
      "standing.json");
  const AnalysisResult heavy = analyse(standing);
  REQUIRE(heavy.combinations[0].panels[0].nodes.size() == 35);
  const auto place_of = [](const Building& of, const AnalysisResult& result, int node) {
    const auto n = static_cast<std::size_t>(node);
    return n < of.nodes.size() ? of.nodes[n].position : result.mesh_nodes[n - of.nodes.size()];
  };
  for (const PanelNode& node : heavy.combinations[0].panels[0].nodes) {
    const double above = 6 - place_of(standing, heavy, node.node).z();
    // Elements represent it exactly: what is left is rounding of 15 kN/m.
    CHECK(std::abs(node.membrane[1] + 2500 * 10 * 0.1 * above) < 1e-7);
    CHECK(std::abs(node.membrane[0]) + std::abs(node.membrane[2]) + std::abs(node.moments[0]) < 1e-7);
  }
  // A square plate on four pinned edges under q: m = 0.0479 q a2 at its middle, 0 at the middle of an edge across it
  // (Timoshenko and Woinowsky-Krieger, table 8, nu = 0.3). The shape of a mesh of 16 costs about 1 %.
  const Building plate = parse_model(
      R"({"topple": 1, "materials": {"c": {"youngs_modulus": 30e9, "poisson_ratio": 0.3, "density": 0}},
    "nodes": {"A": [0, 0, 0], "B": [4, 0, 0], "C": [4, 4, 0], "D": [0, 4, 0]},
    "panels": {"P": {"kind": "slab", "nodes": ["A", "B", "C", "D"], "thickness": 0.1, "material": "c", "model": "shell", "mesh": 16}},
    "supports": {"P:1": {"x": true, "y": true, "z": true}, "P:2": {"z": true}, "P:3": {"z": true}, "P:4": {"z": true}},
    "loads": {"p": {"panels": {"P": {"pressure": 1000}}}}, "combinations": {"c": {"p": 1}}})",
      "plate.json");
  const AnalysisResult bent = analyse(plate);
  const double qa2 = 1000 * 16;
  int seen = 0;
  for (const PanelNode& node : bent.combinations[0].panels[0].nodes) {
    const Vec3 place = place_of(plate, bent, node.node);
    if ((place - Vec3(2, 2, 0)).norm() < 1e-9) {
      ++seen;
      for (const std::size_t i : {0U, 1U}) CHECK(std::abs(node.moments[i]) == Approx(0.0479 * qa2).epsilon(0.01));
    }
    if ((place - Vec3(2, 0, 0)).norm() < 1e-9) {
      ++seen;
      CHECK(std::abs(node.moments[1]) < 0.002 * qa2);
    }
  }
  CHECK(seen == 2);
}

TEST_CASE("Cuts of a file have their place, axes and parts, and what is wrong is told") {
  const Building building = parse_model(topple::test::example_model, "example.json");
  const auto file = std::filesystem::temp_directory_path() / "topple_section_cuts.json";
  const auto read = [&](const std::string& cut) {
    std::ofstream(file) << R"({"cuts": {"k": )" << cut << "}}";
    return read_section_cuts(file.string(), building);
  };
  const SectionCut cut = read(R"({"at": [1, 2, 3], "normal": [0, 0, 5], "parts": ["P*", "west", "W1"]})").at(0);
  CHECK(cut.at == Vec3(1, 2, 3));
  Mat3 wanted;
  wanted << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  CHECK((cut.axes - wanted).norm() < 1e-15);
  CHECK(cut.members.size() == 4);
  CHECK(cut.panels.size() == 1);
  const SectionCut upright = read(R"({"at": [0, 0, 0], "normal": [0, -1, 0]})").at(0);
  CHECK(upright.everything);
  CHECK(upright.axes.row(1).isApprox(Vec3::UnitX().transpose()));
  CHECK_THROWS_WITH(read(R"({"at": [0, 0, 0], "normal": [0, 0, 0]})"), Catch::Contains("cuts.k.normal"));
  CHECK_THROWS_WITH(read(R"({"at": [0, 0, 0], "normal": [0, 0, 1], "along": [0, 0, 1]})"), Catch::Contains("along"));
  CHECK_THROWS_WITH(read(R"({"at": [0, 0, 0], "normal": [0, 0, 1], "parts": ["W11"]})"),
                    Catch::Contains("no member, panel or group W11 (did you mean W1?)"));
  CHECK_THROWS_WITH(read(R"({"at": [0, 0, 0], "normal": [0, 0, 1], "part": []})"), Catch::Contains("part"));
  std::filesystem::remove(file);
}

TEST_CASE("A model has cuts of its own, tables hold them, and a divided member counts whole") {
  const std::string frame = R"({"topple": 1,
    "materials": {"s": {"youngs_modulus": 210e9, "poisson_ratio": 0.3}},
    "sections": {"c": {"area": 0.01, "Iy": 1e-4, "Iz": 1e-4, "J": 1e-4}},
    "nodes": {"A": [0, 0, 0], "B": [0, 0, 4], "M": [0, 0, 1], "N": [3, 0, 1]},
    "members": {"P": {"kind": "post", "nodes": ["A", "B"], "section": "c", "material": "s"},
                "arm": {"nodes": ["M", "N"], "section": "c", "material": "s"}},
    "supports": {"A": "fixed"}, "loads": {"p": {"nodes": {"B": {"x": 7, "z": -5}}}}, "combinations": {"c": {"p": 1}},
    "connect": true,
    "cuts": {"high": {"at": [0, 0, 3], "normal": [0, 0, 1], "parts": ["P"]},
             "slanted": {"at": [0, 0, 0.5], "normal": [0, 0, 1], "along": [0, 1, 0]}}})";
  const Building building = parse_model(frame, "frame.json");
  AnalysisRequest request;
  request.cuts = parse_model_cuts(frame, "frame.json", building);
  REQUIRE(request.cuts.size() == 2);
  CHECK(request.cuts[0].members.size() == 2);  // P and its piece P/2, which is the one that is cut
  const AnalysisResult result = analyse(building, request);
  const Vec6 high = result.combinations[0].cuts[0].force, slanted = result.combinations[0].cuts[1].force;
  CHECK(high[0] == Approx(-5));
  CHECK(high[1] == Approx(7));
  CHECK(high[5] == Approx(7 * (4 - 3)));
  CHECK(slanted[1] == Approx(0).margin(1e-9));
  CHECK(std::abs(slanted[2]) == Approx(7));
  std::string none = frame;
  none.replace(none.find("\"cuts\""), 6, "\"cats\"");
  CHECK_THROWS_WITH(parse_model(none, "frame.json"), Catch::Contains("cats"));
  std::string wrong = frame;
  wrong.replace(wrong.find("[\"P\"]"), 5, "[\"Q\"]");
  CHECK_THROWS_WITH(parse_model(wrong, "frame.json"), Catch::Contains("cuts.high.parts") && Catch::Contains("Q"));
  // Through tables and back.
  const auto folder = std::filesystem::temp_directory_path() / "topple_model_cuts";
  std::filesystem::create_directories(folder);
  std::string plain = frame;
  plain.replace(plain.find("\"connect\": true,"), 16, "");
  std::ofstream(folder / "frame.json") << plain;
  std::filesystem::create_directories(folder / "tables");
  for (const auto& [name, text] : convert_model(folder / "frame.json", ModelForm::tables).files)
    std::ofstream(folder / "tables" / name) << text;
  const Building back = read_model(folder / "tables");
  const std::vector<SectionCut> cuts = read_model_cuts(folder / "tables", back);
  REQUIRE(cuts.size() == 2);
  CHECK(cuts[0].name == "high");
  CHECK(cuts[0].members.size() == 1);
  CHECK(cuts[1].axes == request.cuts[1].axes);
  CHECK(read_model_cuts(folder / "frame.json", back).size() == 2);
  std::filesystem::remove_all(folder);
}
