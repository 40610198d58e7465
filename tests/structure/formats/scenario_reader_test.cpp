// The scenario reader takes in every tool and rule that is built, and refuses the others by their name.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>

#include "example_model.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"

using namespace topple::structure;
using topple::test::replaced;

namespace {

const std::string scenario_text = R"({
  "topple": 1, "title": "Corner post hit", "model": "seed_building", "combination": "collapse",
  "step": 0.01, "duration": 2000, "until_rest": false, "seed": 7, "ground": -0.5, "standing": "dynamic",
  "failure": {"bracing": "none", "mechanism": "detach", "second_order": false},
  "dynamics": {"substeps": 4, "damping": 0.03, "spectral_radius": 0.9},
  "impact": {"restitution": 0.2, "structure_mass": false},
  "debris": {"friction": 0.5, "restitution": 0.3, "limit": 100, "smallest_volume": 0.01},
  "events": [
    {"at": 4.0, "charge": {"centre": [0, 0, 1], "radius": 3, "strength": [0.25, 0.75]}},
    {"at": 1.0, "projectile": {"from": [-20, 0, 2], "velocity": [60, 0, 0], "mass": 700, "radius": 0.3}},
    {"at": 2.0, "cut": {"joints": ["BX-1-1-1:1", "BX-*-1-1:1"]}},
    {"at": 3.0, "remove": {"members": ["P-1-2-1"], "panels": ["S-1-1-*"], "supports": ["N-1-1-0"], "groups": ["storey-2"]}},
    {"at": 7.0, "gravity": [0, 0, -9.80665]},
    {"at": 8.0, "load": {"nodes": {"N-1-1-6": {"x": 1e5}}}}
  ]
})";

std::pair<Building, Scenario> read(const std::string& text) {
  return parse_scenario(text, "s.json", std::filesystem::path());
}

