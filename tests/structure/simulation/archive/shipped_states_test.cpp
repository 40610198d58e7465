// Shipped scenarios, saved at rest, within the impact, falling and lying: each state goes on as the run that it is of.
#include <catch2/catch.hpp>

#include "goes_on_alike.h"
#include "topple/structure/formats/files.h"

using namespace topple::structure;
using topple::test::goes_on_alike;
using topple::test::SavedRun;

namespace {

std::function<Simulation()> shipped(const std::string& name, double duration,
                                    const std::function<void(Building&, Scenario&)>& change = {}) {
  return [=] {
    auto [building, scenario] = read_scenario(find_scenario(name));
    scenario.duration = duration;
    if (change) change(building, scenario);
    return Simulation(std::move(building), std::move(scenario));
  };
}

}  // namespace

TEST_CASE("a state of the seed building's hit goes on alike: before it, within it, falling, lying") {
  goes_on_alike({shipped("seed_hit", 3.5), {0, 1.34, 1.5, 2.1, 3.1}});
}

TEST_CASE("a state of the house's hit goes on alike") {
  goes_on_alike({shipped("house_hit", 2.6), {1.3, 1.35, 1.6, 2.4}});
}

TEST_CASE("a state of the bridge's hit goes on alike") {
  goes_on_alike({shipped("bridge_hit", 2.6), {1.3, 1.42, 1.8, 2.4}});
}

TEST_CASE("a state of panels that break where they stand, fall and land goes on alike") {
  goes_on_alike({shipped("seed_hit_fracture", 2.5), {1.36, 1.6, 2.2}});
}

TEST_CASE("a state of a wall that is broken through goes on alike, by each method") {
  for (const char* name : {"wall_hit", "wall_hit_local", "wall_hit_quadrilateral"})
    goes_on_alike({shipped(name, 5), {0.6, 0.7, 0.8, 1.5, 4}});
}

TEST_CASE("a state of shells under static standing goes on alike") {
  goes_on_alike({shipped("shell_house_hit", 3), {0.65, 0.75, 1.6, 2.7}});
}

TEST_CASE("a state of shells that move goes on alike") {
  goes_on_alike({shipped("shell_house_hit", 1.1,
                         [](Building&, Scenario& scenario) { scenario.standing = StandingRule::dynamics; }),
                 {0.68, 0.9}});
}

TEST_CASE("a state of hinges that hold, turn and break goes on alike") {
  goes_on_alike({shipped("steel_frame_hinges", 6.5), {0.55, 1, 3, 4.1, 5.2}});
}

TEST_CASE("a state of a hall under second-order statics goes on alike") {
  for (const char* name : {"hall_buckling", "hall_classic"})
    goes_on_alike({shipped(name, 5), {0, 1.1, 1.58, 2.2, 3.5}});
}

TEST_CASE("a state goes on alike where a limit removes what lies") {
  goes_on_alike({shipped("house_hit", 6, [](Building&, Scenario& scenario) { scenario.debris.limit = 4; }), {2, 4, 5}});
}

TEST_CASE("a state goes on alike where joints yield") {
  const auto ductile = [](Building& building, Scenario&) {
    for (Joint& joint : building.joints)
      if (joint.member.valid() && building[joint.member].kind == MemberKind::beam && joint.capacity.breakable)
        for (const std::size_t sense : {5u, 6u}) joint.capacity.ductility[sense] = 0.03;
  };
  goes_on_alike({shipped("seed_hit", 2.2, ductile), {1.36, 1.6, 2}});
  goes_on_alike({shipped("seed_hit", 2.6,
                         [&](Building& building, Scenario& scenario) {
                           ductile(building, scenario);
                           scenario.standing = StandingRule::statics;
                         }),
                 {1.36, 1.8, 2.4}});
}
