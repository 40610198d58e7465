// Every kind of mistake in a model is told with its file, its place, what was found and what is accepted.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "example_model.h"
#include "formats/json/json_document.h"
#include "support/scratch_folder.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"

using namespace topple::structure;
using topple::test::example_model;
using topple::test::replaced;

namespace {

std::string error_of(const std::string& text, Purpose purpose = Purpose::inspect) {
  try {
    (void)parse_model(text, "m.json", purpose);
  } catch (const InputError& error) {
    const std::string what = error.what();
    CHECK(what.find('\n') == std::string::npos);  // one line, whatever the file holds
    return what;
  }
  return "no error";
}
std::string error(const std::string& from, const std::string& to) {
  return error_of(replaced(example_model, from, to));
}

}  // namespace

TEST_CASE("unknown and missing keys are named with what is accepted") {
  CHECK(
      error("\"up\": [1, 0, 0], \"roll\"", "\"up\": [1, 0, 0], \"rol\"") ==
      "m.json, line 29, members.PA.rol: unknown key; accepted: \"kind\", \"nodes\", \"section\", \"material\", \"up\", "
      "\"roll\", \"joints\", \"offsets\", \"axial\", \"groups\", \"design\"");
  CHECK(error("\"nodes\": [\"B0\", \"B1\"], \"section\": \"col\", ", "\"nodes\": [\"B0\", \"B1\"], ") ==
        "m.json, line 30, members.PB: the key \"section\" is missing");
  CHECK(error("\"topple\": 1", "\"topple\": 2") ==
        "m.json, line 2, topple: found 2; accepted: 1, the version of the format");
  CHECK(error("\"topple\": 1,", "") == "m.json, line 1: the key \"topple\" is missing");
  CHECK(error("\"poisson_ratio\": 0.3, ", "") ==
        "m.json, line 7, materials.S355: one of \"poisson_ratio\" and \"shear_modulus\" is missing");
  CHECK(error("\"web\": 0.011, ", "") == "m.json, line 11, sections.col: the key \"web\" is missing");
}

TEST_CASE("names that do not exist are told with those that do") {
  CHECK(error("\"section\": \"tube\"", "\"section\": \"tub\"") ==
        "m.json, line 37, members.X1.section: there is no section \"tub\"; accepted: \"col\", \"tube\", \"w14\", "
        "\"raw\"");
  CHECK(
      error("[\"ductile\", \"spring\"]", "[\"ductile\", \"sprung\"]")
          .starts_with(
              "m.json, line 35, members.CD.joints[1]: there is no joint \"sprung\"; accepted: \"given\", \"derived\""));
  CHECK(error("\"D0\": \"fixed\"", "\"D9\": \"fixed\"")
            .starts_with("m.json, line 44, supports.D9: there is no node \"D9\"; accepted: \"A0\""));
  CHECK(error("\"live\": 0.5", "\"alive\": 0.5") ==
        "m.json, line 56, combinations.collapse.alive: there is no load case \"alive\"; accepted: \"dead\", \"live\", "
        "\"settle\"");
  CHECK(error("\"W14x48\"", "\"W14x47\"")
            .starts_with("m.json, line 13, sections.w14.catalogue: found \"W14x47\"; accepted: a W"));
  CHECK(
      error("[\"A1\", \"B1\", \"C1\", \"D1\"]}", "[\"*9\"]}") ==
      "m.json, line 45, diaphragms.level 1[0]: the pattern \"*9\" matches no further node; accepted: one that matches");
}

