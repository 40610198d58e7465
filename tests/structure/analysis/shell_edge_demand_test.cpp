// What the edge joints of shells bear: resultants in balance with loads and reactions.
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "topple/structure/analysis.h"
#include "topple/structure/formats/files.h"

using namespace topple::structure;

namespace {

/// Edge joints have capacities of 1 N per m: their uses are demands.
Building building_of(const std::string& rest) {
  nlohmann::json model = nlohmann::json::parse(rest);
  model["topple"] = 1;
  model["gravity"] = 10;
  model["materials"] = {{"concrete", {{"youngs_modulus", 3e10}, {"poisson_ratio", 0.2}, {"density", 2500}}}};
  model["joints"] = {
      {"unit", {{"capacity_per_length", {{"tension", 1}, {"compression", 1}, {"shear_y", 1}, {"shear_z", 1}}}}}};
  return parse_model(model.dump(), "shell");
}

double demand(const Building& building, const CombinationResult& result, const std::string& joint) {
  return result.joints.at(static_cast<std::size_t>(NameIndex(building).joint(joint)->index)).value;
}

}  // namespace

TEST_CASE("a shell's supported edge bears its reaction, free edges bear nothing") {
  // A wall of 4 by 3 m on a coarse mesh, under wind, or under its weight of 4 * 3 * 0.2 * 2500 * 10 N.
  const Building building = building_of(R"({
    "nodes": {"A": [0, 0, 0], "B": [4, 0, 0], "C": [4, 0, 3], "D": [0, 0, 3]},
    "panels": {"W": {"kind": "wall", "nodes": ["A", "B", "C", "D"], "thickness": 0.2, "material": "concrete",
                     "model": "shell", "mesh": [3, 2], "joint": "unit"}},
    "supports": {"W:1": "fixed"},
    "loads": {"wind": {"panels": {"W": {"pressure": 500}}}, "dead": {"self_weight": 1}}})");
  const AnalysisResult result = analyse(building);
  REQUIRE(result.combinations.size() == 2);
  for (const CombinationResult& of : result.combinations) {
    const bool weight = building[of.combination].name == "dead";
    const Vec6& reaction = of.edge_reactions.at(0);
    CHECK(std::abs(reaction.y()) == Approx(weight ? 0 : 6000).margin(1e-6));
    CHECK(reaction.z() == Approx(weight ? 60000 : 0).margin(1e-6));
    // The largest use of seven senses with equal capacities: the largest component.
    CHECK(demand(building, of, "W:1") == Approx((weight ? 60000 : 6000) / 4.0).epsilon(1e-9));
    for (const std::string edge : {"W:2", "W:3", "W:4"}) CHECK(demand(building, of, edge) == Approx(0).margin(1e-6));
  }
}

TEST_CASE("a flat slab's edge joints bear what the posts under its corners do") {
  const Building building = building_of(R"({
    "nodes": {"A": [0, 0, 0], "B": [4, 0, 0], "C": [4, 6, 0], "D": [0, 6, 0]},
    "panels": {"S": {"kind": "slab", "nodes": ["A", "B", "C", "D"], "thickness": 0.2, "material": "concrete",
                     "model": "shell", "mesh": [4, 4], "joint": "unit"}},
    "supports": {"A": {"x": true, "y": true, "z": true}, "B": {"y": true, "z": true}, "C": {"z": true}, "D": {"z": true}},
    "loads": {"dead": {"panels": {"S": {"pressure": 1e3}}}}})");
  const AnalysisResult result = analyse(building);
  const CombinationResult& of = result.combinations.at(0);
  // A quarter of 24 kN at each corner, half of it by each edge.
  CHECK(demand(building, of, "S:1") == Approx(2 * 3000 / 4.0).epsilon(1e-9));
  CHECK(demand(building, of, "S:2") == Approx(2 * 3000 / 6.0).epsilon(1e-9));
}
