// Shell panels of a model: their meshes, what they share with members and neighbours, loads, supports and results.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "structure/example_model.h"
#include "topple/structure/analysis.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/frame.h"

using namespace topple;
using namespace topple::structure;
using Json = nlohmann::json;

namespace {

const char* const properties = R"("materials": {"c": {"youngs_modulus": 30e9, "poisson_ratio": 0.2, "density": 2500,
    "thermal_expansion": 1e-5}},
  "sections": {"s": {"area": 0.06, "Iy": 4e-4, "Iz": 2e-4, "J": 3e-4, "shear_area_y": 0.05, "shear_area_z": 0.05}},)";

Building model(const std::string& rest) {
  return parse_model("{\"topple\": 1, " + std::string(properties) + rest + "}", "model.json");
}

Json answer(const Building& building, int stations = 0, solver::SecondOrder second_order = solver::SecondOrder::none) {
  AnalysisRequest request;
  request.second_order = second_order;
  request.stations = stations;
  return Json::parse(results_json(building, request, analyse(building, request), {})).at("combinations").at("case");
}

double area(const solver::FrameModel& model, const solver::Shell& shell) {
  const auto at = [&](std::size_t i) -> const Vec3& { return model.nodes[static_cast<std::size_t>(shell.node[i])]; };
  return 0.5 * (at(2) - at(0)).cross(at(3) - at(1)).norm();
}

/// Sides of elements that no other element has: the mesh's border.
double border(const Frame& frame) {
  std::map<std::pair<int, int>, int> sides;
  for (const solver::Shell& shell : frame.model.shells)
    for (std::size_t i = 0; i < 4; ++i) {
      const int a = shell.node[i], b = shell.node[(i + 1) % 4];
      ++sides[{std::min(a, b), std::max(a, b)}];
    }
  double length = 0;
  for (const auto& [side, count] : sides) {
    CHECK(count <= 2);
    if (count == 1)
      length += (frame.model.nodes[static_cast<std::size_t>(side.first)] -
                 frame.model.nodes[static_cast<std::size_t>(side.second)])
                    .norm();
  }
  return length;
}

double total_area(const Frame& frame) {
  double sum = 0;
  for (const solver::Shell& shell : frame.model.shells) sum += area(frame.model, shell);
  return sum;
}

/// A wall of 6 m by 3 m between two posts under a beam; its text with the members and panels given.
std::string wall(const std::string& nodes, const std::string& parts) {
  return R"("nodes": {"A": [0, 0, 0], "B": [6, 0, 0], "C": [6, 0, 3], "D": [0, 0, 3])" + nodes + "}," + parts +
         R"(, "supports": {"A": "fixed", "B": "pinned"},
         "loads": {"case": {"self_weight": 1, "nodes": {"D": {"x": 3e4, "y": 2e3}}}})";
}

}  // namespace