TEST_CASE("wrong types, signs and values are told with what was found") {
  CHECK(error("\"density\": 7850", "\"density\": \"7850\"") ==
        "m.json, line 7, materials.S355.density: found \"7850\"; accepted: a number of 0 or above");
  CHECK(error("\"density\": 7850", "\"density\": -1") ==
        "m.json, line 7, materials.S355.density: found -1; accepted: a number of 0 or above");
  CHECK(error("\"A1\": [0, 0, 3.5]", "\"A1\": [0, 0]") ==
        "m.json, line 26, nodes.A1: found an array of 2; accepted: an array of 3");
  CHECK(error("\"poisson_ratio\": 0.3", "\"poisson_ratio\": 0.7") ==
        "m.json, line 7, materials.S355.poisson_ratio: found 0.7; accepted: above -1, at most 0.5");
  CHECK(error("\"length\": \"m\"", "\"length\": \"yd\"") ==
        "m.json, line 4, units.length: found \"yd\"; accepted: \"m\", \"cm\", \"mm\", \"in\", \"ft\"");
  CHECK(error("\"shape\": \"box\"", "\"shape\": \"bix\"") ==
        "m.json, line 12, sections.tube.shape: found \"bix\"; accepted: \"I\", \"box\", \"rectangle\", \"circle\", "
        "\"pipe\"");
  CHECK(error("\"web\": 0.011", "\"web\": 0.31") ==
        "m.json, line 11, sections.col: the web is wider than the flanges; accepted: web <= width");
  CHECK(error("\"strength\": 1.5", "\"strength\": 0") ==
        "m.json, line 20, joints.original.strength: found 0; accepted: a number above 0");
  CHECK(
      error("\"at\": 2.5", "\"at\": 6.5") ==
      "m.json, line 52, loads.live.members.BC[2].at: found 6.5; accepted: a distance from the first end, from 0 to the "
      "member's length of 6.000000");
  CHECK(error("\"from\": 1.0, \"to\": 3.0", "\"from\": 3.0, \"to\": 3.0") ==
        "m.json, line 51, loads.live.members.BC[1]: the load has no length; accepted: `from` below `to`");
  CHECK(error("{\"z\": -0.01}", "{\"rx\": -0.01}") ==
        "m.json, line 54, loads.settle.settlements.B0.rx: a settlement where the node \"B0\" has no support; accepted: "
        "supported components");
}

TEST_CASE("numbers that are not finite never come in") {
  CHECK(error("\"density\": 7850", "\"density\": NaN").starts_with("m.json, line 7, column 72: syntax error"));
  CHECK(error("\"density\": 7850", "\"density\": 1e999").starts_with("m.json, line 7, column "));
  // Finite in the file, not in SI: 1e305 MN; what the file holds is bounded first.
  const std::string text = replaced(replaced(example_model, "\"force\": \"N\"", "\"force\": \"MN\""), "-5e4", "-1e305");
  CHECK(error_of(text) ==
        "m.json, line 49, loads.live.nodes.B1.z: found -1e+305; accepted: a number from -1e+100 to 1e+100");
}

TEST_CASE("things of no size and impossible shapes are refused") {
  CHECK(error("\"A1\": [0, 0, 3.5]", "\"A1\": [0, 0, 0]") ==
        "m.json, line 29, members.PA: the member has no length (its ends are in one place); accepted: two ends apart "
        "from "
        "each other");
  CHECK(error("[\"B0\", \"B1\"]", "[\"B0\", \"B0\"]") ==
        "m.json, line 30, members.PB.nodes[1]: the node \"B0\" stands twice; accepted: different nodes");
  CHECK(error("\"up\": [1, 0, 0]", "\"up\": [0, 0, 2]") ==
        "m.json, line 29, members.PA: `up` is along the member's axis; accepted: a direction at least 1e-6 rad away "
        "from it");
  CHECK(error("[\"A1\", \"B1\", \"C1\", \"D1\"], \"thickness\"", "[\"A1\", \"C1\", \"B1\", \"D1\"], \"thickness\"") ==
        "m.json, line 40, panels.S1: the four nodes do not go round a convex quadrilateral; accepted: four corners in "
        "order");
  // One corner of a 6 x 6 m slab 0.2 m up: the diagonals (8.49 m) pass at 0.1 m, which is 1.18 % of the longer one.
  CHECK(error("\"C1\": [6, 6, 3.5]", "\"C1\": [6, 6, 3.7]")
            .starts_with("m.json, line 40, panels.S1: the panel is warped by 1.17"));
  CHECK(error("[2.5, 2.1]", "[2.5, 4.1]").starts_with("m.json, line 41, panels.W1: an opening that leaves the panel"));
}

