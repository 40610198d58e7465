// What the viewer opens: scenarios, models, shipped ones by name; what is none is told with what is accepted.
#include "app/open_scene.h"

#include <catch2/catch.hpp>
#include <fstream>

#include "support/scratch_folder.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/shipped_files.h"

using namespace topple::viewer;
namespace structure = topple::structure;

namespace {

constexpr const char* bay = R"({"topple": 1, "title": "Bay",
 "materials": {"S": {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7850, "yield_strength": 235e6}},
 "sections": {"tube": {"shape": "box", "depth": 0.3, "width": 0.3, "thickness": 0.015}},
 "nodes": {"A": [0, 0, 0], "B": [0, 0, 4], "C": [6, 0, 4], "D": [6, 0, 0]},
 "members": {"P": {"kind": "post", "nodes": ["A", "B"], "section": "tube", "material": "S"},
             "Q": {"kind": "post", "nodes": ["D", "C"], "section": "tube", "material": "S"},
             "T": {"nodes": ["B", "C"], "section": "tube", "material": "S"}},
 "supports": {"A": "fixed", "D": "fixed"}})";

std::string refusal(const std::string& name) {
  try {
    (void)open_scene(name);
  } catch (const structure::InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("a file that names a model at its top is a scenario, any other one a model that stands by itself") {
  const topple::test::ScratchFolder folder;
  std::ofstream(folder / "bay.json") << bay;
  std::ofstream(folder / "s.json") << R"({"topple": 1, "title": "Cut", "model": "bay.json", "duration": 2,
    "events": [{"at": 0.1, "remove": {"members": ["P"]}}]})";
  const Scene scenario = open_scene((folder / "s.json").string());
  CHECK(scenario.scenario.title == "Cut");
  CHECK(scenario.scenario.events.size() == 1);
  CHECK(scenario.building->members.size() == 3);
  CHECK(scenario.model == folder / "bay.json");
  const Scene model = open_scene((folder / "bay.json").string());
  CHECK(model.building->title == "Bay");
  CHECK(model.scenario.events.empty());
  CHECK(model.model == folder / "bay.json");
  CHECK(model.drawn->empty());
  // The key inside of something else is none at the top.
  std::ofstream(folder / "inner.json") << R"({"topple": 1, "groups": {"model": {"members": []}}})";
  CHECK_THAT(refusal((folder / "inner.json").string()), Catch::Contains("inner.json") && Catch::Contains("materials"));
  std::ofstream(folder / "none.json") << "no JSON";
  CHECK_THAT(refusal((folder / "none.json").string()), Catch::Contains("none.json"));
}

TEST_CASE("shipped scenarios and models open by their names") {
  const Scene scenario = open_scene("wall_hit");
  CHECK_FALSE(scenario.scenario.events.empty());
  const Scene model = open_scene("wall");
  CHECK(model.scenario.events.empty());
  CHECK(model.building->members.size() + model.building->panels.size() > 0);
}

TEST_CASE("a name that is none of both is told with one like it and with all that are accepted") {
  const std::string told = refusal("seed_bilding");
  CHECK_THAT(told, Catch::StartsWith("seed_bilding: there is no such scenario or model") &&
                       Catch::Contains("seed_building") && Catch::Contains("accepted: a path to a file"));
  for (const std::string& name : structure::shipped_models()) CHECK_THAT(told, Catch::Contains(name));
  for (const std::string& name : structure::shipped_scenarios()) CHECK_THAT(told, Catch::Contains(name));
}

TEST_CASE("a building with other strengths is read anew from its file, and is the same where nothing changes") {
  const topple::test::ScratchFolder folder;
  std::ofstream(folder / "bay.json") << bay;
  const Scene scene = open_scene((folder / "bay.json").string());
  CHECK(building_with_strengths(scene, {}) == scene.building);
  structure::MaterialChange change;
  change.material = "S";
  change.strength = 1.5;
  const auto stronger = building_with_strengths(scene, {change});
  REQUIRE(stronger->materials.size() == 1);
  CHECK(stronger->materials[0].yield_strength == 352.5e6);
  CHECK(scene.building->materials[0].yield_strength == 235e6);
  CHECK(stronger->members.size() == 3);
}
