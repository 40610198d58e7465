// The standing frame's energies: each measured on its own, together they must balance.
#include <catch2/catch.hpp>
#include <random>

#include "structure/frame_builder.h"
#include "structure/unbraced_rules.h"
#include "topple/structure/standing_frame.h"

namespace {

using namespace topple::test;

/// What the balance misses, relative to the largest term.
double imbalance(const FrameEnergy& e) {
  const double scale =
      std::max({std::abs(e.elastic), std::abs(e.gravity_work), std::abs(e.freed), std::abs(e.contact_work)});
  return std::abs(e.elastic - e.elastic_at_start - e.gravity_work - e.other_work - e.contact_work + e.freed) / scale;
}

/// It bears 1e4 N and 1e4 N m, and a small load at its tip.
struct WeakCantilever {
  static constexpr double length = 4;
  FrameBuilder frame;
  NodeId tip;
  MemberId beam;

  WeakCantilever() {
    const NodeId foot = frame.node("A", 0, 0, 3);
    tip = frame.node("B", length, 0, 3);
    beam = frame.member("AB", MemberKind::beam, foot, tip, same_capacity(1e4));
    frame.support(foot);
    frame.load(tip, (Vec6() << 0, 0, -200, 0, 0, 0).finished());
  }
};

}  // namespace

TEST_CASE("a built-in beam that becomes a cantilever frees the difference of its energies") {
  // Under constant load the potential is minus the elastic energy: q^2 L^5/1440EI built in, q^2 L^5/40EI as a
  // cantilever.
  const double length = 5, q = 1000, EI = 200e9 * 2e-4;
  FrameBuilder frame;
  const NodeId a = frame.node("A", 0, 0, 3), b = frame.node("B", length, 0, 3);
  const MemberId beam = frame.member("AB", MemberKind::beam, a, b, same_capacity(1e9), same_capacity(1e9));
  frame.support(a);
  frame.support(b);
  frame.load(beam, -q);
  StandingFrame standing(frame.building, CombinationId(0u), unbraced_rules());
  const double unit = q * q * std::pow(length, 5) / EI;
  CHECK(standing.elastic_energy() == Approx(unit / 1440).epsilon(1e-9));
  standing.break_joint(frame.building.joint(beam, 1), BreakCause::tool);
  const auto breaks = standing.settle(10);
  REQUIRE(breaks.size() == 1);
  const double freed = unit * (1.0 / 40 - 1.0 / 1440);
  CHECK(breaks[0].energy == Approx(freed).epsilon(1e-9));
  CHECK(standing.energy().freed == Approx(freed).epsilon(1e-9));
  CHECK(standing.energy().gravity_work == Approx(2 * freed).epsilon(1e-9));
  standing.break_joint(frame.building.joint(beam, 0), BreakCause::tool);
  CHECK(standing.settle(10).at(0).energy == Approx(unit / 40).epsilon(1e-9));
  CHECK(standing.energy().elastic == 0);
  CHECK(imbalance(standing.energy()) < 1e-9);
}

TEST_CASE("a weight that a cantilever cannot bear leaves no energy of a state that is never reached") {
  const WeakCantilever of;
  StandingFrame standing(of.frame.building, CombinationId(0u), unbraced_rules());
  const double elastic = standing.elastic_energy();
  standing.set_contact_load({1, {of.beam, {}, Vec3(of.length, 0, 3)}, Vec3(0, 0, -1e9)});  // 1e5 times what it bears
  REQUIRE(standing.settle(10).size() == 1);
  CHECK_FALSE(standing.stands(of.beam));
  const FrameEnergy energy = standing.energy();
  CHECK(energy.elastic == 0);
  CHECK(energy.contact_work == 0);  // it left before that load had moved
  CHECK(energy.freed == Approx(elastic).epsilon(1e-9));
}

TEST_CASE("a load of an event that a cantilever cannot bear leaves with it, and has done no work") {
  const double sign = GENERATE(1, -1);
  const WeakCantilever of;
  StandingFrame standing(of.frame.building, CombinationId(0u), unbraced_rules());
  const double elastic = standing.elastic_energy();
  standing.add_load(of.tip,
                    (Vec6() << 0, 0, sign * 1e6, 0, 0, 0).finished());  // its sag times that: 2500 times `elastic`
  standing.add_load(of.tip, (Vec6() << 0, 0, sign * 1e6, 0, 0, 0).finished());
  REQUIRE(standing.settle(10).size() == 1);
  CHECK_FALSE(standing.stands(of.beam));
  CHECK(standing.energy().other_work == Approx(0).margin(1e-9 * elastic));
  CHECK(standing.energy().freed == Approx(elastic).epsilon(1e-9));
}

TEST_CASE("a weight laid slowly on a cantilever puts half its force times its way into it") {
  const double length = 4, force = 5000, stiffness = 3 * 200e9 * 2e-4 / (length * length * length);
  FrameBuilder frame;
  const NodeId a = frame.node("A", 0, 0, 3), b = frame.node("B", length, 0, 3);
  const MemberId beam = frame.member("AB", MemberKind::beam, a, b, same_capacity(1e9));
  frame.support(a);
  frame.load(b, (Vec6() << 0, 0, -2000, 0, 0, 0).finished());
  StandingFrame standing(frame.building, CombinationId(0u), unbraced_rules());
  standing.set_contact_load({1, {beam, {}, Vec3(length, 0, 3)}, Vec3(0, 0, -force)});
  standing.settle(10);
  const double way = force / stiffness;
  CHECK(standing.energy().contact_work == Approx(force * way / 2).epsilon(1e-9));
  CHECK(standing.energy().gravity_work == Approx(2000 * way).epsilon(1e-9));
  CHECK(standing.energy().freed == 0);
  CHECK(imbalance(standing.energy()) < 1e-9);
  standing.remove_contact_load(1);
  standing.settle(10);
  CHECK(std::abs(standing.energy().contact_work) < 1e-9 * force * way);
}