TEST_CASE("duplicates are refused, each where the second stands") {
  CHECK(error("\"C0\": [6, 6, 0]", "\"A0\": [6, 6, 0]") ==
        "m.json, line 27, nodes.A0: this name stands twice, first in line 26; accepted: each name once");
  CHECK(error("\"title\": \"Two bays\"", "\"topple\": 1") ==
        "m.json, line 3, topple: this name stands twice, first in line 2; accepted: each name once");
  CHECK(error("\"W1\": {\"kind\"", "\"PA\": {\"kind\"") ==
        "m.json, line 41, panels.PA: a member or panel named \"PA\" is there already; accepted: each name once");
  CHECK(error("\"A0\": \"fixed\"", "\"A0\": \"fixed\", \"A0\": \"fixed\"").find("stands twice") != std::string::npos);
}

TEST_CASE("capacities that the section or material cannot give name the missing key") {
  CHECK(error("\"plastic_modulus_z\": 2e-4, ", "") ==
        "m.json, line 36, members.DA: its joint \"derived\" takes its capacity from the section, for which "
        "sections.raw.plastic_modulus_z is missing; accepted: that key, or `moment_z` in the joint's capacity");
  CHECK(error("\"yield_strength\": 355e6, ", "").find("materials.S355.yield_strength is missing") != std::string::npos);
  CHECK(error(", \"thermal_expansion\": 1.2e-5", "") ==
        "m.json, line 53, loads.live.members.BC[3].temperature: a temperature, for which "
        "materials.S355.thermal_expansion is missing; accepted: that key");
  CHECK(error("\"ductility\": {", "\"interaction\": \"sum\", \"ductility\": {") ==
        "m.json, line 21, joints.ductile.interaction: \"sum\" with `ductility`; accepted: \"max\"");
  CHECK(error("\"ductility\": {", "\"ductility\": {\"torsion\": 1e-7, ") ==
        "m.json, line 21, joints.ductile.ductility.torsion: found 1e-07; accepted: a number from 1e-06 to 100");
  CHECK(error("[\"original\", null]", "[\"edge\", null]") ==
        "m.json, line 31, members.PC: its joint \"edge\" has `capacity_per_length`; accepted for a member: `capacity`");
}

