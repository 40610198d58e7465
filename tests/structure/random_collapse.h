#pragma once
// Random buildings under random tools at random times, run to rest, and what must hold of every one.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "structure/frame_builder.h"
#include "topple/structure/simulation.h"

namespace topple::test {

/// SplitMix64 (Steele, Lea and Flood 2014): the same numbers everywhere.
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  double from(double low, double high) {
    return low + (high - low) * static_cast<double>(bits() >> 11) * std::ldexp(1.0, -53);
  }
  int below(int count) { return static_cast<int>(bits() % static_cast<std::uint64_t>(count)); }
  template <class Id>
  Id one_of(std::size_t count) {
    return Id(static_cast<std::size_t>(below(static_cast<int>(count))));
  }

 private:
  std::uint64_t state_;
};

struct RandomCollapse {
  Building building;
  Scenario scenario;
};

inline Tool random_tool(RandomNumbers& random, const Building& building, const Vec3& size) {
  const auto inside = [&] {
    return Vec3(random.from(0, size.x()), random.from(0, size.y()), random.from(0, size.z()));
  };
  switch (random.below(8)) {
    case 0:
    case 1: {
      const Vec3 target = inside();
      const double angle = random.from(0, 2 * M_PI);
      const Vec3 away(std::cos(angle), std::sin(angle), random.from(0, 0.6));
      Projectile ball;
      ball.from = target + 25 * away;
      ball.from.z() = std::max(ball.from.z(), 1.0);
      ball.velocity = (target - ball.from).normalized() * random.from(10, 80);
      ball.mass = random.from(100, 2000);
      ball.radius = random.from(0.2, 0.6);
      return ball;
    }
    case 2: {
      WreckingBall ball;
      ball.anchor = Vec3(-2, random.from(0, size.y()), size.z() + 12);
      ball.cable = random.from(11, 12 + 0.7 * size.z());
      const double angle = random.from(0.4, 1.2);
      ball.from = ball.anchor + ball.cable * Vec3(-std::sin(angle), 0, -std::cos(angle));
      ball.cable = std::max(ball.cable, (ball.from - ball.anchor).norm());  // rounding
      ball.mass = random.from(500, 3000);
      ball.radius = 0.6;
      return ball;
    }
    case 3: {
      CutTool cut;
      for (int n = 0; n < 3; ++n) cut.joints.push_back(random.one_of<JointId>(2 * building.members.size()));
      std::sort(cut.joints.begin(), cut.joints.end());
      cut.joints.erase(std::unique(cut.joints.begin(), cut.joints.end()), cut.joints.end());
      return cut;
    }
    case 4: {
      RemoveTool remove;
      remove.members = {random.one_of<MemberId>(building.members.size())};
      if (random.below(3) == 0)
        remove.supports = {
            building.supports[static_cast<std::size_t>(random.below(static_cast<int>(building.supports.size())))].node};
      return remove;
    }
    case 5: {
      ChargeTool charge;
      charge.centre = inside();
      charge.radius = random.from(1, 5);
      charge.strength_at_centre = random.from(0, 0.3);
      return charge;
    }
    case 6: {
      WeakenTool weaken;
      for (int n = 0; n < 6; ++n) weaken.members.push_back(random.one_of<MemberId>(building.members.size()));
      std::sort(weaken.members.begin(), weaken.members.end());
      weaken.members.erase(std::unique(weaken.members.begin(), weaken.members.end()), weaken.members.end());
      for (const MemberId member : weaken.members)
        for (int end = 0; end < 2; ++end) weaken.joints.push_back(building.joint(member, end));
      weaken.strength = random.from(0, 0.5);
      weaken.stiffness = random.from(0.2, 1);
      weaken.over = random.from(0, 100);
      weaken.stages = 1 + random.below(5);
      return weaken;
    }
    default: {
      LoadTool load;
      Vec6 push = Vec6::Zero();
      push(random.below(3)) = random.from(-2e5, 1e5);
      load.nodes = {{random.one_of<NodeId>(building.nodes.size()), push}};
      return load;
    }
  }
}

/// Rules of failure, joints that turn before they break, beams on pins.
inline void choose_rules(RandomNumbers& random, RandomCollapse& collapse) {
  FailureRules& rules = collapse.scenario.failure;
  constexpr BracingRule bracing[] = {BracingRule::classic, BracingRule::buckling, BracingRule::none};
  rules.bracing = bracing[random.below(3)];
  if (random.below(2) == 0) rules.mechanism = MechanismRule::hinge;
  if (random.below(4) == 0) rules.second_order = true;
  const bool ductile = random.below(3) == 0, pinned = random.below(3) == 0;
  for (Joint& joint : collapse.building.joints) {
    if (!joint.member.valid() || collapse.building[joint.member].kind != MemberKind::beam) continue;
    if (ductile)
      for (const Sense sense : {Sense::moment_y, Sense::moment_z})
        joint.capacity.ductility[static_cast<std::size_t>(sense)] = 0.02;
    // One end alone: with both on pins many of these frames would not stand.
    if (pinned && joint.end == 0 && random.below(3) == 0) joint.stiffness(4) = 0;
  }
}

/// Floors that break, by numbers of their own.
inline void choose_fracture(std::uint64_t seed, RandomCollapse& collapse) {
  RandomNumbers random(~seed);
  if (collapse.building.panels.empty() || random.below(3) == 0) return;
  constexpr fracture::Method methods[] = {fracture::Method::voronoi, fracture::Method::quadrilateral,
                                          fracture::Method::local};
  fracture::PanelSettings settings;
  settings.method = methods[random.below(3)];
  settings.cell = random.from(0.5, 2);
  settings.local.length = {random.from(0.2, 0.5), random.from(0.6, 1.5)};
  settings.local.ring = random.from(0.3, 1);
  collapse.scenario.fracture = settings;
  for (Material& material : collapse.building.materials) material.compressive_strength = random.from(15e6, 50e6);
  if (random.below(3) == 0) collapse.scenario.debris.smallest_volume = random.from(0, 0.05);
}

