// Parts that are most likely not meant as they are drawn, and usual meshes where stresses are singular.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "topple/structure/analysis.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/modelling_checks.h"

using namespace topple::structure;

namespace {

constexpr const char* head = R"({"topple": 1,
  "materials": {"s": {"youngs_modulus": 2.1e11, "poisson_ratio": 0.3, "density": 7850},
                "c": {"youngs_modulus": 3e10, "poisson_ratio": 0.2}},
  "sections": {"b": {"catalogue": "IPE300"}, "n": {"area": 0.005, "Iy": 8e7, "Iz": 6e6, "J": 2e5}},)";

bool told(const std::vector<std::string>& warnings, const std::string& what) {
  for (const std::string& warning : warnings)
    if (warning.find(what) != std::string::npos) return true;
  return false;
}

std::vector<std::string> warnings_of(const std::string& parts) {
  Building building = parse_model(head + parts + "}", "m.json");
  std::vector<std::string> all = modelling_warnings(building);
  all.insert(all.end(), building.warnings.begin(), building.warnings.end());
  return all;
}

std::string beam(const std::string& name, const std::string& from, const std::string& to, const std::string& more = "",
                 const std::string& section = "b") {
  return '"' + name + R"(": {"nodes": [")" + from + R"(", ")" + to + R"("], "section": ")" + section +
         R"(", "material": "s")" + more + "}";
}

std::string panel(const std::string& name, const std::string& nodes, const std::string& thickness = "0.2") {
  return '"' + name + R"(": {"kind": "slab", "nodes": [)" + nodes + R"(], "thickness": )" + thickness +
         R"(, "material": "c", "model": "shell"})";
}

double deflection(const Building& building) { return analyse(building).combinations[0].largest.value; }

}  // namespace

TEST_CASE("members that end beside, cross or miss what they should meet are told") {
  const std::string supports = R"("supports": {"A": "fixed", "B": "fixed"}, )";
  const std::string nodes = R"("nodes": {"A": [0,0,0], "B": [6,0,0], "C": [3,-2,0], "D": [3,2,0], "E": [3,0.1,0],
    "F": [3,3,0]},)";
  const std::string all = R"("loads": {"u": {"nodes": {"A": {"z": -1}}}}, "members": {)";
  // 0.1 m beside a beam that is 0.3 m deep; as far as 2 m is a cantilever's own business.
  CHECK(told(warnings_of(nodes + supports + all + beam("AB", "A", "B") + "," + beam("EF", "E", "F") + "}"),
             "member EF ends at node E, 0.1 from member AB"));
  CHECK_FALSE(told(warnings_of(nodes + supports + all + beam("AB", "A", "B") + "," + beam("DF", "D", "F") + "}"),
                   "ends at node"));
  CHECK(told(warnings_of(nodes + supports + all + beam("AB", "A", "B") + "," + beam("CD", "C", "D") + "}"),
             "beams AB and CD cross: nothing joins them"));
  CHECK_FALSE(told(warnings_of(nodes + supports + all + beam("AB", "A", "B") + "," +
                               beam("CD", "C", "D", R"(, "kind": "brace")") + "}"),
                   "cross"));
  CHECK(told(warnings_of(nodes + supports + all + beam("AB", "A", "B", R"(, "roll": 90)") + "}"),
             "member AB: its roll is more than a turn"));
  CHECK(told(warnings_of(nodes + supports + all + beam("AB", "A", "B", "", "n") + "}"), "as deep as long"));
  CHECK(told(warnings_of(R"("nodes": {"A": [0,0,0], "B": [6000,0,0]},)" + supports + all + beam("AB", "A", "B") + "}"),
             "member AB is 2e+04 times as long as deep"));
  CHECK(told(warnings_of(nodes + R"("supports": {"A": "fixed", "B": "fixed", "F": "fixed"}, )" + all +
                         beam("AB", "A", "B") + "}"),
             "support at node F: no member, panel or diaphragm is there"));
  CHECK(told(warnings_of(nodes + supports + R"("loads": {"u": {"self_weight": -1}}, "members": {)" +
                         beam("AB", "A", "B") + "}"),
             "load case u: its self weight acts upwards"));
}

TEST_CASE("panels over each other, thicker than wide or loaded from below are told") {
  const std::string nodes = R"("nodes": {"A": [0,0,0], "B": [6,0,0], "C": [6,5,0], "D": [0,5,0], "E": [3,0,0],
    "F": [3,5,0]}, "supports": {"A": "fixed", "B": "fixed"}, "loads": {"u": {"self_weight": 1, "panels": {"S": {"pressure": 1000}}}},
    "panels": {)";
  const std::string whole = R"("A","B","C","D")";
  CHECK(warnings_of(nodes + panel("S", whole) + "}").empty());
  CHECK(told(warnings_of(nodes + panel("S", whole) + "," + panel("T", whole) + "}"),
             "panels S and T lie over each other"));
  CHECK(told(warnings_of(nodes + panel("S", whole) + "," + panel("T", R"("E","B","C","F")") + "}"),
             "panels S and T lie over each other"));
  CHECK_FALSE(told(warnings_of(nodes + panel("S", R"("A","E","F","D")") + "," + panel("T", R"("E","B","C","F")") + "}"),
                   "over each"));
  CHECK(told(warnings_of(nodes + panel("S", whole, "200") + "}"), "panel S is 200 thick"));
  CHECK(told(warnings_of(nodes + panel("S", R"("A","D","C","B")") + "}"),
             "load case u presses on panel S: its normal looks down"));
}