TEST_CASE("what is not built yet is refused by its name for the purpose that needs it") {
  CHECK(error("\"topple\": 1,", "\"topple\": 1, \"meshes\": {\"f\": {\"file\": \"h.glb\", \"density\": -1}},") ==
        "m.json, line 2, meshes.f.density: found -1; accepted: a number of 0 or above");
  CHECK(error("\"topple\": 1,", "\"topple\": 1, \"meshes\": {\"f\": {\"file\": \"h.glb\", \"bind\": \"near\"}},") ==
        "m.json, line 2, meshes.f.bind: found \"near\"; accepted: \"nearest\", or an object of glTF node names");
  const auto refusal = [](const std::string& from, const std::string& to, Purpose purpose) {
    // Without what else is refused: the shell, the brace's one-way action, the diaphragm.
    std::string text = replaced(example_model, "\"model\": \"shell\", \"mesh\": [4, 3],", "");
    text = replaced(text, "\"openings\": [[[1.5, 0], [2.5, 0], [2.5, 2.1], [1.5, 2.1]]], ", "");
    text = replaced(text, ", \"W1:1\": \"pinned\"", "");
    text = replaced(text, ", \"axial\": \"tension\"", "");
    text = replaced(text, "  \"diaphragms\": {\"level 1\": [\"A1\", \"B1\", \"C1\", \"D1\"]},\n", "");
    text = replaced(text, "[\"ductile\", \"spring\"]", "[\"derived\", \"spring\"]");  // one kind of joint alone
    return error_of(from.empty() ? text : replaced(text, from, to), purpose);
  };
  CHECK(refusal("", "", Purpose::analyse) == "no error");
  CHECK(refusal("", "", Purpose::demolish) == "no error");
  CHECK(refusal("\"model\": \"membrane\"", "\"model\": \"shell\"", Purpose::analyse) == "no error");
  CHECK(refusal("\"model\": \"membrane\"", "\"model\": \"shell\"", Purpose::demolish) == "no error");
  CHECK(refusal("\"model\": \"membrane\"", "\"mesh\": 2", Purpose::analyse) ==
        "m.json, panels.S1.mesh: found a mesh in a membrane; accepted: \"model\": \"shell\", or leave it out");
  CHECK(refusal("\"model\": \"membrane\"", "\"openings\": [[[1, 1], [2, 1], [2, 2]]]", Purpose::analyse) == "no error");
  CHECK(refusal("\"model\": \"membrane\"", "\"model\": \"cladding\", \"openings\": [[[1, 1], [2, 1], [2, 2]]]",
                Purpose::analyse) == "no error");
  CHECK(refusal("\"kind\": \"brace\"", "\"axial\": \"tension\"", Purpose::analyse) == "no error");
  CHECK(refusal("\"kind\": \"brace\"", "\"axial\": \"tension\"", Purpose::demolish) ==
        "m.json, members.X1.axial: \"tension\" is not built yet; accepted: leave it out");
  const std::string diaphragm = "\"diaphragms\": {\"roof\": [\"*1\"]}, \"masses\"";
  CHECK(refusal("\"masses\"", diaphragm, Purpose::analyse) == "no error");
  CHECK(refusal("\"masses\"", diaphragm, Purpose::demolish) ==
        "m.json, diaphragms.roof: a diaphragm is not built yet; accepted: leave it out");
  CHECK(refusal("[\"derived\", \"spring\"]", "[\"ductile\", \"spring\"]", Purpose::analyse) == "no error");
  CHECK(refusal("[\"derived\", \"spring\"]", "[\"ductile\", \"spring\"]", Purpose::demolish) == "no error");
}

TEST_CASE("syntax errors are told by line and column") {
  CHECK(error_of("{\n  \"topple\": 1,\n  \"title\" 5\n}").starts_with("m.json, line 3, column 11: syntax error"));
  CHECK(error_of("").starts_with("m.json, line 1, column 0: syntax error"));
  CHECK(error_of("[1, 2]") == "m.json, line 1: found an array of 2; accepted: an object");
  CHECK(error_of("{\"title\": \"\xff\xfe\"}").starts_with("m.json, line 1, column 12: syntax error"));
  // Truncated anywhere, the example is a syntax error and nothing else.
  for (std::size_t length = 0; length < example_model.size(); length += 97) {
    CAPTURE(length);
    CHECK(error_of(example_model.substr(0, length)).find("column") != std::string::npos);
  }
}

TEST_CASE("a large file of brackets is refused at the first that is too deep") {
  const topple::test::ScratchFolder scratch;
  const auto file = scratch / "topple_brackets.json";
  {
    std::ofstream stream(file, std::ios::binary);
    const std::string block(std::size_t{1} << 20, '[');
    for (int megabyte = 0; megabyte < 64; ++megabyte) stream << block;
  }
  std::string what;
  try {
    (void)read_model(file);
  } catch (const InputError& error) {
    what = error.what();
  }
  CHECK(what ==
        "topple_brackets.json, line 1, column 33: brackets nested more than 32 deep; accepted: a file of this format");
}

TEST_CASE("endless tokens and values beyond all use are refused with bounded memory") {
  using namespace topple::structure::formats;
  JsonLimits limits;
  limits.token = 1000;
  limits.values = 100;
  const auto told = [&](const std::string& text) {
    try {
      (void)JsonDocument::from_text(text, "m.json", limits);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  CHECK(told("\"" + std::string(2000, 'a') + "\"").find("more than 1000 characters") != std::string::npos);
  CHECK(told(std::string(2000, ' ') + "1").find("more than 1000 characters") != std::string::npos);
  std::string many = "[0";
  for (int i = 0; i < 200; ++i) many += ",0";
  CHECK(told(many + "]").find("more than 100 values") != std::string::npos);
}
