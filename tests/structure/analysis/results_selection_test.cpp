// A part of results.json holds the chosen members and nodes, and the same numbers as the whole.
#include "topple/structure/results_selection.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "topple/structure/formats/files.h"

using namespace topple::structure;
using Json = nlohmann::json;

namespace {

const char* const tower = R"({"topple": 1,
  "materials": {"S": {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7850}},
  "sections": {"p": {"shape": "box", "depth": 0.3, "width": 0.3, "thickness": 0.01}, "b": {"catalogue": "HEB300"}},
  "building": {"posts": [3, 3], "storeys": 4, "bay": [5, 5], "storey_height": 3,
    "post": {"section": "p", "material": "S"}, "beam": {"section": "b", "material": "S"}}})";

}  // namespace

TEST_CASE("a selection takes so many members, every section among them, with their nodes and all supports") {
  const Building building = parse_model(tower, "tower.json");
  AnalysisResult result = analyse(building);
  // Uses that single out one post and one beam.
  result.combinations[0].designs.resize(building.members.size());
  const auto use = [&](const char* section, double value) {
    for (std::size_t m = building.members.size(); m-- > 0;)
      if (building[building.members[m].section].name == section) {
        result.combinations[0].designs[m].utilisation = value;
        return m;
      }
    return std::size_t{0};
  };
  const std::size_t post = use("p", 0.9), beam = use("b", 0.4);
  const ResultsSelection chosen = select_members(building, result, 12, 1);
  CHECK(chosen.members.size() == 12);
  CHECK(std::is_sorted(chosen.members.begin(), chosen.members.end()));
  for (const std::size_t m : {post, beam}) CHECK(std::binary_search(chosen.members.begin(), chosen.members.end(), m));
  for (const std::size_t m : chosen.members)
    for (const NodeId node : building.members[m].nodes)
      CHECK(std::binary_search(chosen.nodes.begin(), chosen.nodes.end(), static_cast<std::size_t>(node.index)));
  for (const NodeSupport& support : building.supports)
    CHECK(std::binary_search(chosen.nodes.begin(), chosen.nodes.end(), static_cast<std::size_t>(support.node.index)));
  CHECK(select_members(building, result, 10000, 1).members.size() == building.members.size());
}

TEST_CASE("results of a selection are those of the whole, left out what is not selected") {
  const Building building = parse_model(tower, "tower.json");
  AnalysisRequest request;
  request.modes = 2;
  request.buckling = 1;
  const AnalysisResult result = analyse(building, request);
  const ResultsSelection chosen = select_members(building, result, 5, 1);
  Json whole = Json::parse(results_json(building, request, result, {}));
  const Json part = Json::parse(results_json(building, request, result, {}, chosen));
  const auto keep = [](Json& list, const auto& names) {
    Json kept = Json::object();
    for (const std::string& name : names) kept[name] = list.at(name);
    list = kept;
  };
  std::vector<std::string> members, nodes;
  for (const std::size_t m : chosen.members) members.push_back(building.members[m].name);
  for (const std::size_t n : chosen.nodes) nodes.push_back(building.nodes[n].name);
  for (Json& combination : whole.at("combinations")) {
    keep(combination.at("members"), members);
    keep(combination.at("displacements"), nodes);
  }
  keep(whole.at("envelope").at("members"), members);
  keep(whole.at("envelope").at("displacements"), nodes);
  for (Json& list : whole.at("buckling"))
    for (Json& mode : list) keep(mode.at("shape"), nodes);
  for (Json& mode : whole.at("modes")) keep(mode.at("shape"), nodes);
  CHECK(part == whole);
}
