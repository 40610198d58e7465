// Members lost beside shell panels: the state after a loss against a static analysis of the model without the member,
// on the whole mesh.
#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "topple/structure/analysis.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"

using namespace topple::structure;

namespace {

/// Two slabs side by side on six posts, their edges on beams, with a wall that stands on the ground under one edge.
nlohmann::json two_slabs() {
  return nlohmann::json::parse(R"({"topple": 1,
    "materials": {"steel": {"youngs_modulus": 2.1e11, "poisson_ratio": 0.3, "density": 7850},
                  "concrete": {"youngs_modulus": 3e10, "poisson_ratio": 0.2, "density": 2500}},
    "sections": {"post": {"area": 0.01, "Iy": 2e-4, "Iz": 1.5e-4, "J": 1e-5},
                 "beam": {"area": 0.006, "Iy": 9e-5, "Iz": 1e-5, "J": 1e-6}},
    "joints": {"strong": {"capacity": {"tension": 1e7, "compression": 1e7, "shear_y": 1e7, "shear_z": 1e7, "torsion": 1e6,
                                       "moment_y": 1e7, "moment_z": 1e7}},
               "edge": {"capacity_per_length": {"tension": 1e6, "compression": 1e6, "shear_y": 1e6, "shear_z": 1e6,
                                                "moment_y": 1e6}}},
    "nodes": {"A": [0, 0, 0], "B": [4, 0, 0], "C": [8, 0, 0], "D": [0, 5, 0], "E": [4, 5, 0], "F": [8, 5, 0],
              "a": [0, 0, 3], "b": [4, 0, 3], "c": [8, 0, 3], "d": [0, 5, 3], "e": [4, 5, 3], "f": [8, 5, 3]},
    "members": {
      "P1": {"kind": "post", "nodes": ["A", "a"], "section": "post", "material": "steel", "joints": ["strong", "strong"]},
      "P2": {"kind": "post", "nodes": ["B", "b"], "section": "post", "material": "steel", "joints": ["strong", "strong"]},
      "P3": {"kind": "post", "nodes": ["C", "c"], "section": "post", "material": "steel", "joints": ["strong", "strong"]},
      "P4": {"kind": "post", "nodes": ["D", "d"], "section": "post", "material": "steel", "joints": ["strong", "strong"]},
      "P5": {"kind": "post", "nodes": ["E", "e"], "section": "post", "material": "steel", "joints": ["strong", "strong"]},
      "P6": {"kind": "post", "nodes": ["F", "f"], "section": "post", "material": "steel", "joints": ["strong", "strong"]},
      "ab": {"nodes": ["a", "b"], "section": "beam", "material": "steel", "joints": ["strong", "strong"]},
      "bc": {"nodes": ["b", "c"], "section": "beam", "material": "steel", "joints": ["strong", "strong"]},
      "ef": {"nodes": ["e", "f"], "section": "beam", "material": "steel", "joints": ["strong", "strong"]},
      "cf": {"nodes": ["c", "f"], "section": "beam", "material": "steel", "joints": ["strong", "strong"]},
      "be": {"nodes": ["b", "e"], "section": "beam", "material": "steel", "joints": ["strong", "strong"]}},
    "panels": {
      "S": {"kind": "slab", "nodes": ["a", "b", "e", "d"], "thickness": 0.18, "material": "concrete", "model": "shell",
            "mesh": [3, 4], "joint": "edge"},
      "T": {"kind": "slab", "nodes": ["b", "c", "f", "e"], "thickness": 0.18, "material": "concrete", "model": "shell",
            "mesh": [4, 4], "joint": "edge", "openings": [[[1, 1.25], [2, 1.25], [2, 2.5], [1, 2.5]]]},
      "W": {"kind": "wall", "nodes": ["D", "E", "e", "d"], "thickness": 0.2, "material": "concrete", "model": "shell",
            "mesh": [3, 3], "joint": "edge"}},
    "supports": {"A": "fixed", "B": "fixed", "C": "fixed", "D": "fixed", "E": "fixed", "F": "fixed", "W:1": "fixed"},
    "loads": {"dead": {"self_weight": 1, "panels": {"S": {"pressure": 3e3}, "T": {"pressure": 2e3}},
                       "members": {"ab": [{"uniform": {"z": -2e3}}], "cf": [{"point": {"z": -4e3}, "at": 2}]}}}})");
}

CombinationResult without(nlohmann::json model, const std::string& member) {
  model["members"].erase(member);
  for (auto& [name, load_case] : model["loads"].items()) load_case["members"].erase(member);
  const Building building = parse_model(model.dump(), "without " + member);
  return analyse(building).combinations.at(0);
}

}  // namespace

