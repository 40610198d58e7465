// Static analysis of buildings end to end: closed forms, OpenSees' answers, equilibrium, shipped models, instability.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "support/shared_data.h"
#include "topple/structure/analysis.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"

using namespace topple::structure;
using Json = nlohmann::json;

namespace {

/// A cantilever along a skew axis with three different inertias, all supports and loads given by the caller.
std::string cantilever(const std::string& supports, const std::string& loads, const std::string& units = "") {
  return R"({"topple": 1, )" + units + R"(
    "materials": {"steel": {"youngs_modulus": 2e11, "shear_modulus": 8e10, "density": 7850}},
    "sections": {"s": {"area": 0.01, "Iy": 2e-4, "Iz": 3e-5, "J": 5e-6, "shear_area_y": 0.004, "shear_area_z": 0.006}},
    "nodes": {"A": [0, 0, 0], "B": [4, 0, 0]},
    "members": {"M": {"nodes": ["A", "B"], "section": "s", "material": "steel"}},
    "supports": )" +
         supports + R"(, "loads": )" + loads + "}";
}

Json results(const Building& building, const AnalysisRequest& request = {}) {
  return Json::parse(results_json(building, request, analyse(building, request), {}));
}

}  // namespace

TEST_CASE("a cantilever bends and shears as closed form says, each axis by its own stiffness") {
  const Building b =
      parse_model(cantilever(R"({"A": "fixed"})", R"({"case": {"nodes": {"B": {"y": 1000, "z": -2000}}}})"), "c.json");
  const Json c = results(b).at("combinations").at("case");
  const double L = 4, EIy = 2e11 * 2e-4, EIz = 2e11 * 3e-5, GAy = 8e10 * 0.004, GAz = 8e10 * 0.006;
  const Json& tip = c.at("displacements").at("B");
  CHECK(tip[1].get<double>() == Approx(1000 * (L * L * L / (3 * EIz) + L / GAy)).epsilon(1e-10));
  CHECK(tip[2].get<double>() == Approx(-2000 * (L * L * L / (3 * EIy) + L / GAz)).epsilon(1e-10));
  const Json& end = c.at("members").at("M").at("end_forces");
  CHECK(end[2].get<double>() == Approx(2000).epsilon(1e-10));
  CHECK(end[4].get<double>() == Approx(-8000).epsilon(1e-10));  // about y: node holds the moment of a load downwards
  CHECK(c.at("members").at("M").at("extremes").at("shear_z").at("max")[0].get<double>() ==
        Approx(-2000).epsilon(1e-10));
  CHECK(c.at("reactions").at("A")[5].get<double>() == Approx(-4000).epsilon(1e-10));
}

TEST_CASE("a fixed beam's moments and stations under uniform load are those of the textbook") {
  const Building b = parse_model(
      cantilever(R"({"A": "fixed", "B": "fixed"})", R"({"q": {"members": {"M": [{"uniform": {"z": -6000}}]}}})"),
      "c.json");
  AnalysisRequest request;
  request.stations = 4;
  const Json m = results(b, request).at("combinations").at("q").at("members").at("M");
  const Json& moments = m.at("stations").at("moment_y");
  REQUIRE(moments.size() == 5);
  CHECK(std::abs(moments[0].get<double>()) == Approx(6000.0 * 16 / 12).epsilon(1e-10));
  CHECK(std::abs(moments[2].get<double>()) == Approx(6000.0 * 16 / 24).epsilon(1e-10));
  CHECK(moments[0].get<double>() * moments[2].get<double>() < 0);
  CHECK(m.at("stations").at("at")[1].get<double>() == 1.0);
}

TEST_CASE("results come back in the units of the file") {
  const std::string text = R"({"topple": 1, "units": {"length": "mm", "force": "kN", "mass": "kg"},
    "materials": {"steel": {"youngs_modulus": 200, "shear_modulus": 80}},
    "sections": {"s": {"area": 10000, "Iy": 2e8, "Iz": 3e7, "J": 5e6}},
    "nodes": {"A": [0, 0, 0], "B": [4000, 0, 0]},
    "members": {"M": {"nodes": ["A", "B"], "section": "s", "material": "steel"}},
    "supports": {"A": "fixed"}, "loads": {"case": {"nodes": {"B": {"z": -2}}}}})";
  const Json r = results(parse_model(text, "mm.json"));
  CHECK(r.at("units").at("length") == "mm");
  const Json& c = r.at("combinations").at("case");
  CHECK(c.at("displacements").at("B")[2].get<double>() ==
        Approx(-2 * std::pow(4000.0, 3) / (3 * 200 * 2e8)).epsilon(1e-10));
  CHECK(c.at("reactions").at("A")[4].get<double>() == Approx(-8000).epsilon(1e-10));
}

