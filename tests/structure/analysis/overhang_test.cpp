// Overhangs break off: what lost its support and hangs over parts at the joint that statics by hand finds.
#include <catch2/catch.hpp>
#include <cmath>
#include <utility>

#include "frame_builder.h"
#include "topple/structure/simulation.h"

using namespace topple::structure;
using topple::test::FrameBuilder;

namespace {

constexpr double weight = 2000;    // N/m
constexpr int bays = 6, held = 2;  ///< of them over supports to the end

/// Bay k of a floor that hangs over farther and farther, its bays growing outwards.
double bay(int k) { return 3 + 0.4 * k; }

double from_wall(int node) {
  double x = 0;
  for (int k = 0; k < node; ++k) x += bay(k);
  return x;
}

/// Moment capacity of the joint at the inner end of bay k.
using Capacity = double (*)(int k);
double uniform(int) { return 60e3; }
/// Falls outwards faster than the moment of a long overhang does, slower than that of a short one.
double tapered(int k) { return 1e6 / std::pow(2.3, k); }

/// A beam over supports at nodes 0 to `bays`, 8 m up; each bay's inner end has a capacity in bending alone.
FrameBuilder floor(Capacity capacity) {
  FrameBuilder f;
  std::vector<NodeId> nodes;
  for (int k = 0; k <= bays; ++k) nodes.push_back(f.node("N" + std::to_string(k), from_wall(k), 0, 8));
  for (int k = 0; k < bays; ++k) {
    JointCapacity joint;
    joint.breakable = true;
    joint.value.fill(unlimited);
    joint.value[static_cast<std::size_t>(Sense::moment_y)] = capacity(k);
    f.member("B" + std::to_string(k), MemberKind::beam, nodes[static_cast<std::size_t>(k)],
             nodes[static_cast<std::size_t>(k) + 1], k < held ? JointCapacity{} : joint, {});
    f.load(MemberId(static_cast<std::size_t>(k)), -weight);
  }
  f.support(nodes[0]);
  for (int k = 1; k <= bays; ++k) {
    Vec6 roller = Vec6::Zero();
    roller(1) = roller(2) = roller(3) = unlimited;
    f.building.supports.push_back({nodes[static_cast<std::size_t>(k)], roller});
  }
  return f;
}

struct Expected {
  int supports_gone = 0, bay = -1;  ///< the bay whose inner joint breaks
};

/// Supports go from the tip, so many together. Beyond the last one everything is statically determinate: moment w x^2/2
/// at x from the tip.
Expected by_hand(Capacity capacity, int together) {
  for (int last = bays - together; last >= held; last -= together) {
    Expected found{bays - last, -1};
    double most = 1;
    for (int k = last; k < bays; ++k) {
      const double x = from_wall(bays) - from_wall(k), used = weight * x * x / 2 / capacity(k);
      if (used > most) {
        most = used;
        found.bay = k;
      }
    }
    if (found.bay >= 0) return found;
  }
  return {};
}

}  // namespace

TEST_CASE("an overhang that grows bay by bay breaks off at the joint that w x2/2 finds, and falls") {
  for (const auto& [capacity, together] : {std::pair<Capacity, int>(uniform, 1), {tapered, 3}}) {
    const Expected expected = by_hand(capacity, together);
    REQUIRE(expected.bay >= held);
    Scenario scenario;
    scenario.standing = StandingRule::statics;
    scenario.combination = CombinationId(0u);
    scenario.ground = 0;
    scenario.duration = 30;
    scenario.failure.sudden = 1;  // the overhang is let down slowly
    scenario.failure.bracing = BracingRule::none;
    const FrameBuilder f = floor(capacity);
    for (int s = 0; s < expected.supports_gone; ++s) {
      RemoveTool remove;
      remove.supports = {NodeId(static_cast<std::size_t>(bays - s))};
      scenario.events.push_back({1.0 + s / together, remove});
    }
    Simulation simulation(f.building, scenario);
    while (!simulation.finished()) {
      simulation.skip_idle();
      simulation.step();
    }
    std::vector<SimulationEvent> broke, left;
    for (const SimulationEvent& event : simulation.events()) {
      if (event.kind == SimulationEvent::Kind::joint_broke && event.joint.cause == BreakCause::overload)
        broke.push_back(event);
      if (event.kind == SimulationEvent::Kind::detached) left.push_back(event);
    }
    REQUIRE(broke.size() == 1);
    CHECK(broke[0].name == "B" + std::to_string(expected.bay) + ":1");
    CHECK(broke[0].time == Approx(expected.supports_gone / together).epsilon(1e-9));  // with the last that went
    const double x = from_wall(bays) - from_wall(expected.bay);
    // Bending of slender members over rigid supports: equilibrium alone, to the solver's rounding.
    CHECK(std::abs(broke[0].joint.demand) == Approx(weight * x * x / 2).epsilon(1e-8));
    REQUIRE(left.size() == 1);
    CHECK(left[0].members.size() == static_cast<std::size_t>(bays - expected.bay));
    CHECK(left[0].mass == Approx(weight * x / 10).epsilon(1e-9));
    for (int k = 0; k < bays; ++k)
      CHECK(simulation.frame().stands(MemberId(static_cast<std::size_t>(k))) == (k < expected.bay));
    REQUIRE(simulation.bodies().size() >= 1);
    for (const BodyView& body : simulation.bodies()) CHECK(body.pose.position.z() < 1);  // it lies on the ground
  }
}

TEST_CASE("the tapered floor breaks inside its overhang, the uniform one at its last support") {
  CHECK(by_hand(uniform, 1).bay == bays - by_hand(uniform, 1).supports_gone);
  CHECK(by_hand(tapered, 3).bay > bays - by_hand(tapered, 3).supports_gone);
}