TEST_CASE("a meshed wall and its edge members answer as the same wall drawn element by element") {
  const Building meshed = model(wall("", R"("members": {
    "left": {"kind": "post", "nodes": ["A", "D"], "section": "s", "material": "c"},
    "top": {"nodes": ["D", "C"], "section": "s", "material": "c"}},
    "panels": {"W": {"kind": "wall", "nodes": ["A", "B", "C", "D"], "thickness": 0.15, "material": "c", "model": "shell",
                     "mesh": [3, 2]}})"));
  // The same by hand: nodes P-i-j on a grid of 2 m by 1.5 m.
  const auto name = [](int i, int j) {
    if (j == 0 && i == 0) return std::string("A");
    if (j == 0 && i == 3) return std::string("B");
    if (j == 2 && i == 3) return std::string("C");
    if (j == 2 && i == 0) return std::string("D");
    return "P" + std::to_string(i) + std::to_string(j);
  };
  std::string nodes, panels, top;
  for (int j = 0; j <= 2; ++j)
    for (int i = 0; i <= 3; ++i)
      if (name(i, j)[0] == 'P')
        nodes += ", \"" + name(i, j) + "\": [" + std::to_string(2 * i) + ", 0, " + std::to_string(1.5 * j) + "]";
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 3; ++i)
      panels += std::string(panels.empty() ? "" : ", ") + "\"W" + std::to_string(i) + std::to_string(j) +
                R"(": {"kind": "wall", "thickness": 0.15, "material": "c", "model": "shell", "mesh": 1, "nodes": [")" +
                name(i, j) + "\", \"" + name(i + 1, j) + "\", \"" + name(i + 1, j + 1) + "\", \"" + name(i, j + 1) +
                "\"]}";
  const auto beam = [](const std::string& id, const std::string& a, const std::string& b) {
    return "\"" + id + R"(": {"nodes": [")" + a + "\", \"" + b + R"("], "section": "s", "material": "c"})";
  };
  const Building drawn =
      model(wall(nodes, "\"members\": {" + beam("left1", "A", "P01") + "," + beam("left2", "P01", "D") + "," +
                            beam("top1", "D", "P12") + "," + beam("top2", "P12", "P22") + "," +
                            beam("top3", "P22", "C") + "}, \"panels\": {" + panels + "}"));
  const auto order = GENERATE(solver::SecondOrder::none, solver::SecondOrder::exact);
  const Json a = answer(meshed, 6, order), b = answer(drawn, 2, order);
  // The same matrix in another order: rounding, grown by the condition of a wall that bends out of its plane.
  for (const char* node : {"B", "C", "D"})
    for (std::size_t c = 0; c < 6; ++c)
      CHECK(a.at("displacements").at(node)[c].get<double>() ==
            Approx(b.at("displacements").at(node)[c].get<double>()).epsilon(1e-8).margin(1e-14));
  const Json &whole = a.at("members").at("top"), &first = b.at("members").at("top1"),
             &last = b.at("members").at("top3");
  for (std::size_t c = 0; c < 6; ++c) {
    CHECK(whole.at("end_forces")[c].get<double>() ==
          Approx(first.at("end_forces")[c].get<double>()).epsilon(1e-8).margin(1e-6));
    CHECK(whole.at("end_forces")[6 + c].get<double>() ==
          Approx(last.at("end_forces")[6 + c].get<double>()).epsilon(1e-8).margin(1e-6));
  }
  // Station 1 of 6 on the whole beam is station 1 of 2 on its first third.
  for (const char* quantity : {"axial", "shear_z", "moment_y", "moment_z", "torsion"})
    CHECK(whole.at("stations").at(quantity)[1].get<double>() ==
          Approx(first.at("stations").at(quantity)[1].get<double>()).epsilon(1e-8).margin(1e-6));
  // Deflections from the chord of the whole beam: straight between its ends, so zero there, and bent as the nodes say.
  const auto moved = [&](const char* node, std::size_t c) { return b.at("displacements").at(node)[c].get<double>(); };
  CHECK(whole.at("stations").at("deflection_z")[2].get<double>() ==
        Approx(moved("P12", 2) - (2 * moved("D", 2) + moved("C", 2)) / 3).epsilon(1e-7).margin(1e-13));
  CHECK(whole.at("stations").at("deflection_z")[6].get<double>() == Approx(0).margin(1e-15));
  const Json& bend = whole.at("extremes").at("deflection_z");
  for (const Json& station : whole.at("stations").at("deflection_z")) {
    CHECK(station.get<double>() <= bend.at("max")[0].get<double>() + 1e-15);
    CHECK(station.get<double>() >= bend.at("min")[0].get<double>() - 1e-15);
  }
  CHECK(a.at("panels").at("W").at("elements").size() == 6);
  CHECK(a.at("panels").at("W").at("elements")[0].at("membrane")[1].get<double>() ==
        Approx(b.at("panels").at("W00").at("membrane")[1].get<double>()).epsilon(1e-8));
  CHECK(a.at("equilibrium_error").get<double>() < 1e-10);
}