inline RandomCollapse random_collapse(std::uint64_t seed) {
  RandomNumbers random(seed);
  const int nx = 2 + random.below(3), ny = 2 + random.below(2), storeys = 1 + random.below(4);
  const double bay = random.from(3, 7), height = random.from(2.5, 4.5);
  FrameBuilder frame = grid_building(nx, ny, storeys, bay, height, same_capacity(random.from(1e5, 8e5)),
                                     same_capacity(random.from(0.8e5, 3e5)));
  const double weight = random.from(1e3, 6e3);
  for (std::size_t m = 0; m < frame.building.members.size(); ++m) frame.load(MemberId(m), -weight);
  if (random.below(2) == 0)
    for (int k = 1; k <= storeys; ++k)
      for (int i = 0; i + 1 < nx; ++i)
        for (int j = 0; j + 1 < ny; ++j) {
          const auto at = [&](int a, int b) { return NodeId(static_cast<std::size_t>((k * ny + b) * nx + a)); };
          JointCapacity edge = same_capacity(random.from(3e4, 3e5));
          const PanelId slab =
              frame.panel("S-" + std::to_string(i) + "-" + std::to_string(j) + "-" + std::to_string(k),
                          PanelModel::membrane, {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}, edge);
          frame.load(slab, random.from(500, 4000));
        }
  RandomCollapse collapse{frame.building, {}};
  Scenario& scenario = collapse.scenario;
  scenario.standing = StandingRule::statics;
  scenario.combination = CombinationId(0u);
  scenario.duration = 600;
  scenario.ground = 0;
  scenario.seed = seed;
  if (random.below(4) == 0) scenario.debris.limit = 5 + random.below(20);
  const Vec3 size((nx - 1) * bay, (ny - 1) * bay, storeys * height);
  const int tools = 1 + random.below(4);
  for (int t = 0; t < tools; ++t)
    scenario.events.push_back({random.from(0, 4), random_tool(random, collapse.building, size)});
  std::stable_sort(scenario.events.begin(), scenario.events.end(),
                   [](const Event& a, const Event& b) { return a.at < b.at; });
  choose_rules(random, collapse);
  choose_fracture(seed, collapse);
  return collapse;
}

/// What is wrong with it; empty when nothing is. `most_lost`: share of energy that may be left over.
inline std::string fault_of(RandomCollapse collapse, double most_lost = unlimited) {
  // A ball on a cable swings on to the end.
  const auto& events = collapse.scenario.events;
  const bool swings = std::any_of(events.begin(), events.end(),
                                  [](const Event& event) { return std::holds_alternative<WreckingBall>(event.tool); });
  if (swings) collapse.scenario.duration = 60;
  const bool hinges = collapse.scenario.failure.mechanism == MechanismRule::hinge;
  const double duration = collapse.scenario.duration;
  Simulation simulation(std::move(collapse.building), std::move(collapse.scenario));
  constexpr double deepest = 0.5;  // m below the ground for a centre of mass: nothing here is thicker
  double below = 0;
  while (!simulation.finished()) {
    simulation.skip_idle();
    simulation.step();
    for (const BodyView& body : simulation.bodies()) {
      if (!body.pose.position.allFinite() || !body.pose.orientation.coeffs().allFinite())
        return "a body's pose is not finite at " + std::to_string(simulation.time()) + " s";
      below = std::min(below, body.pose.position.z());
    }
  }
  const StandingFrame& frame = simulation.frame();
  for (std::size_t n = 0; n < simulation.building().nodes.size(); ++n)
    if (frame.stands(NodeId(n)) && !frame.displacement(NodeId(n)).allFinite()) return "a displacement is not finite";
  // What hangs on hinges swings on, as they take no energy; it must have found its way long since.
  const auto broke_late = [&](const SimulationEvent& event) {
    using Kind = SimulationEvent::Kind;
    return event.time > duration / 2 && (event.kind == Kind::joint_broke || event.kind == Kind::split ||
                                         event.kind == Kind::detached || event.kind == Kind::panel_fractured);
  };
  const auto& told = simulation.events();
  if (!swings && !simulation.at_rest() && (!hinges || std::any_of(told.begin(), told.end(), broke_late)))
    return "not at rest after 600 s";
  if (below < -deepest) return "a body was " + std::to_string(-below) + " m below the ground";
  const Ledger& ledger = simulation.ledger();
  if (!(ledger.momentum_error < 1e-10)) return "momentum error " + std::to_string(ledger.momentum_error);
  // More out than in: energy that came from nowhere. 1 % is what the default step may leave open.
  if (!(ledger.residual() > -0.01)) return "energy gained: residual " + std::to_string(ledger.residual());
  if (!(ledger.residual() < most_lost)) return "energy lost: residual " + std::to_string(ledger.residual());
  return {};
}

inline std::string fault_of_collapse(std::uint64_t seed) { return fault_of(random_collapse(seed)); }

/// The same where what stands moves.
inline std::string fault_of_moving_collapse(std::uint64_t seed) {
  RandomCollapse collapse = random_collapse(seed);
  collapse.scenario.standing = StandingRule::dynamics;
  return fault_of(std::move(collapse), 0.005);
}

}  // namespace topple::test
