// Members and membranes that lose stiffness where they stand, against a building made of the softer material.
#include <catch2/catch.hpp>

#include "frame_builder.h"
#include "topple/structure/standing_frame.h"

using namespace topple::structure;
using topple::test::FrameBuilder;
using topple::test::grid_building;

namespace {

/// One storey with a slab that takes part of a push along one side; slab and frame have materials of their own.
FrameBuilder pushed_storey(double slab_modulus) {
  FrameBuilder f = grid_building(2, 2, 1, 5, 3, {}, {});
  Material soft = f.building.materials[0];
  soft.name = "slab";
  soft.youngs_modulus = slab_modulus;
  soft.shear_modulus = slab_modulus / 2.5;
  f.building.materials.push_back(soft);
  const auto at = [](int i, int j) { return NodeId(static_cast<std::size_t>((2 + j) * 2 + i)); };
  const PanelId slab = f.panel("S", PanelModel::membrane, {at(0, 0), at(1, 0), at(1, 1), at(0, 1)});
  f.building.panels[0].material = MaterialId(1u);
  f.building.panels[0].thickness = 0.01;  // thin: its stiffness compares with the frame's
  f.load(slab, 1000);
  for (std::size_t m = 0; m < f.building.members.size(); ++m) f.load(MemberId(m), -2000);
  Vec6 push = Vec6::Zero();
  push(0) = 2e5;
  f.load(at(0, 0), push);
  return f;
}

void check_same(const StandingFrame& a, const StandingFrame& b) {
  const std::size_t nodes = a.building().nodes.size();
  double largest = 0, difference = 0;
  for (std::size_t n = 0; n < nodes; ++n) {
    largest = std::max(largest, b.displacement(NodeId(n)).norm());
    difference = std::max(difference, (a.displacement(NodeId(n)) - b.displacement(NodeId(n))).norm());
  }
  CHECK(difference < 1e-9 * largest);  // two roundings of one answer
}

}  // namespace

TEST_CASE("softer members answer like those of a softer material, and a factor replaces the one before") {
  FrameBuilder stiff = pushed_storey(2e9), soft = pushed_storey(2e9);
  Material weak = soft.building.materials[0];
  weak.name = "weak";
  weak.youngs_modulus *= 0.25;
  weak.shear_modulus *= 0.25;
  soft.building.materials.push_back(weak);
  for (Member& member : soft.building.members)
    if (member.kind == MemberKind::post) member.material = MaterialId(2u);
  StandingFrame frame(stiff.building, CombinationId(0u), {});
  const StandingFrame expected(soft.building, CombinationId(0u), {});
  const FrameEnergy start = frame.energy();
  for (const double factor : {0.5, 0.25})
    for (std::size_t m = 0; m < stiff.building.members.size(); ++m)
      if (stiff.building.members[m].kind == MemberKind::post) frame.set_stiffness_factor(MemberId(m), factor);
  CHECK(frame.settle(10).empty());
  check_same(frame, expected);
  const FrameEnergy end = frame.energy();
  const double in = end.gravity_work + end.other_work - start.gravity_work - start.other_work;
  CHECK(end.elastic - start.elastic == Approx(in - end.freed).epsilon(1e-9));
  CHECK_THROWS_AS(frame.set_stiffness_factor(MemberId(0u), 0), std::invalid_argument);
}
