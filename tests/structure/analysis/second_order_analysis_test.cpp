// Second order and buckling of whole models: OpenSees' case with its closed form, messages, results.json.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "support/shared_data.h"
#include "topple/structure/analysis.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"

using namespace topple::structure;
using Json = nlohmann::json;
namespace solver = topple::solver;

namespace {

AnalysisRequest second_order(solver::SecondOrder mode) {
  AnalysisRequest request;
  request.second_order = mode;
  return request;
}

/// A cantilever post of 6 m, 2e11 N/m2 and 1e-4 m4, with a load at its head.
Building post(double x, double z) {
  return parse_model(R"({"topple": 1,
    "materials": {"steel": {"youngs_modulus": 2e11, "shear_modulus": 8e10}},
    "sections": {"s": {"area": 0.01, "Iy": 1e-4, "Iz": 1e-4, "J": 1e-4}},
    "nodes": {"A": [0, 0, 0], "B": [0, 0, 6]},
    "members": {"P": {"kind": "post", "nodes": ["A", "B"], "section": "s", "material": "steel"}},
    "supports": {"A": "fixed"},
    "loads": {"wind": {"nodes": {"B": {"x": )" +
                         std::to_string(x) + R"(, "z": )" + std::to_string(z) + "}}}}}",
                     "post.json");
}

constexpr double euler = 9.869604401089358 * 2e11 * 1e-4 / (4 * 36);

}  // namespace

TEST_CASE("OpenSees' P-Delta column has its closed form's sway") {
  if (!topple::test::have_shared("reference/opensees/D1_def_L2.json")) return;
  const Building building = read_model(topple::test::shared_path("reference/opensees/D1_def_L2.json"));
  const CombinationResult result = analyse(building, second_order(solver::SecondOrder::exact)).combinations.front();
  const auto top = static_cast<std::size_t>(NameIndex(building).node("n8")->index);
  CHECK(result.displacements[top](0) == Approx(0.003996312946399833).epsilon(1e-6));
  const CombinationResult cubic = analyse(building, second_order(solver::SecondOrder::cubic)).combinations.front();
  CHECK(cubic.displacements[top](0) == Approx(0.003996312946399833).epsilon(1e-6));  // eight members: close enough
}

TEST_CASE("second order is told in results.json, and its reactions balance the loads") {
  const Building building = post(1000, -0.5 * euler);
  AnalysisRequest request = second_order(solver::SecondOrder::exact);
  request.buckling = 2;
  const AnalysisResult result = analyse(building, request);
  const Json json = Json::parse(results_json(building, request, result, {}));
  CHECK(json.at("settings").at("p_delta") == "exact");
  CHECK(json.at("combinations").at("wind").at("reactions").at("A")[0].get<double>() == Approx(-1000).epsilon(1e-9));
  CHECK(json.at("combinations").at("wind").at("equilibrium_error").get<double>() < 1e-9);
  // The base holds the load's moment and that of the axial force on the swayed head.
  const double sway = json.at("combinations").at("wind").at("displacements").at("B")[0].get<double>();
  CHECK(std::abs(json.at("combinations").at("wind").at("reactions").at("A")[4].get<double>()) ==
        Approx(6000 + 0.5 * euler * sway).epsilon(1e-9));
  const Json& buckling = json.at("buckling").at("wind");
  REQUIRE(buckling.size() == 2);
  CHECK(buckling[0].at("factor").get<double>() == Approx(2).epsilon(1e-9));
  CHECK(buckling[1].at("factor").get<double>() == Approx(2).epsilon(1e-9));  // both ways alike
  // Two different shapes for the two equal factors.
  const auto first = buckling[0].at("shape").at("B"), second = buckling[1].at("shape").at("B");
  const double across =
      first[0].get<double>() * second[1].get<double>() - first[1].get<double>() * second[0].get<double>();
  CHECK(std::abs(across) > 0.9);
}

TEST_CASE("loads beyond buckling are refused with the combination and its critical factor") {
  CHECK_THROWS_AS(analyse(post(10, -1.25 * euler), second_order(solver::SecondOrder::exact)), UnstableModel);
  CHECK_THROWS_WITH(analyse(post(10, -1.25 * euler), second_order(solver::SecondOrder::exact)),
                    Catch::Contains("combination wind") && Catch::Contains("critical factor 0.8"));
}

TEST_CASE("loads beyond all measure buckle a frame or are borne, and never end the analysis without a word") {
  // Units of pounds and inches, by themselves: soft in torsion and in shear, so that it buckles out of its plane.
  const std::string text = R"({"topple": 1, "units": "consistent",
    "materials": {"S": {"youngs_modulus": 29000, "shear_modulus": 11500, "density": 7e-7}},
    "sections": {"s": {"area": 10, "shear_area_z": 1, "Iy": 1000, "Iz": 1000, "J": 1}},
    "nodes": {"A": [0, 0, 0], "B": [100, 0, 0], "C": [100, 100, 0]},
    "members": {"AB": {"nodes": ["A", "B"], "section": "s", "material": "S"},
                "BC": {"nodes": ["B", "C"], "section": "s", "material": "S"}},
    "supports": {"A": SUPPORT, "C": "fixed"}, "loads": {"live": {"nodes": {"B": {LOAD}}}}})";
  for (const char* load :
       {"\"x\": 1e30", "\"x\": -1e20", "\"y\": 1e60", "\"rz\": 1e10", "\"rz\": 1e20", "\"rz\": 1e30"})
    for (const char* support : {"\"fixed\"", "{\"x\": true}"})
      for (const solver::SecondOrder second : {solver::SecondOrder::exact, solver::SecondOrder::cubic}) {
        std::string one = text;
        one.replace(one.find("SUPPORT"), 7, support);
        one.replace(one.find("LOAD"), 4, load);
        INFO(load << ", held at A: " << support);
        AnalysisRequest request = second_order(second);
        request.modes = 2;
        try {
          const AnalysisResult result = analyse(parse_model(one, "corner.json"), request);
          for (const Vec6& displacement : result.combinations.at(0).displacements) CHECK(displacement.allFinite());
        } catch (const std::runtime_error& error) {  // unstable, or axial forces that do not settle
          CHECK_THAT(error.what(), Catch::Contains("corner.json, combination live"));
        }
      }
}