TEST_CASE("a load that an event adds at once frees half its work") {
  const double length = 4, force = 5000, stiffness = 3 * 200e9 * 1e-4 / (length * length * length);
  FrameBuilder frame;
  const NodeId a = frame.node("A", 0, 0, 3), b = frame.node("B", length, 0, 3);
  frame.member("AB", MemberKind::beam, a, b, same_capacity(1e9));
  frame.support(a);
  frame.load(b, (Vec6() << 0, 0, -2000, 0, 0, 0).finished());
  StandingFrame standing(frame.building, CombinationId(0u), unbraced_rules());
  standing.add_load(b, (Vec6() << 0, force, 0, 0, 0, 0).finished());
  standing.settle(10);
  CHECK(standing.energy().other_work == Approx(force * force / stiffness).epsilon(1e-9));
  CHECK(standing.energy().freed == Approx(0.5 * force * force / stiffness).epsilon(1e-9));
  CHECK(imbalance(standing.energy()) < 1e-9);
}

TEST_CASE("energies balance through random damage, loads and losses") {
  // 1e-8 of the largest term: each is a sum of some thousand products with a relative error of condition (1e6) times
  // rounding.
  std::mt19937 random(5);
  for (int trial = 0; trial < 12; ++trial) {
    FrameBuilder frame = grid_building(3, 2, 2, 5, 3, same_capacity(1e12), same_capacity(1e12));
    const auto node = [](int i, int j, int k) { return NodeId(static_cast<std::size_t>((k * 2 + j) * 3 + i)); };
    for (int k = 1; k <= 2; ++k)
      for (int i = 0; i < 2; ++i) {
        const PanelId slab =
            frame.panel("S" + std::to_string(i) + std::to_string(k), PanelModel::cladding,
                        {node(i, 0, k), node(i + 1, 0, k), node(i + 1, 1, k), node(i, 1, k)}, same_capacity(1e12));
        frame.load(slab, 3000 + 500 * i);
      }
    frame.self_weight(7850);
    frame.load(node(2, 1, 2), (Vec6() << 4e3, 0, -9e3, 0, 0, 2e3).finished());
    if (trial % 2) frame.building.supports[3].stiffness << 1e8, 1e8, 5e7, 1e7, 1e7, 1e7;
    if (trial % 3 == 0) frame.building.joints[4].stiffness(4) = 3e6;
    const Building& building = frame.building;
    StandingFrame standing(building, CombinationId(0u), unbraced_rules());
    const std::size_t members = building.members.size();
    for (int round = 0; round < 14; ++round) {
      switch (random() % 7) {
        case 0:
        case 1:
        case 2:
          standing.break_joint(JointId(random() % building.joints.size()), BreakCause::tool);
          break;
        case 3:
          standing.remove(MemberId(random() % members));
          break;
        case 4: {
          const MemberId on(random() % members);
          const Vec3 middle =
              0.5 * (building[building[on].nodes[0]].position + building[building[on].nodes[1]].position);
          standing.set_contact_load({static_cast<int>(random() % 3), {on, {}, middle}, Vec3(500, 0, -4000)});
          break;
        }
        case 5:
          standing.set_contact_load({9, {{}, PanelId(random() % 4), Vec3(3, 2, 3)}, Vec3(0, 0, -3000)});
          break;
        default:
          standing.add_load(node(0, 0, 2), (Vec6() << 1e3, -2e3, 0, 0, 0, 0).finished());
      }
      if (round == 6) standing.set_gravity(Vec3(1, 0, -9));
      if (round == 10) standing.remove_support(building.supports[static_cast<std::size_t>(trial) % 6].node);
      standing.settle(100);
      INFO("trial " << trial << " round " << round);
      CHECK(imbalance(standing.energy()) < 1e-8);
    }
  }
}

TEST_CASE("energies balance over a cascade of generations with membrane slabs, and nothing on its way is reported") {
  FrameBuilder frame = grid_building(3, 3, 3, 6, 3.5, same_capacity(2e6), same_capacity(3.5e5));
  const auto node = [](int i, int j, int k) { return NodeId(static_cast<std::size_t>((k * 3 + j) * 3 + i)); };
  for (int k = 1; k <= 3; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 2; ++i) {
        const PanelId slab = frame.panel("S" + std::to_string(100 * i + 10 * j + k), PanelModel::membrane,
                                         {node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k), node(i, j + 1, k)},
                                         same_capacity(4e5));
        frame.load(slab, 6000);
      }
  frame.self_weight(2500);
  FailureRules rules;
  StandingFrame standing(frame.building, CombinationId(0u), rules);
  REQUIRE_FALSE(standing.pending());
  const double sag = standing.roof_sag();
  const NameIndex names(frame.building);
  standing.set_contact_load({4, {{}, PanelId(0u), Vec3(2, 2, 3.5)}, Vec3(0, 0, -2e4)});
  standing.settle(4);
  standing.remove(*names.member("P-1-1-1"));
  std::size_t broken = 0;
  int steps = 0;
  for (; standing.pending() && steps < 500; ++steps) {
    broken += standing.settle(1).size();
    // Displacements on the way to rest would be those of linear theory far beyond what any joint bears.
    CHECK(std::abs(standing.roof_sag()) < 10 * sag);
    CHECK(imbalance(standing.energy()) < 1e-8);
  }
  CHECK(steps < 500);
  CHECK(broken > 5);
  CHECK_FALSE(standing.extract_detached().empty());
}