std::string error_of(const std::string& text) {
  try {
    (void)read(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("a scenario is read in full, its events in order of time") {
  const auto [building, scenario] = read(scenario_text);
  CHECK(scenario.title == "Corner post hit");
  CHECK(building[*scenario.combination].name == "collapse");
  CHECK(scenario.step == 0.01);
  CHECK(scenario.duration == 2000);
  CHECK_FALSE(scenario.until_rest);
  CHECK(scenario.seed == 7);
  CHECK(scenario.ground == -0.5);
  CHECK(scenario.standing == StandingRule::dynamics);
  CHECK(scenario.failure.bracing == BracingRule::none);
  CHECK(scenario.failure.mechanism == MechanismRule::detach);
  CHECK(scenario.motion.substeps == 4);
  CHECK(scenario.motion.damping == 0.03);
  CHECK(scenario.motion.spectral_radius == 0.9);
  CHECK(scenario.impact.restitution == 0.2);
  CHECK_FALSE(scenario.impact.structure_mass);
  CHECK(scenario.debris.limit == 100);
  REQUIRE(scenario.events.size() == 6);
  CHECK(std::get<Projectile>(scenario.events[0].tool).mass == 700);
  const auto& cut = std::get<CutTool>(scenario.events[1].tool);
  REQUIRE(cut.joints.size() == 3);  // the pattern's three bays hold the name that stands beside it
  CHECK(building[cut.joints[0]].name == "BX-1-1-1:1");
  const auto& remove = std::get<RemoveTool>(scenario.events[2].tool);
  CHECK(remove.members.size() == 1 + 20 + 31);     // the post, and storey 2: 20 posts, 15 + 16 beams
  CHECK(remove.panels.size() == 6 + 12 + 14 - 1);  // S-1-1-2 is in both; storey 2 has 12 slabs and 14 walls
  CHECK(building[remove.supports.at(0)].name == "N-1-1-0");
  const auto& charge = std::get<ChargeTool>(scenario.events[3].tool);
  CHECK(charge.strength_at_centre == 0.25);
  CHECK(charge.strength_at_radius == 0.75);
  CHECK(std::get<GravityTool>(scenario.events[4].tool).gravity[2] == -9.80665);
  CHECK(std::get<LoadTool>(scenario.events[5].tool).nodes.at(0).load[0] == 1e5);
}

TEST_CASE("a scenario that says little takes the defaults") {
  const auto [building, scenario] = read(R"({"topple": 1, "model": "tower", "combination": "service"})");
  CHECK(scenario.step == 1.0 / 60.0);
  CHECK(scenario.duration == 60);
  CHECK(scenario.until_rest);
  CHECK(scenario.seed == 1);
  CHECK_FALSE(scenario.ground.has_value());
  CHECK(scenario.standing == StandingRule::dynamics);
  CHECK_FALSE(scenario.motion.substeps.has_value());
  CHECK_FALSE(scenario.motion.damping.has_value());
  CHECK(scenario.motion.spectral_radius == 0.8);
  CHECK(scenario.failure.sudden == 2);
  CHECK(scenario.impact.structure_mass);
  CHECK_FALSE(scenario.debris.limit.has_value());
  CHECK(scenario.events.empty());
}

TEST_CASE("the scenario reader names file, place, what it found and what is accepted") {
  const auto error = [](const std::string& from, const std::string& to) {
    return error_of(replaced(scenario_text, from, to));
  };
  const std::string unknown = error("\"seed_building\"", "\"seed_bilding\"");
  CHECK(unknown.starts_with(
      "s.json, line 2, model: seed_bilding: there is no such model (did you mean seed_building?); accepted: a path to "
      "a file, or a shipped one: \""));
  CHECK(unknown.find("\"seed_building\"") != std::string::npos);
  CHECK(error(", \"combination\": \"collapse\"", "") ==
        "s.json, line 1: the key \"combination\" is missing and the model has several; accepted: \"service\", "
        "\"collapse\"");
  CHECK(error("\"substeps\": 4", "\"substeps\": 0") ==
        "s.json, line 5, dynamics.substeps: found 0; accepted: a whole number from 1 to 1000");
  CHECK(error("\"damping\": 0.03", "\"damping\": -0.03") ==
        "s.json, line 5, dynamics.damping: found -0.03; accepted: a number from 0 to 1");
  CHECK(error("\"BX-1-1-1:1\"", "\"BX-1-1-1:3\"") ==
        "s.json, line 11, events[2].cut.joints[0]: there is no joint \"BX-1-1-1:3\"; accepted: a name or pattern of "
        "the model");
  CHECK(error("{\"at\": 4.0, ", "{\"at\": 4.0, \"cut\": {\"joints\": [\"P-1-1-1:1\"]}, ").find("found 2 tools") !=
        std::string::npos);
  CHECK(error("\"limit\": 100", "\"limit\": 1.5") ==
        "s.json, line 7, debris.limit: found 1.5; accepted: a whole number from 0 to 1000000");
  CHECK(error("\"limit\": 100", "\"limit\": \"none\"") ==
        "s.json, line 7, debris.limit: found \"none\"; accepted: a whole number from 0 to 1000000, or null for none");
}

TEST_CASE("keys that bounded what a step computes are refused, and it is said whose the pace is") {
  const std::string why =
      "a step computes all that happens in it, and the pace of the steps is the host's; leave the key out";
  CHECK(error_of(replaced(scenario_text, "\"events\"", "\"budget\": {\"operations\": 5e8}, \"events\"")) ==
        "s.json, line 8, budget: nothing limits what a step may compute any more: " + why);
  CHECK(error_of(replaced(scenario_text, "\"none\"", "\"none\", \"generations_per_second\": 240")) ==
        "s.json, line 4, failure.generations_per_second: nothing limits what may break in a step any more: " + why);
}

TEST_CASE("what stands moves in time, or has a factor of sudden losses: each takes its own keys alone") {
  const std::string still = replaced(scenario_text, "\"standing\": \"dynamic\"", "\"standing\": \"static\"");
  CHECK(
      error_of(still) ==
      "s.json, line 5, dynamics: what stands does not move in time with \"standing\": \"static\"; accepted: one of the "
      "two");
  CHECK(
      error_of(replaced(scenario_text, "\"none\"", "\"none\", \"sudden\": 1.5")) ==
      "s.json, line 4, failure.sudden: a factor of sudden losses acts with \"standing\": \"static\" alone: what moves "
      "overshoots by itself");
  const std::string of_statics =
      R"({"topple": 1, "model": "tower", "combination": "service", "standing": "static", "failure": {"sudden": 1.5}})";
  CHECK(read(of_statics).second.failure.sudden == 1.5);
  CHECK(error_of(replaced(of_statics, "1.5", "0.5")) ==
        "s.json, line 1, failure.sudden: found 0.5; accepted: a number from 1 to 10");
}

TEST_CASE("rules of failure and fracture are read, others told by what is accepted") {
  const auto error = [](const std::string& from, const std::string& to) {
    return error_of(replaced(scenario_text, from, to));
  };
  CHECK(error("\"none\"", "\"buckling\"") == "no error");
  CHECK(error("\"detach\"", "\"hinge\"") == "no error");
  CHECK(error("\"second_order\": false", "\"second_order\": true") == "no error");
  CHECK(error("\"impact\"", "\"fracture\": {\"method\": \"voronoi\"}, \"impact\"") == "no error");
  CHECK(error("\"impact\"", "\"fracture\": {\"method\": \"saw\"}, \"impact\"") ==
        "s.json, line 6, fracture.method: found \"saw\"; accepted: \"voronoi\", \"quadrilateral\" or \"local\"");
}

TEST_CASE("tools over time, on a cable and inside members are read") {
  const auto [building, scenario] =
      read(R"({"topple": 1, "model": "seed_building", "combination": "collapse", "events": [
    {"at": 1, "weaken": {"groups": ["storey-3", "storey-4"], "joints": ["P-1-1-1:*"], "strength": 0.4, "stiffness": 0.6, "over": 1800, "stages": 60}},
    {"at": 2, "wrecking_ball": {"anchor": [10, -4, 30], "cable": 22, "from": [10, -24, 20.84], "mass": 2000, "radius": 0.7}},
    {"at": 3, "cut": {"members": [{"member": "P-2-1-1", "where": 0.5}, {"member": "P-3-1-*", "where": 0}]}},
    {"at": 4, "remove": {"members": ["P-2-1-1"]}}]})");
  REQUIRE(scenario.events.size() == 4);
  const auto& weaken = std::get<WeakenTool>(scenario.events[0].tool);
  const NameIndex names(building);
  const std::size_t members = 2 * (20 + 31),
                    panels = names.group("storey-3")->panels.size() + names.group("storey-4")->panels.size();
  CHECK(weaken.members.size() == members);
  CHECK(weaken.joints.size() == 2 * members + 4 * panels + 2);
  CHECK(weaken.strength == 0.4);
  CHECK(weaken.stiffness == 0.6);
  CHECK(weaken.over == 1800);
  CHECK(weaken.stages == 60);
  const auto& ball = std::get<WreckingBall>(scenario.events[1].tool);
  CHECK(ball.cable == 22);
  CHECK(ball.mass == 2000);
  const auto& cut = std::get<CutTool>(scenario.events[2].tool);
  REQUIRE(cut.joints.size() == 1 + 6);  // one inside, six storeys at the foot
  CHECK(std::count_if(cut.joints.begin(), cut.joints.end(),
                      [&](JointId id) { return building[id].name == "P-2-1-1/cut-1:1"; }) == 1);
  CHECK(std::get<RemoveTool>(scenario.events[3].tool).members.size() == 2);  // both pieces

  const auto error = [](const std::string& tool) {
    return error_of(R"({"topple": 1, "model": "seed_building", "combination": "collapse", "events": [{"at": 1, )" +
                    tool + "}]}");
  };
  CHECK(
      error(R"("cut": {"members": [{"member": "P-2-1-1", "where": 0.999}]})") ==
      "s.json, line 1, events[0].cut.members[0].where: found 0.999; accepted: a fraction of the member's length from 0 "
      "to 1, within 0.01 of an end only 0 or 1");
  CHECK(error(R"("weaken": {"groups": ["storey-3"]})").find("nothing weakens") != std::string::npos);
  CHECK(error(R"("weaken": {"groups": ["storey-33"], "strength": 0})").find("no group \"storey-33\"") !=
        std::string::npos);
  CHECK(error(R"("wrecking_ball": {"anchor": [0, 0, 30], "cable": 5, "from": [0, -24, 20]})")
            .find("events[0].wrecking_ball.cable: the ball begins 26") != std::string::npos);
}

TEST_CASE("every shipped scenario is read") {
  for (const std::string name :
       {"seed_idle", "seed_hit", "tower_hit", "tower_10x10x40_corner", "bridge_hit", "house_hit", "street_hit"}) {
    CAPTURE(name);
    const auto file = find_scenario(name);
    CHECK(is_scenario(file));
    CHECK_NOTHROW(read_scenario(file));
  }
  CHECK_FALSE(is_scenario(find_model("tower")));
}

TEST_CASE("who asks for a model's name as a scenario is told that it is one, and which scenarios it has") {
  const auto told = [](const char* name) {
    try {
      (void)find_scenario(name);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  CHECK_THAT(told("hall"), Catch::StartsWith("hall: there is no such scenario (it is a model: its scenarios are "
                                             "\"hall_buckling\", \"hall_classic\"; topple-viewer takes it as it is)"));
  CHECK_THAT(told("la3"),
             Catch::StartsWith("la3: there is no such scenario (it is a model: no shipped scenario has it"));
  CHECK_THAT(told("hal"), !Catch::Contains("it is a model"));
}
