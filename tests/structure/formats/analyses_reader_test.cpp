// `analyses` and `frame3dd` of a model: what the file itself asks for, and what it keeps for Frame3DD alone.
#include <algorithm>
#include <catch2/catch.hpp>

#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"

using namespace topple::structure;

namespace {

Building with(const std::string& keys) {
  return parse_model(
      R"({"topple": 1, "materials": {"S": {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7850}},
    "sections": {"s": {"area": 0.01, "Iy": 1e-4, "Iz": 2e-5, "J": 1e-6}}, "nodes": {"A": [0, 0, 0], "B": [4, 0, 0]},
    "members": {"AB": {"nodes": ["A", "B"], "section": "s", "material": "S"}}, "supports": {"A": "fixed"}, )" +
          keys + "}",
      "m.json", Purpose::inspect);
}

std::string refusal(const std::string& keys) {
  try {
    (void)with(keys);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("a model asks for its own analyses") {
  const RequestedAnalyses all =
      with(R"("analyses": {"p_delta": "cubic", "modes": 3, "mass": "lumped", "shift": 0.5})").requested;
  CHECK(all.cubic_p_delta);
  CHECK(all.modes == 3);
  CHECK(all.modes_of_last_combination);
  CHECK(all.lumped_mass);
  CHECK(all.frequency_shift == 0.5);
  const RequestedAnalyses modes = with(R"("analyses": {"modes": 2, "mass": "consistent"})").requested;
  CHECK_FALSE(modes.cubic_p_delta);
  CHECK_FALSE(modes.modes_of_last_combination);
  CHECK_FALSE(modes.lumped_mass);
  CHECK(with(R"("analyses": {})").requested.modes == 0);
}

TEST_CASE("analyses that mean nothing are refused by their key") {
  for (const auto& [keys, said] : {
           std::pair{R"("analyses": {"p_delta": "exact"})", "analyses.p_delta: found \"exact\"; accepted: \"cubic\""},
           std::pair{R"("analyses": {"mass": "lumped"})", "analyses.mass: it means nothing without `modes`"},
           std::pair{R"("analyses": {"shift": 1})", "analyses.shift: it means nothing without `modes`"},
           std::pair{R"("analyses": {"modes": 0})", "analyses.modes"},
           std::pair{R"("analyses": {"modes": 2, "mass": "all"})", "accepted: \"consistent\" or \"lumped\""},
           std::pair{R"("analyses": {"sway": 1})", "analyses.sway: unknown key"},
       }) {
    INFO(keys);
    CHECK_THAT(refusal(keys), Catch::StartsWith("m.json") && Catch::Contains(said));
  }
}

TEST_CASE("what only Frame3DD uses is checked, and that no condensation is made is told") {
  const std::string condensation =
      R"("condensation": {"method": 1, "nodes": {"B": [1, 1, 1, 0, 0, 0]}, "modes": [1, 2]})";
  const std::string keys =
      R"("frame3dd": {"exaggeration": 10, "zoom": 2, "increment": 5, "method": 2, "tolerance": 1e-9,
    "mode_exaggeration": 3, "pan": 1, "animated": [1, 2], )" +
      condensation + "}";
  const auto told = [](const Building& building) {
    return std::count_if(building.warnings.begin(), building.warnings.end(),
                         [](const std::string& warning) { return warning.find("condensation") != std::string::npos; });
  };
  CHECK(told(with(keys)) == 1);
  CHECK(told(with(R"("frame3dd": {"condensation": {"method": 0}})")) == 0);
  for (const auto& [wrong, said] : {
           std::pair{R"("frame3dd": {"method": 3})", "frame3dd.method"},
           std::pair{R"("frame3dd": {"tolerance": 0})", "frame3dd.tolerance"},
           std::pair{R"("frame3dd": {"zoom": "near"})", "frame3dd.zoom"},
           std::pair{R"("frame3dd": {"animated": [0]})", "frame3dd.animated[0]"},
           std::pair{R"("frame3dd": {"animated": 1})", "frame3dd.animated"},
           std::pair{R"("frame3dd": {"condensation": {}})", "method"},
           std::pair{R"("frame3dd": {"condensation": {"method": 4}})", "condensation.method"},
           std::pair{R"("frame3dd": {"condensation": {"method": 1, "nodes": {"X": [1, 1, 1, 0, 0, 0]}}})", "X"},
           std::pair{R"("frame3dd": {"condensation": {"method": 1, "nodes": {"B": [1, 1, 1]}}})",
                     "condensation.nodes.B"},
           std::pair{R"("frame3dd": {"condensation": {"method": 1, "nodes": {"B": [2, 1, 1, 0, 0, 0]}}})",
                     "condensation.nodes.B[0]"},
           std::pair{R"("frame3dd": {"condensation": {"method": 1, "modes": [-1]}})", "condensation.modes[0]"},
           std::pair{R"("frame3dd": {"colour": 1})", "frame3dd.colour: unknown key"},
       }) {
    INFO(wrong);
    CHECK_THAT(refusal(wrong), Catch::StartsWith("m.json") && Catch::Contains(said));
  }
}