TEST_CASE("the state after a loss beside shells is that of the model without the member, on the whole mesh") {
  const nlohmann::json model = two_slabs();
  const Building building = parse_model(model.dump(), "two slabs");
  const NameIndex names(building);
  // A corner and a middle post; a beam under a free edge, one between two slabs and one that nothing lies along (ef's
  // slab hangs on it alone there).
  for (const std::string name : {"P1", "P2", "P6", "ab", "be", "cf", "ef"}) {
    INFO(name);
    const MemberId lost = names.member(name).value();
    const LossResult result = find_losses(building, {CombinationId(0u)}, {{lost}, {}, 1, {}}, {});
    const LossState& state = result.losses.at(0).states.at(0);
    REQUIRE(state.stands());
    nlohmann::json reduced = model;
    reduced["members"].erase(name);
    reduced["loads"]["dead"]["members"].erase(name);
    const Building rest = parse_model(reduced.dump(), "without " + name);
    const NameIndex of_rest(rest);
    const CombinationResult expected = without(model, name);
    // Two ways to one answer: rounding times the condition, about 1e6.
    double off = 0, most = 0;
    for (std::size_t n = 0; n < building.nodes.size(); ++n) {
      off = std::max(off, (state.displacements[n] - expected.displacements[n]).head<3>().norm());
      most = std::max(most, expected.displacements[n].head<3>().norm());
    }
    CHECK(off < 1e-9 * most);
    CHECK(state.end_forces.size() == rest.members.size());
    off = most = 0;
    for (const auto& [member, forces] : state.end_forces) {
      const auto& own = expected.members[static_cast<std::size_t>(of_rest.member(building[member].name)->index)];
      off = std::max(off, (forces - own.end_forces).cwiseAbs().maxCoeff());
      most = std::max(most, own.end_forces.cwiseAbs().maxCoeff());
    }
    CHECK(off < 1e-8 * most);
    off = most = 0;
    double worst = 0;
    for (const auto& [joint, used] : state.joints) {
      const auto other = of_rest.joint(building[joint].name);
      REQUIRE(other);
      INFO(building[joint].name);
      const double own = expected.joints[static_cast<std::size_t>(other->index)].value;
      CHECK(used.value == Approx(own).epsilon(1e-7).margin(1e-9));
      worst = std::max(worst, own);
    }
    CHECK(state.utilisation.value == Approx(worst));
    CHECK(state.joints.size() ==
          static_cast<std::size_t>(std::count_if(rest.joints.begin(), rest.joints.end(),
                                                 [](const Joint& joint) { return joint.capacity.breakable; })));
  }
}

TEST_CASE("losses beside shells leave no trace in the next") {
  const Building building = parse_model(two_slabs().dump(), "two slabs");
  const NameIndex names(building);
  std::vector<MemberId> members;
  for (const std::string name : {"P1", "ab", "be", "P5"}) members.push_back(names.member(name).value());
  const LossResult together = find_losses(building, {CombinationId(0u)}, {{}, members, 2, {}}, {});
  REQUIRE(together.losses.size() == members.size());
  for (const MemberLoss& loss : together.losses) {
    const LossResult alone = find_losses(building, {CombinationId(0u)}, {{loss.member}, {}, 2, {}}, {});
    CHECK(alone.losses[0].states[0].utilisation.value == Approx(loss.states[0].utilisation.value).epsilon(1e-9));
    CHECK(alone.losses[0].states[0].worst == loss.states[0].worst);
  }
}

TEST_CASE("edges of shells that give, and shells that are heated, are refused in losses by name") {
  nlohmann::json giving = two_slabs();
  giving["joints"]["hinge"] = {{"stiffness", {{"rx", 0.0}}}};
  giving["panels"]["S"]["joint"] = "hinge";
  const Building hinged = parse_model(giving.dump(), "hinged");
  const LossRequest request{{MemberId(0u)}, {}, 2, {}};
  CHECK_THROWS_WITH(find_losses(hinged, {CombinationId(0u)}, request, {}), Catch::Contains("S:1"));
  nlohmann::json heated = two_slabs();
  heated["materials"]["concrete"]["thermal_expansion"] = 1e-5;
  heated["loads"]["dead"]["panels"]["T"] = {{"temperature", 20}};
  const Building hot = parse_model(heated.dump(), "heated");
  CHECK_THROWS_WITH(find_losses(hot, {CombinationId(0u)}, request, {}), Catch::Contains("panel (T)"));
}