TEST_CASE("a member with rigid offsets rides on the mesh by arms, and its joint's release stays at its end") {
  const Building b = model(R"("nodes": {"A": [0, 0, 0], "B": [4, 0, 0], "C": [4, 2, 0], "D": [0, 2, 0]},
    "joints": {"pin": {"stiffness": {"ry": 0}}},
    "members": {"rib": {"nodes": ["A", "B"], "section": "s", "material": "c", "joints": [null, "pin"],
                        "offsets": [[0, 0, -0.3], [0, 0, -0.3]]}},
    "panels": {"S": {"nodes": ["A", "B", "C", "D"], "thickness": 0.1, "material": "c", "model": "shell", "mesh": [4, 2]}},
    "supports": {"A": "fixed", "B": {"z": true}, "D": "fixed"},
    "loads": {"case": {"panels": {"S": {"pressure": 2000}}}})");
  const Frame frame = make_frame(b);
  REQUIRE(frame.pieces[0].size() == 4);
  for (const MemberPiece& piece : frame.pieces[0]) {
    const solver::Beam& beam = frame.model.beams[static_cast<std::size_t>(piece.beam)];
    CHECK(beam.length == Approx(1));
    CHECK(beam.offset[0].z() == Approx(-0.3));
    CHECK(beam.end_stiffness[0].array().isInf().all());
  }
  const Json c = answer(b);
  const Json& end = c.at("members").at("rib").at("end_forces");
  CHECK(std::abs(end[10].get<double>()) < 1e-9 * std::abs(end[4].get<double>()));
  CHECK(c.at("equilibrium_error").get<double>() < 1e-10);
}

TEST_CASE("meshes of neighbours match, lines go through openings and nodes on edges, and what is cut out is gone") {
  const std::string nodes = R"("nodes": {"A": [0, 0, 0], "B": [5, 0, 0], "C": [5, 4, 0], "D": [0, 4, 0],
    "E": [9, 0, 0], "F": [9, 1.7, 0], "G": [5, 1.7, 0], "H": [9, 4, 0], "top": [0, 4, 3], "end": [5, 4, 3]},)";
  const std::string supports = R"(, "supports": {"A": "fixed"})";
  const auto panels = [&](const std::string& openings) {
    return model(nodes + R"("panels": {
      "S": {"nodes": ["A", "B", "C", "D"], "thickness": 0.2, "material": "c", "model": "shell", "mesh": [4, 3])" +
                 openings + R"(},
      "T": {"nodes": ["B", "E", "F", "G"], "thickness": 0.2, "material": "c", "model": "shell", "mesh": [2, 5]},
      "U": {"nodes": ["G", "F", "H", "C"], "thickness": 0.2, "material": "c", "model": "shell", "mesh": [3, 1]},
      "W": {"kind": "wall", "nodes": ["D", "C", "end", "top"], "thickness": 0.2, "material": "c", "model": "shell",
            "mesh": [7, 2]}})" +
                 supports);
  };
  const double whole = 5 * 4 + 4 * 4 + 5 * 3, around = 9 + 4 + 4 + 4 + 3 + 5 + 3;
  SECTION("without openings") {
    const Frame frame = make_frame(panels(""));
    CHECK(total_area(frame) == Approx(whole).epsilon(1e-12));
    CHECK(border(frame) == Approx(around).epsilon(1e-12));
  }
  SECTION("a rectangle, its sides on mesh lines") {
    const Frame frame = make_frame(panels(R"(, "openings": [[[1, 1], [2.2, 1], [2.2, 2.1], [1, 2.1]]])"));
    CHECK(total_area(frame) == Approx(whole - 1.2 * 1.1).epsilon(1e-12));
    CHECK(border(frame) == Approx(around + 2 * (1.2 + 1.1)).epsilon(1e-12));
  }
  SECTION("a door at the edge") {
    const Frame frame = make_frame(panels(R"(, "openings": [[[1, 0], [2, 0], [2, 2.1], [1, 2.1]]])"));
    CHECK(total_area(frame) == Approx(whole - 2.1).epsilon(1e-12));
    CHECK(border(frame) == Approx(around + 2 * 2.1).epsilon(1e-12));
  }
  SECTION("slanted sides, cut into quadrilaterals") {
    const Frame frame = make_frame(panels(R"(, "openings": [[[1, 1], [3, 1.5], [2, 3.2]]])"));
    const auto side = [](double x, double y) { return std::hypot(x, y); };
    const double hole = 0.5 * std::abs((3 - 1) * (3.2 - 1) - (2 - 1) * (1.5 - 1));
    CHECK(total_area(frame) == Approx(whole - hole).epsilon(1e-9));
    CHECK(border(frame) == Approx(around + side(2, 0.5) + side(1, 1.7) + side(1, 2.2)).epsilon(1e-9));
  }
}