TEST_CASE("shipped models stand with a margin, in equilibrium, solved to rounding") {
  for (const char* name : {"seed_building", "seed_shear_walls", "tower", "la3"}) {
    INFO(name);
    const Building b = read_model(find_model(name));
    const AnalysisResult result = analyse(b);
    for (const CombinationResult& c : result.combinations) {
      CHECK(c.equilibrium_error < 1e-10);
      CHECK((c.total_load + c.total_reaction).head<3>().norm() < 1e-10 * c.total_load.norm());
      CHECK(c.quality.backward_error < 1e-14);
      double worst = 0;
      for (const Utilisation& used : c.joints) worst = std::max(worst, used.value);
      CHECK(worst > 0.2);
      CHECK(worst < 0.8);
    }
  }
}

TEST_CASE("combinations added up from fewer cases are each as it is alone, along members and against reactions too") {
  const Building b = parse_model(R"({"topple": 1,
    "materials": {"s": {"youngs_modulus": 2e11, "poisson_ratio": 0.3, "density": 7850, "thermal_expansion": 1.2e-5}},
    "sections": {"s": {"area": 0.01, "Iy": 2e-4, "Iz": 3e-5, "J": 5e-6, "shear_area_y": 0.004, "shear_area_z": 0.006}},
    "joints": {"j": {"stiffness": {"ry": 6e6}, "capacity": {"tension": 1e6, "moment_y": 5e5}},
               "e": {"capacity_per_length": {"shear_z": 1e6, "tension": 1e6}}},
    "nodes": {"A0": [0, 0, 0], "B0": [6, 0, 0], "C0": [6, 5, 0], "D0": [0, 5, 0],
              "A": [0, 0, 3], "B": [6, 0, 3], "C": [6, 5, 3], "D": [0, 5, 3]},
    "members": {"PA": {"kind": "post", "nodes": ["A0", "A"], "section": "s", "material": "s"},
      "PB": {"kind": "post", "nodes": ["B0", "B"], "section": "s", "material": "s"},
      "PC": {"kind": "post", "nodes": ["C0", "C"], "section": "s", "material": "s"},
      "PD": {"kind": "post", "nodes": ["D0", "D"], "section": "s", "material": "s"},
      "AB": {"nodes": ["A", "B"], "section": "s", "material": "s", "joints": ["j", null]},
      "BC": {"nodes": ["B", "C"], "section": "s", "material": "s", "joints": ["j", "j"]},
      "CD": {"nodes": ["C", "D"], "section": "s", "material": "s"},
      "DA": {"nodes": ["D", "A"], "section": "s", "material": "s"}},
    "panels": {"S": {"nodes": ["A", "B", "C", "D"], "thickness": 0.2, "material": "s", "joint": "e"}},
    "supports": {"A0": "fixed", "B0": "pinned", "C0": "fixed", "D0": {"x": true, "y": true, "z": 4e7, "rx": true, "ry": true, "rz": true}},
    "loads": {"dead": {"self_weight": 1, "panels": {"S": {"pressure": 2e3}}},
      "live": {"panels": {"S": {"pressure": 3e3}}, "members": {"BC": [{"uniform": {"z": -8e3}},
        {"trapezoid": {"y": [1e3, -4e3]}, "from": 1, "to": 3}, {"point": {"z": -9e3, "ry": 4e3}, "at": 2.5}],
        "DA": [{"temperature": {"uniform": 20, "gradient_z": 15}}]}},
      "wind": {"nodes": {"A": {"x": 4e4, "rz": 2e3}, "D": {"x": 3e4}}, "members": {"PA": [{"uniform": {"x": 2e3}}]}},
      "settle": {"settlements": {"B0": {"z": -0.01}, "D0": {"z": 0.005}}}},
    "combinations": {"1": {"dead": 1.35, "live": 1.5}, "2": {"dead": 1, "wind": 1.5}, "3": {"dead": 1, "wind": -1.5},
      "4": {"dead": 1.35, "live": 1.05, "wind": 1.5}, "5": {"settle": 1}, "6": {"dead": 1, "live": -1, "settle": -2}}})",
                                 "m.json");
  const AnalysisResult all = analyse(b);
  REQUIRE(all.combinations.size() == 6);
  for (std::size_t k = 0; k < all.combinations.size(); ++k) {
    const CombinationResult& found = all.combinations[k];
    AnalysisRequest request;
    request.combinations = {CombinationId(k)};
    const CombinationResult alone = analyse(b, request).combinations.front();
    INFO("combination " << k + 1);
    const auto near = [](double size) { return [size](double x) { return Approx(x).epsilon(0).margin(1e-9 * size); }; };
    const auto moved = near(0.01), force = near(1e5);
    for (std::size_t n = 0; n < b.nodes.size(); ++n)
      for (int c = 0; c < 6; ++c) CHECK(found.displacements[n](c) == moved(alone.displacements[n](c)));
    for (std::size_t i = 0; i < b.supports.size(); ++i)
      for (int c = 0; c < 6; ++c) CHECK(found.reactions[i](c) == force(alone.reactions[i](c)));
    for (std::size_t m = 0; m < b.members.size(); ++m) {
      const MemberResult &is = found.members[m], &should = alone.members[m];
      INFO("member " << b.members[m].name);
      for (int c = 0; c < 12; ++c) CHECK(is.end_forces(c) == force(should.end_forces(c)));
      for (std::size_t q = 0; q < 8; ++q) {
        INFO(diagram_names[q]);
        CHECK(is.min[q].value == near(q < 6 ? 1e5 : 0.01)(should.min[q].value));
        CHECK(is.max[q].value == near(q < 6 ? 1e5 : 0.01)(should.max[q].value));
      }
    }
    for (std::size_t j = 0; j < b.joints.size(); ++j) CHECK(found.joints[j].value == near(1)(alone.joints[j].value));
    for (int c = 0; c < 6; ++c) CHECK(found.total_load(c) == near(1e6)(alone.total_load(c)));
    CHECK(found.equilibrium_error < 1e-10);
    CHECK(alone.equilibrium_error < 1e-10);
  }
}

