// Utilisation of joints by both rules of interaction.
#include <catch2/catch.hpp>

#include "topple/structure/joint_check.h"

using namespace topple::structure;

namespace {

JointCapacity capacity(Interaction interaction) {
  JointCapacity result;
  result.breakable = true;
  result.interaction = interaction;
  result.value = {100, 400, 50, 60, 10, 200, 80};
  return result;
}

Vec6 demand(double x, double y, double z, double rx, double ry, double rz) {
  Vec6 d;
  d << x, y, z, rx, ry, rz;
  return d;
}

}  // namespace

TEST_CASE("tension and compression are checked against their own capacities") {
  const Utilisation pulled = utilisation(capacity(Interaction::max), demand(50, 0, 0, 0, 0, 0));
  CHECK(pulled.value == 0.5);
  CHECK(pulled.sense == Sense::tension);
  const Utilisation pushed = utilisation(capacity(Interaction::max), demand(-50, 0, 0, 0, 0, 0));
  CHECK(pushed.value == 0.125);
  CHECK(pushed.sense == Sense::compression);
  CHECK(pushed.demand == 50);
  CHECK(pushed.capacity == 400);
}

TEST_CASE("with max the largest of the seven ratios governs, signs apart") {
  const Utilisation result = utilisation(capacity(Interaction::max), demand(10, -20, 30, -6, 100, -20));
  CHECK(result.value == 0.6);
  CHECK(result.sense == Sense::torsion);
  CHECK(result.demand == 6);
}

TEST_CASE("with sum axial force and both moments add up, shear and torsion stay apart") {
  const Utilisation bent = utilisation(capacity(Interaction::sum), demand(10, 5, 6, 1, 100, 20));
  CHECK(bent.value == Approx(0.1 + 0.5 + 0.25).epsilon(1e-15));
  CHECK(bent.sense == Sense::moment_y);
  const Utilisation sheared = utilisation(capacity(Interaction::sum), demand(10, 45, 0, 0, 20, 8));
  CHECK(sheared.value == 0.9);
  CHECK(sheared.sense == Sense::shear_y);
}

TEST_CASE("strength scales every capacity, and what has no capacity never counts") {
  CHECK(utilisation(capacity(Interaction::max), demand(50, 0, 0, 0, 0, 0), 0.25).value == 2);
  JointCapacity open = capacity(Interaction::max);
  open.value[0] = unlimited;
  CHECK(utilisation(open, demand(1e9, 0, 0, 0, 0, 0), 0.0).value == 0);
  CHECK(utilisation(JointCapacity{}, demand(1e9, 1, 1, 1, 1, 1)).value == 0);
  CHECK(std::isinf(utilisation(capacity(Interaction::max), demand(1, 0, 0, 0, 0, 0), 0.0).value));
}

TEST_CASE("a tie member's joints are in tension at both ends") {
  topple::solver::Vec12 end_forces;
  end_forces << -5, 1, 2, 3, 4, 6, 5, -1, -2, -3, -4, -6;
  CHECK(member_joint_demand(end_forces, 0) == demand(5, 1, 2, 3, 4, 6));
  CHECK(member_joint_demand(end_forces, 1) == demand(5, -1, -2, -3, -4, -6));
}
