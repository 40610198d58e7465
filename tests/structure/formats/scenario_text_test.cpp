// Scenarios and tools for a building that a host has already.
#include "topple/structure/formats/scenario_text.h"

#include <catch2/catch.hpp>

#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"

using namespace topple::structure;

namespace {

Building seed() { return read_model(find_model("seed_building"), Purpose::demolish); }

}  // namespace

TEST_CASE("a scenario of a building that is there is that of its file") {
  const std::string events = R"("combination": "collapse", "events": [{"at": 1, "remove": {"members": ["P-1-1-1"]}}]})";
  const auto [by_name, named] =
      parse_scenario(R"({"topple": 1, "model": "seed_building", )" + events, "s", std::filesystem::path());
  const auto [given, scenario] = parse_scenario(R"({"topple": 1, )" + events, "s", seed());
  CHECK(given.members.size() == by_name.members.size());
  REQUIRE(scenario.events.size() == 1);
  CHECK(std::get<RemoveTool>(scenario.events[0].tool).members == std::get<RemoveTool>(named.events[0].tool).members);
  CHECK(scenario.combination == named.combination);
  CHECK_THROWS_WITH(parse_scenario(R"({"topple": 2})", "s", seed()), Catch::Contains("the version of the format"));
}

TEST_CASE("members are divided where a scenario of a given building cuts them") {
  const auto [building, scenario] = parse_scenario(
      R"({"topple": 1, "combination": "collapse", "events": [{"at": 1, "cut": {"members": [{"member": "P-1-1-1", "where": 0.5}]}}]})",
      "s", seed());
  CHECK(NameIndex(building).member("P-1-1-1/2").has_value());
  CHECK(std::get<CutTool>(scenario.events[0].tool).joints.size() == 1);
}

TEST_CASE("a tool is read as an event of a scenario has it") {
  const Building building = seed();
  const auto projectile = std::get<Projectile>(
      parse_tool(R"({"projectile": {"from": [-20, 0, 2], "velocity": [60, 0, 0], "mass": 7}})", "tool", building));
  CHECK(projectile.from == Vec3(-20, 0, 2));
  CHECK(projectile.mass == 7);
  CHECK(projectile.radius == Projectile().radius);
  const auto cut = std::get<CutTool>(parse_tool(
      R"({"cut": {"joints": ["P-1-1-1:1"], "members": [{"member": "P-1-1-2", "where": 1}]}})", "tool", building));
  const NameIndex names(building);
  CHECK(cut.joints == std::vector{*names.joint("P-1-1-1:1"), *names.joint("P-1-1-2:2")});
  for (const auto& [text, problem] :
       {std::pair{R"({"cut": {"members": [{"member": "P-1-1-1", "where": 0.5}]}})",
                  "cut.members[0].where: found 0.5; accepted: 0 or 1"},
        {R"({"cut": {"members": [{"member": "Q", "where": 0}]}})", "there is no member \"Q\""},
        {R"({"gravity": [0, 0, -9], "load": {"nodes": {}}})", "found 2 tools; accepted: one"},
        {R"({})", "found 0 tools; accepted: one"},
        {R"({"hammer": {}})", "unknown key"},
        {R"([])", "found an array of 0"}})
    CHECK_THROWS_WITH(parse_tool(text, "tool", building), Catch::Contains(problem));
}
