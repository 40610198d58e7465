// What an unstable model says: the motion with names, as results.json and as a drawing.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "topple/structure/analysis.h"
#include "topple/structure/formats/files.h"

using namespace topple::structure;
using Json = nlohmann::json;
namespace solver = topple::solver;

namespace {

/// Two posts and a beam, hinged at both heads; feet as given.
Building portal(const std::string& feet, const std::string& load) {
  return parse_model(R"({"topple": 1, "units": {"length": "mm", "force": "N", "mass": "kg"},
    "materials": {"steel": {"youngs_modulus": 2e5, "shear_modulus": 8e4}},
    "sections": {"s": {"area": 1e4, "Iy": 1e8, "Iz": 5e7, "J": 1e7}},
    "joints": {"hinge": {"stiffness": {"ry": 0, "rz": 0}}},
    "nodes": {"A": [0, 0, 0], "B": [0, 0, 3000], "C": [4000, 0, 3000], "D": [4000, 0, 0]},
    "members": {"P": {"kind": "post", "nodes": ["A", "B"], "section": "s", "material": "steel"},
                "Q": {"kind": "post", "nodes": ["D", "C"], "section": "s", "material": "steel"},
                "X": {"nodes": ["B", "C"], "section": "s", "material": "steel", "joints": ["hinge", "hinge"]}},
    "supports": {"A": )" +
                         feet + R"(, "D": )" + feet + R"(},
    "loads": {"push": {"nodes": {"B": )" +
                         load + "}}}}",
                     "portal.json");
}

Diagnosis diagnosis(const Building& building, const AnalysisRequest& request = {}) {
  try {
    (void)analyse(building, request);
  } catch (const UnstableAnalysis& unstable) {
    CHECK(unstable.diagnosis.message == unstable.what());
    return unstable.diagnosis;
  }
  FAIL("the model is stable");
  return {};
}

}  // namespace

TEST_CASE("a mechanism is diagnosed with its nodes, its members and its motion") {
  const Building building = portal(R"({"x": true, "y": true, "z": true, "rx": true, "rz": true})", R"({"x": 10})");
  const Diagnosis found = diagnosis(building);
  CHECK(std::string(found.kind) == "mechanism");
  const Json json = Json::parse(diagnosis_json(building, {}, found)).at("diagnosis");
  CHECK(json.at("combination") == "push");
  CHECK(json.at("members").size() == 3);
  // Both heads sway along x, as far as each other; feet turn with the posts: 1/3000 per mm.
  const auto& shape = json.at("shape");
  CHECK(std::abs(shape.at("B")[0].get<double>()) == Approx(1).epsilon(1e-6));
  CHECK(shape.at("C")[0].get<double>() == Approx(shape.at("B")[0].get<double>()).epsilon(1e-6));
  CHECK(std::abs(shape.at("A")[4].get<double>()) == Approx(1.0 / 3000).epsilon(1e-6));
  CHECK(json.at("nodes").size() >= 2);
  const NamedTexts drawing = diagnosis_vtu(building, found);
  CHECK(drawing.at(0).first == "diagnosis.vtu");
  CHECK_THAT(drawing.at(0).second, Catch::Contains("Name=\"motion\""));
}

TEST_CASE("a structure loaded beyond its critical factor is diagnosed with its buckling shape") {
  const Building building = portal("\"fixed\"", R"({"x": 10, "z": -2e7})");
  AnalysisRequest request;
  request.second_order = solver::SecondOrder::exact;
  const Diagnosis found = diagnosis(building, request);
  CHECK(std::string(found.kind) == "buckling");
  CHECK_THAT(found.message, Catch::Contains("critical factor"));
  double largest = 0;
  for (const Vec6& node : found.shape) largest = std::max(largest, node.head<3>().norm());
  CHECK(largest == Approx(1).epsilon(1e-12));
}

TEST_CASE("shapes of modes and of buckling are in the drawing of each combination") {
  const Building building = portal("\"fixed\"", R"({"z": -1e3})");
  AnalysisRequest request;
  request.stations = drawing_stations;
  request.buckling = 1;
  AnalysisResult result = analyse(building, request);
  result.modes.push_back({1, {}, result.combinations[0].buckling[0].shape});
  const NamedTexts files = results_vtu(building, result);
  CHECK_THAT(files.at(0).second, Catch::Contains("Name=\"buckling 1\"") && Catch::Contains("Name=\"mode 1\""));
}
