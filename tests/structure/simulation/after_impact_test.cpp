// What an impact sets going in a frame that moves is over within milliseconds, and decides what breaks next.
#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "structure/simulation_run.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/simulation.h"

using namespace topple::structure;
using topple::test::of_kind;

TEST_CASE("The joints that break after an impact, and their order, do not hang on the substep") {
  // The house's corner post is hit with 60 m/s, 95 mm aside of its axis: once the beam above has let go of it, whether
  // that breaks off at its other end too is decided by what swings for a millisecond.
  std::vector<std::vector<std::string>> broken;
  for (const int substeps : {8, 16, 32}) {
    auto [building, scenario] = read_scenario(find_scenario("house_hit"));
    auto& shot = std::get<Projectile>(scenario.events.front().tool);
    shot.from.y() = 0.0947;
    shot.from.z() = 1.8165;
    scenario.motion.substeps = substeps;
    scenario.duration = 1.4;  // it strikes at 1.33 s
    Simulation simulation(std::move(building), std::move(scenario));
    topple::test::run(simulation);
    std::vector<std::string>& names = broken.emplace_back();
    for (const SimulationEvent& event : of_kind(simulation, SimulationEvent::Kind::joint_broke))
      names.push_back(event.name);
    CHECK(names.size() >= 8);
    CHECK(names == broken.front());
  }
}

namespace {

/// A light ball takes a corner post of the house off its foot. It swings on the beams above, and leaves with one of
/// them; then the floor panel that lay on them does.
std::pair<Building, Scenario> light_hit(double aside, double height) {
  std::pair<Building, Scenario> scene = read_scenario(find_scenario("house_hit"));
  auto& shot = std::get<Projectile>(scene.second.events.front().tool);
  shot.mass = 65;
  shot.from.y() = aside;
  shot.from.z() = height;
  scene.second.duration = 1.6;
  return scene;
}

/// rad/s, of the floor panel over the post that is hit, in the first step in which it flies.
Vec3 spin_of_panel(int substeps) {
  auto [building, scenario] = light_hit(-0.0435, 2.1873);
  scenario.motion.substeps = substeps;
  Simulation simulation(std::move(building), std::move(scenario));
  std::optional<Eigen::Quaterniond> before;
  while (!simulation.finished()) {
    simulation.skip_idle();
    simulation.step();
    for (const BodyView& body : simulation.bodies()) {
      if (body.name != "H1/S-1-1-1") continue;
      if (before) {
        const Eigen::AngleAxisd turned(body.pose.orientation * before->inverse());
        return turned.angle() * turned.axis() / simulation.scenario().step;
      }
      before = body.pose.orientation;
    }
  }
  return Vec3::Zero();
}

}  // namespace

TEST_CASE("A panel leaves what swings turning as what bore it moved, however long the substep") {
  const Vec3 coarse = spin_of_panel(8), fine = spin_of_panel(32);
  // Its mass lay on beams of which those at the lost corner went down: so does that corner, by x and by y (its middle
  // is at positive x and y from there). The nodes that are left swing back within milliseconds, and turn nothing.
  for (const Vec3& spin : {coarse, fine}) {
    INFO("rad/s: " << spin.transpose());
    CHECK(spin.x() > 0.05);
    CHECK(spin.y() < -0.05);
  }
  // When the joint breaks, to a substep or two of 16 since it sank: an eighth.
  CHECK((coarse - fine).norm() < 0.125 * fine.norm());
}

namespace {

/// rad/s, in the mean from 0.07 to 0.12 s after the hit: the head of the corner post, on which that swings until it
/// leaves. A ball of 40 kg has taken it off its foot.
Vec3 swing_after_hit(double aside, double height, int substeps) {
  auto [building, scenario] = light_hit(aside, height);
  std::get<Projectile>(scenario.events.front().tool).mass = 40;
  scenario.motion.substeps = substeps;
  scenario.duration = 1.45;
  const auto post = std::find_if(building.members.begin(), building.members.end(),
                                 [](const Member& member) { return member.name == "H1/P-1-1-1"; });
  REQUIRE(post != building.members.end());
  const NodeId head = post->nodes[1];
  Simulation simulation(std::move(building), std::move(scenario));
  const auto turn_at = [&](double time) -> Vec3 {
    while (simulation.time() < time - 1e-9) simulation.step();
    return simulation.frame().displacement(head).tail<3>();
  };
  const Vec3 first = turn_at(1.4);
  return (turn_at(1.45) - first) / 0.05;
}

}  // namespace

TEST_CASE("A post that is hit swings off as fast with the substeps that a step has by itself as with shorter ones") {
  for (const auto& [aside, height] : {std::pair(-0.0055, 2.0223), std::pair(0.0085, 1.9928)}) {
    const Vec3 coarse = swing_after_hit(aside, height, 8), fine = swing_after_hit(aside, height, 64);
    INFO("rad/s: " << coarse.transpose() << ", " << fine.transpose());
    CHECK(fine.norm() > 0.5);
    CHECK((coarse - fine).norm() < 0.04 * fine.norm());
  }
}

TEST_CASE("What leaves a frame in motion goes on where it was, as it had turned by then") {
  auto [building, scenario] = light_hit(0.027, 1.8508);
  const auto named = std::find_if(building.members.begin(), building.members.end(),
                                  [](const Member& member) { return member.name == "H1/P-1-1-1"; });
  REQUIRE(named != building.members.end());
  const MemberId post(static_cast<std::size_t>(named - building.members.begin()));
  const NodeId top = building[post].nodes[1];
  const Vec3 head = building[top].position, foot = building[building[post].nodes[0]].position;
  Simulation simulation(std::move(building), std::move(scenario));
  std::optional<Vec3> foot_before;
  double turned = 0, fastest = 0;
  bool left = false;
  while (!simulation.finished() && !left) {
    simulation.skip_idle();
    simulation.step();
    for (const BodyView& body : simulation.bodies()) {
      if (std::find(body.members.begin(), body.members.end(), post) == body.members.end()) continue;
      left = true;
      REQUIRE(foot_before);
      const Vec3 now = body.pose.position + body.pose.orientation * (foot - body.rest_centre);
      INFO("it had turned by " << turned << " rad; its foot was at " << foot_before->transpose() << ", and is at "
                               << now.transpose());
      // In a step it goes on by no more than it did in the fastest one before, and a half.
      CHECK((now - *foot_before).norm() < 1.5 * fastest);
      CHECK(turned > 0.3);  // or nothing would tell
      CHECK(std::abs(Eigen::AngleAxisd(body.pose.orientation).angle() - turned) < 0.15);
    }
    if (left) break;
    // Its foot has let go: it goes with the node above.
    const Vec6& node = simulation.frame().displacement(top);
    const Vec3 turn = node.tail<3>(), place = foot + node.head<3>() + turn.cross(foot - head);
    if (foot_before) fastest = std::max(fastest, (place - *foot_before).norm());
    foot_before = place;
    turned = turn.norm();
  }
  CHECK(left);
}