TEST_CASE("an unstable model names the nodes and the members that move") {
  const Building b =
      parse_model(cantilever(R"({"A": "pinned"})", R"({"case": {"nodes": {"B": {"z": -1}}}})"), "c.json");
  CHECK_THROWS_AS(analyse(b), UnstableModel);
  CHECK_THROWS_WITH(analyse(b), Catch::Contains("node B") && Catch::Contains("members M"));
}

TEST_CASE("a settlement of a spring's far end reaches the structure through the spring, and its reaction tells both") {
  // A bar of stiffness E A / L = 5e8 N/m along x between a fixed end and a spring of 1e8 N/m whose far end moves.
  const Building b = parse_model(
      cantilever(R"({"A": "fixed", "B": {"x": 1e8}})", R"({"pull": {"settlements": {"B": {"x": 0.006}}}})"), "c.json");
  const Json c = results(b).at("combinations").at("pull");
  const double force = 0.006 / (1 / 5e8 + 1 / 1e8);
  CHECK(c.at("displacements").at("B")[0].get<double>() == Approx(force / 5e8).epsilon(1e-12));
  CHECK(c.at("reactions").at("B")[0].get<double>() == Approx(force).epsilon(1e-12));
  CHECK(c.at("reactions").at("A")[0].get<double>() == Approx(-force).epsilon(1e-12));
  CHECK(c.at("equilibrium_error").get<double>() < 1e-12);
}

TEST_CASE("a node that only a membrane reaches is unstable, and the message says why") {
  const std::string text = R"({"topple": 1,
    "materials": {"c": {"youngs_modulus": 3e10, "poisson_ratio": 0.2}},
    "sections": {"s": {"area": 0.01, "Iy": 2e-4, "Iz": 3e-5, "J": 5e-6}},
    "nodes": {"A": [0, 0, 0], "B": [4, 0, 0], "C": [4, 4, 0], "D": [0, 4, 0]},
    "members": {"AB": {"nodes": ["A", "B"], "section": "s", "material": "c"}},
    "panels": {"S": {"nodes": ["A", "B", "C", "D"], "thickness": 0.2, "material": "c"}},
    "supports": {"A": "fixed", "B": "fixed"}, "loads": {"case": {"nodes": {"B": {"z": -1}}}}})";
  CHECK_THROWS_WITH(analyse(parse_model(text, "m.json")),
                    Catch::Contains("only membrane panels reach node") && Catch::Contains("along z"));
}

