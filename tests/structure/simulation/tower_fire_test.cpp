// The tower on fire, up to the moment at which its posts give way: joints of the floor beams first, then posts over the
// height that the lost floors leave without bracing.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <optional>

#include "topple/structure/formats/files.h"
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

  const Building& tower = simulation.building();
  constexpr double storey = 3.66, burning = 18 * storey, above = 21 * storey;
  const auto is_post = [&](const SimulationEvent& event) {
    const Joint& joint = tower[event.joint.joint];
    return joint.member.valid() && tower[joint.member].kind == MemberKind::post;
  };
  const auto from_above = [&](const SimulationEvent& event) {
    return std::count_if(event.members.begin(), event.members.end(), [&](MemberId member) {
      return tower[tower[member].nodes[0]].position.z() > above && tower[tower[member].nodes[1]].position.z() > above;
    });
  };
  // Breaks up to the first post's, the first post that buckles (and all in the same step), and the part above that
  // comes off.
  std::vector<SimulationEvent> before;
  std::vector<double> bulges, floors_lost;  // heights; of joints of floors that broke
  std::optional<SimulationEvent> first_post, buckled, falls;
  std::size_t heard = 0;
  while (!simulation.finished() && !(buckled && falls)) {
    simulation.skip_idle();
    simulation.step();
    for (; heard < simulation.events().size(); ++heard) {
      const SimulationEvent& event = simulation.events()[heard];
      if (event.kind == SimulationEvent::Kind::detached && !falls && from_above(event) > 50) falls = event;
      if (event.kind != SimulationEvent::Kind::joint_broke) continue;
      if (!is_post(event)) {
        if (!first_post) before.push_back(event);
        floors_lost.push_back(event.position.z());
        continue;
      }
      if (!first_post) first_post = event;
      if (event.joint.cause != BreakCause::buckling) continue;
      if (!buckled) buckled = event;
      if (event.time == buckled->time) bulges.push_back(event.position.z());
    }
    // Floors that fall on floors tear some posts off first; the others have a second to buckle.
    if (first_post) REQUIRE(simulation.time() < first_post->time + 3);
  }
  REQUIRE(first_post);
  REQUIRE(before.size() > 50);
  CHECK(before.front().time == Approx(begin + stage * fire.over / fire.stages).epsilon(1e-9));
  std::size_t of_fire = 0;
  for (const SimulationEvent& event : before)
    of_fire += std::find(fire.joints.begin(), fire.joints.end(), event.joint.joint) != fire.joints.end();
  CHECK(std::find(fire.joints.begin(), fire.joints.end(), before.front().joint.joint) != fire.joints.end());
  CHECK(of_fire > fire.joints.size() / 4);

  // It buckles over more than two storeys and no more than those that have lost floors: pi^2 E I/(K L)^2 with its own
  // E I tells the length.
  REQUIRE(buckled);
  CHECK(buckled->joint.demand > buckled->joint.capacity);
  const Member& own = tower[tower[buckled->joint.joint].member];
  const Section& section = tower[own.section];
  const double euler = M_PI * M_PI * tower[own.material].youngs_modulus * std::min(section.Iy, section.Iz);
  const double buckling_length = std::sqrt(euler / buckled->joint.capacity);
  CHECK(buckling_length > 2 * storey);
  const auto [lowest, highest] = std::minmax_element(floors_lost.begin(), floors_lost.end());
  CHECK(buckling_length < *highest - *lowest + 2 * storey);  // held by the floors below and above
  // Bulges lie where floors have let go: at the fire, and where what fell has taken the bracing of posts below and
  // above. How many there are of each hangs on who falls on whom.
  const auto at_the_fire = [&](double height) { return height > 12 * storey && height < 22 * storey; };
  CHECK(std::any_of(bulges.begin(), bulges.end(), at_the_fire));
  for (const double bulge : bulges)
    CHECK(std::any_of(floors_lost.begin(), floors_lost.end(),
                      [&](double height) { return std::abs(height - bulge) < 1.01 * storey; }));

  // More than fifty members from above the fire come off together, and half a second later they fall.
  REQUIRE(falls);
  CHECK(falls->time >= first_post->time);
  const double came_off = simulation.time();
  while (simulation.time() < came_off + 0.5) simulation.step();
  std::map<std::int64_t, double> height;
  for (const BodyView& body : simulation.bodies())
    if (body.pose.position.z() > burning && body.mass > 20e3) height[body.id.value] = body.pose.position.z();
  const double before_step = simulation.time();
  simulation.step();
  double fastest = 0;
  for (const BodyView& body : simulation.bodies())
    if (const auto was = height.find(body.id.value); was != height.end())
      fastest = std::max(fastest, (was->second - body.pose.position.z()) / (simulation.time() - before_step));
  CHECK(fastest > 2);  // m/s; free fall would be 4.9, and neighbours hold some of it back
}