TEST_CASE("panels and members that only lie at the same place are not joined") {
  // A wall under a beam and beside a wall on the same line, without a common node; and one that shares a node.
  const std::string nodes = R"("nodes": {"A": [0, 0, 0], "B": [4, 0, 0], "C": [4, 0, 3], "D": [0, 0, 3],
    "E": [1, 0, 3], "F": [3, 0, 3], "G": [3, 0, 5], "H": [1, 0, 5]}, "supports": {"A": "fixed", "E": "fixed"},)";
  const std::string lower =
      R"("W": {"nodes": ["A", "B", "C", "D"], "thickness": 0.2, "material": "c", "model": "shell", "mesh": 1})";
  const Frame apart = make_frame(model(nodes +
                                       R"("members": {"b": {"nodes": ["E", "F"], "section": "s", "material": "c"}},
    "panels": {)" + lower + R"(, "V": {"nodes": ["E", "F", "G", "H"], "thickness": 0.2, "material": "c",
    "model": "shell", "mesh": [3, 1]}})"));
  CHECK(apart.model.shells.size() == 1 + 3);
  CHECK(apart.pieces[0].size() == 3);
  const Frame joined = make_frame(model(nodes +
                                        R"("members": {"b": {"nodes": ["D", "E"], "section": "s", "material": "c"}},
    "panels": {)" + lower + "}"));
  CHECK(joined.model.shells.size() == 2);
  CHECK(joined.model.shells[0].node[2] == 4);  // E
}

TEST_CASE("openings that overlap are cut out together") {
  const Frame frame = make_frame(
      model(R"("nodes": {"A": [0, 0, 0], "B": [4, 0, 0], "C": [4, 4, 0], "D": [0, 4, 0]}, "supports": {"A": "fixed"},
      "panels": {"S": {"nodes": ["A", "B", "C", "D"], "thickness": 0.2, "material": "c", "model": "shell", "mesh": 1, "openings":
        [[[1, 1], [2, 1], [3, 3], [2, 3]], [[1, 1.8], [3.2, 1.8], [3.2, 2.2], [1, 2.2]]]}})"));
  CHECK(total_area(frame) == Approx(16 - (2 + 0.4 * 2.2 - 0.4)).epsilon(1e-9));
  CHECK(border(frame) > 16);  // and no side has more than two elements
}

TEST_CASE("openings that leave nothing are refused by name") {
  const auto with = [&](const std::string& openings) {
    return model(
        R"("nodes": {"A": [0, 0, 0], "B": [4, 0, 0], "C": [4, 4, 0], "D": [0, 4, 0]}, "supports": {"A": "fixed"},
      "panels": {"S": {"nodes": ["A", "B", "C", "D"], "thickness": 0.2, "material": "c", "model": "shell", "mesh": 1,
                       "openings": )" +
        openings + "}}");
  };
  CHECK_THROWS_WITH(make_frame(with("[[[0, 0], [4, 0], [4, 4], [0, 4]]]")), Catch::Contains("panels.S.openings"));
}

TEST_CASE("a cantilever wall under its own weight and pressure bears them at its foot, edge support and joint alike") {
  const Building b = model(R"("joints": {"edge": {"capacity_per_length": {"compression": 1e6, "moment_y": 5e4,
      "shear_z": 1e6}}}, "nodes": {"A": [0, 0, 0], "B": [6, 0, 0], "C": [6, 0, 3], "D": [0, 0, 3]},
    "panels": {"W": {"kind": "wall", "nodes": ["A", "B", "C", "D"], "thickness": 0.2, "material": "c", "model": "shell",
                     "mesh": [12, 24], "joint": "edge"}},
    "supports": {"W:1": "fixed"},
    "loads": {"case": {"self_weight": 1, "panels": {"W": {"pressure": 1000}}}})");
  const Json c = answer(b);
  const Json& r = c.at("reactions").at("W:1");
  // The normal of A, B, C, D is -y, so the pressure acts along +y.
  CHECK(r[1].get<double>() == Approx(-18000.0).epsilon(1e-9));
  CHECK(r[2].get<double>() == Approx(2500 * 0.2 * 18 * 9.80665).epsilon(1e-9));
  CHECK(r[3].get<double>() == Approx(18000.0 * 1.5).epsilon(1e-9));
  // Per length 4500 N m of 5e4; half an element up the joint's element sees (1 - 1/48)^2 of it or more.
  const Json& joint = c.at("joints").at("W:1");
  CHECK(joint.at("governing") == "moment_y");
  CHECK(joint.at("utilisation").get<double>() == Approx(0.09).epsilon(0.05));
  CHECK(c.at("joints").at("W:3").at("utilisation").get<double>() < 0.001);
}