TEST_CASE("loads whose squares leave the range of numbers are an error at once, whatever is asked for") {
  for (const double size : {-1e101, -1e250, -1e305}) {
    // No file can hold it, a caller's building can.
    Building b = parse_model(cantilever(R"({"A": "fixed"})", R"({"case": {"nodes": {"B": {"x": -1}}}})"), "c.json");
    b.cases.at(0).nodes.at(0).load[0] = size;
    for (const bool second_order : {false, true})
      for (const int buckling : {0, 2}) {
        AnalysisRequest request;
        request.second_order = second_order ? topple::solver::SecondOrder::exact : topple::solver::SecondOrder::none;
        request.buckling = buckling;
        CHECK_THROWS_WITH(analyse(b, request), Catch::Contains("too large to compute with"));
      }
  }
  // Just within them, a critical load is a critical load: pi2 E I / (4 L2), less by shear.
  AnalysisRequest request;
  request.buckling = 1;
  const Building b =
      parse_model(cantilever(R"({"A": "fixed"})", R"({"case": {"nodes": {"B": {"x": -1e99}}}})"), "c.json");
  const double euler = std::pow(std::acos(-1.0) / 8, 2) * 2e11 * 3e-5, critical = euler / (1 + euler / (8e10 * 0.004));
  CHECK(analyse(b, request).combinations.at(0).buckling.at(0).factor == Approx(critical / 1e99).epsilon(1e-9));
}

TEST_CASE("reactions that balance the loads to a few digits only are warned of") {
  // A cantilever cut into ever shorter members: the bending of each is ever smaller against its stiffness.
  const auto cut = [](int pieces) {
    std::string nodes = R"("n0": [0, 0, 0])", members;
    for (int i = 0; i < pieces; ++i) {
      const std::string here = std::to_string(i), next = std::to_string(i + 1);
      nodes += R"(, "n)" + next + "\": [" + std::to_string(10.0 * (i + 1) / pieces) + ", 0, 0]";
      members += (i > 0 ? ", \"m" : "\"m") + here + R"(": {"nodes": ["n)" + here + R"(", "n)" + next +
                 R"("], "section": "s", "material": "steel"})";
    }
    return parse_model(R"({"topple": 1, "materials": {"steel": {"youngs_modulus": 2e11, "shear_modulus": 8e10,
        "density": 7850}}, "sections": {"s": {"shape": "box", "depth": 0.3, "width": 0.3, "thickness": 0.01}},
        "supports": {"n0": "fixed"}, "nodes": {)" +
                           nodes + "}, \"members\": {" + members + "}}",
                       "chain.json");
  };
  const auto warned = [](const AnalysisResult& result) {
    return std::any_of(result.warnings.begin(), result.warnings.end(), [](const std::string& warning) {
      return warning.find("combination self weight: reactions balance the loads to about") != std::string::npos;
    });
  };
  const AnalysisResult coarse = analyse(cut(30)), fine = analyse(cut(20000));
  CHECK(coarse.combinations.at(0).equilibrium_error < 1e-8);
  CHECK_FALSE(warned(coarse));
  INFO(fine.combinations.at(0).equilibrium_error);
  REQUIRE(fine.combinations.at(0).equilibrium_error > 1e-6);
  CHECK(warned(fine));
}

TEST_CASE("an answer that is not solved to rounding says so") {
  // Displacements below the least number that a double can hold to its full digits.
  const Building b =
      parse_model(cantilever(R"({"A": "fixed"})", R"({"case": {"nodes": {"B": {"z": -3e-320}}}})"), "c.json");
  const AnalysisResult result = analyse(b);
  REQUIRE_FALSE(result.combinations.at(0).quality.converged);
  REQUIRE(result.warnings.size() >= 2);
  CHECK(result.warnings.back().find("not solved to rounding") != std::string::npos);
}
