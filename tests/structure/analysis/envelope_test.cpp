// What results.json says over all combinations, and of storeys: by definition, and by statics.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "topple/structure/analysis.h"
#include "topple/structure/formats/files.h"

using namespace topple::structure;
using Json = nlohmann::json;

namespace {

/// A frame of two storeys, 3 and 4 m high, in millimetres and kilonewtons, pushed from either side.
Building frame() {
  return parse_model(R"({"topple": 1, "units": {"length": "mm", "force": "kN", "mass": "t"},
    "materials": {"s": {"youngs_modulus": 210, "poisson_ratio": 0.3, "density": 7.85e-9, "yield_strength": 0.355}},
    "sections": {"b": {"shape": "box", "depth": 300, "width": 200, "thickness": 12}},
    "joints": {"j": {"capacity": {"from": "section"}}},
    "nodes": {"A0": [0, 0, 0], "B0": [6000, 0, 0], "A1": [0, 0, 3000], "B1": [6000, 0, 3000], "A2": [0, 0, 7000], "B2": [6000, 0, 7000]},
    "members": {
      "PA1": {"kind": "post", "nodes": ["A0", "A1"], "section": "b", "material": "s", "joints": ["j", null]},
      "PB1": {"kind": "post", "nodes": ["B1", "B0"], "section": "b", "material": "s"},
      "PA2": {"kind": "post", "nodes": ["A1", "A2"], "section": "b", "material": "s"},
      "PB2": {"kind": "post", "nodes": ["B1", "B2"], "section": "b", "material": "s"},
      "B1": {"nodes": ["A1", "B1"], "section": "b", "material": "s"}, "B2": {"nodes": ["A2", "B2"], "section": "b", "material": "s"}},
    "supports": {"A0": "fixed", "B0": "fixed"},
    "loads": {"dead": {"self_weight": 1, "members": {"B1": [{"uniform": {"z": -0.02}}], "B2": [{"uniform": {"z": -0.01}}]}},
              "east": {"nodes": {"A1": {"x": 10}, "B2": {"x": 20, "y": 3}}},
              "west": {"nodes": {"A1": {"x": -12}, "B2": {"x": -20}}}},
    "combinations": {"dead": {"dead": 1.35}, "east": {"dead": 1, "east": 1.5}, "west": {"dead": 1, "west": 1.5}}})",
                     "frame.json");
}

}  // namespace

TEST_CASE("envelopes are the extremes over the combinations, with where and by which of them") {
  const Building building = frame();
  const AnalysisResult result = analyse(building);
  const Json written = Json::parse(results_json(building, {}, result, {}));
  const Json &combinations = written.at("combinations"), &envelope = written.at("envelope");
  for (const Member& member : building.members)
    for (const char* quantity : diagram_names)
      for (const char* bound : {"min", "max"}) {
        INFO(member.name << ' ' << quantity << ' ' << bound);
        const Json& found = envelope.at("members").at(member.name).at(quantity).at(bound);
        const Json& own = combinations.at(found.at(2).get<std::string>()).at("members").at(member.name).at("extremes");
        CHECK(found.at(0) == own.at(quantity).at(bound).at(0));
        CHECK(found.at(1) == own.at(quantity).at(bound).at(1));
        for (const auto& [name, combination] : combinations.items()) {
          const double other =
              combination.at("members").at(member.name).at("extremes").at(quantity).at(bound).at(0).get<double>();
          CHECK((*bound == 'm' && bound[1] == 'i' ? found.at(0).get<double>() <= other
                                                  : found.at(0).get<double>() >= other));
        }
      }
  const Json& joint = envelope.at("joints").at("PA1:1");
  double worst = 0;
  for (const auto& [name, combination] : combinations.items())
    worst = std::max(worst, combination.at("joints").at("PA1:1").at("utilisation").get<double>());
  CHECK(worst > 0);
  CHECK(joint.at(0) == worst);
  CHECK(combinations.at(joint.at(1).get<std::string>()).at("joints").at("PA1:1").at("utilisation") == worst);
  const Json& moved = envelope.at("displacements").at("A2").at("x");
  CHECK(moved.at("min").at(1) == "west");
  CHECK(moved.at("max").at(1) == "east");
  CHECK(moved.at("max").at(0) == combinations.at("east").at("displacements").at("A2").at(0));
}

TEST_CASE("a storey's shear is what is pushed above it, its drift the lean of its posts") {
  const Building building = frame();
  const Json written = Json::parse(results_json(building, {}, analyse(building), {}));
  const Json& east = written.at("combinations").at("east");
  const auto shear = [&](const char* storey, std::size_t way) {
    return east.at("storeys").at(storey).at("shear").at(way).get<double>();
  };
  CHECK(shear("1", 0) == Approx(1.5 * 30).epsilon(1e-10));  // kN; one post of it is drawn head first
  CHECK(shear("2", 0) == Approx(1.5 * 20).epsilon(1e-10));
  CHECK(shear("1", 1) == Approx(1.5 * 3).epsilon(1e-10));
  const auto lean = [&](const char* top, const char* foot, double height) {
    const Json &a = east.at("displacements").at(top), &b = east.at("displacements").at(foot);
    return std::hypot(a.at(0).get<double>() - b.at(0).get<double>(), a.at(1).get<double>() - b.at(1).get<double>()) /
           height;
  };
  CHECK(east.at("storeys").at("1").at("drift").get<double>() ==
        Approx(std::max(lean("A1", "A0", 3000), lean("B1", "B0", 3000))).epsilon(1e-10));
  CHECK(east.at("storeys").at("2").at("drift").get<double>() ==
        Approx(std::max(lean("A2", "A1", 4000), lean("B2", "B1", 4000))).epsilon(1e-10));
}