TEST_CASE("loads that lift the structure on balance are told") {
  const auto found = [](const std::string& force) {
    return analyse(parse_model(head +
                                   (R"("nodes": {"A": [0,0,0], "B": [6,0,0]}, "supports": {"A": "fixed"},
      "loads": {"u": {"nodes": {"B": {"x": 1000, "z": )" +
                                    force + R"(}}}}, "members": {)") +
                                   beam("AB", "A", "B") + "}}",
                               "m.json"))
        .warnings;
  };
  CHECK(told(found("20"), "combination u: its loads lift the structure (20 upwards on balance)"));
  CHECK_FALSE(told(found("-20"), "lift"));
  CHECK_FALSE(told(found("0"), "lift"));
}

TEST_CASE("a structure without any support is told") {
  const auto found = [](const std::string& supports) {
    return told(warnings_of(R"("nodes": {"A": [0,0,0], "B": [6,0,0]}, )" + supports +
                            R"("loads": {"u": {"self_weight": 1}}, "members": {)" + beam("AB", "A", "B") + "}"),
                "nothing is supported");
  };
  CHECK(found(""));
  CHECK_FALSE(found(R"("supports": {"A": "fixed"}, )"));
}

TEST_CASE("loads typed in kilonewtons are told") {
  const auto found = [](const std::string& loads, const std::string& more = "") {
    return told(
        warnings_of(R"("nodes": {"A": [0,0,0], "B": [60,0,0]}, "supports": {"A": "fixed"}, "loads": {"u": {)" + loads +
                    R"(}}, "combinations": {"c": {"u": 1}}, "members": {)" + beam("AB", "A", "B") + "}" + more),
        "are kilonewtons meant?");
  };
  CHECK(found(R"("nodes": {"B": {"z": -20}})"));         // beside 25 kN of weight
  CHECK_FALSE(found(R"("nodes": {"B": {"z": -200}})"));  // a small load may be meant
  CHECK(found(R"("nodes": {"B": {"x": 20}})"));
  CHECK_FALSE(found(R"("nodes": {"B": {"x": 26}})"));  // a thousandth of the weight: a notional one
  CHECK(found(R"("self_weight": 1.0, "members": {"AB": [{"uniform": {"z": -7}}]})"));  // 420 N; 7 typed for 7 kN/m
  CHECK_FALSE(found(R"("members": {"AB": [{"uniform": {"z": -12}}]})"));  // 720 N: a fortieth of the weight, a cable's
  CHECK_FALSE(found(R"("nodes": {"B": {"z": 0}})"));
  CHECK_FALSE(found(R"("self_weight": 1.0)"));
}

// Morley's simply supported rhombus of 30 degrees bends by 0.000408 q a^4/D at its middle (thin plates; Morley 1963).
// Asked: 5 %.
TEST_CASE("a slab of 30 degrees bends as published without a mesh of its own") {
  const Building building = parse_model(head + (R"("nodes": {"A": [0,0,0], "B": [5,0,0],
    "C": [9.330127018922193,2.5,0], "D": [4.330127018922193,2.5,0]},
    "supports": {"S:1": {"z": true}, "S:2": {"z": true}, "S:3": {"z": true}, "S:4": {"z": true},
                 "A": {"x": true, "y": true, "z": true}, "B": {"y": true, "z": true}},
    "loads": {"u": {"panels": {"S": {"pressure": 10000}}}}, "panels": {)" +
                                                panel("S", R"("A","B","C","D")", "0.1") + "}}"),
                                        "skew.json");
  const double D = 3e10 * 1e-3 / 12 / (1 - 0.04);
  CHECK(deflection(building) == Approx(0.000408 * 10000 * 625 / D).epsilon(0.05));
}

// Against the same L in four times as many elements each way. Asked: 5 %; twelve elements along each panel leave 7 %.
TEST_CASE("an L bends as in fine meshes without a mesh of its own") {
  const auto l_shape = [](const std::string& mesh) {
    std::string parts = R"("nodes": {"A": [0,0,0], "B": [4,0,0], "C": [8,0,0], "D": [0,4,0], "E": [4,4,0], "F": [8,4,0],
      "G": [0,8,0], "H": [4,8,0]}, "supports": {"A": {"x": true, "y": true, "z": true}, "C": {"y": true, "z": true})";
    for (const char* edge : {"P:1", "P:4", "Q:1", "Q:2", "Q:3", "R:2", "R:3", "R:4"})
      parts += std::string(", \"") + edge + R"(": {"z": true})";
    parts +=
        R"(}, "loads": {"u": {"panels": {"P": {"pressure": 1000}, "Q": {"pressure": 1000}, "R": {"pressure": 1000}}}},
      "panels": {)";
    const auto one = [&](const std::string& name, const std::string& nodes) {
      std::string text = panel(name, nodes);
      return text.insert(text.size() - 1, mesh);
    };
    return parse_model(head + parts + one("P", R"("A","B","E","D")") + "," + one("Q", R"("B","C","F","E")") + "," +
                           one("R", R"("D","E","H","G")") + "}}",
                       "l.json");
  };
  CHECK(deflection(l_shape("")) == Approx(deflection(l_shape(R"(, "mesh": 48)"))).epsilon(0.05));
}