TEST_CASE("a free shell grows with temperature and stays without stress") {
  const Building b = model(R"("nodes": {"A": [0, 0, 0], "B": [4, 1, 0], "C": [5, 4, 0], "D": [-1, 3, 0]},
    "panels": {"S": {"nodes": ["A", "B", "C", "D"], "thickness": 0.2, "material": "c", "model": "shell", "mesh": [3, 4],
                     "openings": [[[1.5, 1], [2.5, 1.2], [2, 2]]]}},
    "supports": {"A": "fixed"}, "loads": {"case": {"panels": {"S": {"temperature": 40}}}})");
  const Json c = answer(b);
  CHECK(c.at("displacements").at("C")[0].get<double>() == Approx(4e-4 * 5).epsilon(1e-9));
  CHECK(c.at("displacements").at("C")[1].get<double>() == Approx(4e-4 * 4).epsilon(1e-9));
  const double blocked = 30e9 * 0.2 * 4e-4;  // the force per length that held ends would bear, and more
  for (const Json& element : c.at("panels").at("S").at("elements"))
    for (const Json& force : element.at("membrane")) CHECK(std::abs(force.get<double>()) < 1e-9 * blocked);
}

TEST_CASE("the format's own example, with a wall of shells, is analysed and in equilibrium") {
  const AnalysisResult result = analyse(parse_model(test::example_model, "example.json"));
  REQUIRE(result.combinations.size() == 2);
  for (const CombinationResult& combination : result.combinations) {
    CHECK(combination.equilibrium_error < 1e-9);
    CHECK(combination.quality.backward_error <= 1e-14);
    CHECK(combination.panels[1].elements.size() > 12);  // 4 x 3, and lines at the door's sides
  }
}

TEST_CASE("a shell that nothing holds across its plane names the nodes that move") {
  const Building b = model(R"("nodes": {"A": [0, 0, 0], "B": [4, 0, 0], "C": [4, 4, 0], "D": [0, 4, 0]},
    "panels": {"S": {"nodes": ["A", "B", "C", "D"], "thickness": 0.2, "material": "c", "model": "shell", "mesh": 2}},
    "supports": {"A": "pinned", "B": "pinned"}, "loads": {"case": {"self_weight": 1}})");
  CHECK_THROWS_WITH(analyse(b), Catch::Contains("node C") && Catch::Contains("unstable"));
}

TEST_CASE("ParaView files draw every element of a shell's mesh") {
  const Building b = model(R"("nodes": {"A": [0, 0, 0], "B": [4, 0, 0], "C": [4, 4, 0], "D": [0, 4, 0]},
    "panels": {"S": {"nodes": ["A", "B", "C", "D"], "thickness": 0.2, "material": "c", "model": "shell", "mesh": [3, 2]}},
    "supports": {"S:1": "fixed"}, "loads": {"case": {"self_weight": 1}})");
  const NamedTexts files = results_vtu(b, analyse(b));
  REQUIRE(files.size() == 1);
  CHECK(files[0].second.find("NumberOfPoints=\"24\" NumberOfCells=\"6\"") != std::string::npos);
  CHECK(files[0].second.find("Name=\"moments\"") != std::string::npos);
}
