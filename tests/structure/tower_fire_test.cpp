// The tower on fire, up to the moment at which its posts give way: joints of the floor beams first, then posts over the
// height that the lost floors leave without bracing.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "topple/structure/files.h"
#include "topple/structure/simulation.h"

using namespace topple::structure;

TEST_CASE("fire takes the floor beams' joints first, then posts buckle over the storeys left without bracing") {
  auto [building, scenario] = read_scenario(find_scenario("tower_fire"));
  REQUIRE(scenario.failure.bracing == BracingRule::buckling);
  const auto fire = std::get<WeakenTool>(scenario.events.at(0).tool);
  const double begin = scenario.events.at(0).at;
  Simulation simulation(std::move(building), std::move(scenario));
  double worst = 0;
  for (const JointId joint : fire.joints) worst = std::max(worst, simulation.frame().utilisation(joint).value);
  // The first stage at which strength is below what the most used joint bears: cold, nothing else changes.
  const double stage = std::ceil((1 - worst) / (1 - fire.strength) * fire.stages);

  const auto is_post = [&](const SimulationEvent& event) {
    const Joint& joint = simulation.building()[event.joint.joint];
    return joint.member.valid() && simulation.building()[joint.member].kind == MemberKind::post;
  };
  std::vector<SimulationEvent> before;  // breaks up to the first post's
  bool post_broke = false;
  SimulationEvent post;
  std::size_t heard = 0;
  while (!simulation.finished() && !post_broke) {
    simulation.skip_idle();
    simulation.step();
    for (; heard < simulation.events().size() && !post_broke; ++heard) {
      const SimulationEvent& event = simulation.events()[heard];
      if (event.kind != SimulationEvent::Kind::joint_broke) continue;
      post_broke = is_post(event);
      if (post_broke)
        post = event;
      else
        before.push_back(event);
    }
  }
  REQUIRE(post_broke);
  REQUIRE(before.size() > 50);
  CHECK(before.front().time == Approx(begin + stage * fire.over / fire.stages).epsilon(1e-9));
  std::size_t of_fire = 0;
  for (const SimulationEvent& event : before)
    of_fire += std::find(fire.joints.begin(), fire.joints.end(), event.joint.joint) != fire.joints.end();
  CHECK(std::find(fire.joints.begin(), fire.joints.end(), before.front().joint.joint) != fire.joints.end());
  CHECK(of_fire > fire.joints.size() / 4);

  // The post that goes first buckles, over more than two storeys: pi^2 E I/(K L)^2 with its own E I tells the length.
  CHECK(post.joint.cause == BreakCause::buckling);
  CHECK(post.joint.demand > post.joint.capacity);
  const Building& tower = simulation.building();
  const Member& own = tower[tower[post.joint.joint].member];
  const Section& section = tower[own.section];
  const double euler = M_PI * M_PI * tower[own.material].youngs_modulus * std::min(section.Iy, section.Iz);
  const double buckling_length = std::sqrt(euler / post.joint.capacity), storey = 3.66;
  CHECK(buckling_length > 2 * storey);
  CHECK(buckling_length < 8 * storey);
  CHECK(post.position.z() > 12 * storey);  // its bulge lies at the floors that are gone
  CHECK(post.position.z() < 22 * storey);
}
