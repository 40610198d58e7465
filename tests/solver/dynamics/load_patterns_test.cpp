// Values of loads that go with time, from substep to substep.
#include "dynamics/load_patterns.h"

#include <catch2/catch.hpp>

#include "assembly/frame_loads.h"
#include "assembly/scaled_equations.h"
#include "frames.h"

using namespace topple::test;

TEST_CASE("a load that goes with time is known at both ends of a substep, and jumps between two") {
  FrameSystem system(tower(3, 1));
  system.assemble();
  LoadPatterns patterns;
  LoadSet loads;
  loads.nodes = {{10, unit(0, 100)}};
  loads.beams = {uniform_load(3, system.model.beams[3].length, unit(2, -50))};
  const int pattern = patterns.add(loads);
  patterns.find(system);
  const Eigen::VectorXd whole = scaled_force(system, load_vector(system, loads).force);
  const auto force = [&](double share_of_start) {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(system.dofs().equations);
    patterns.add_to(share_of_start, sum);
    return sum;
  };
  const auto fixed_end = [&](bool at_end) {
    Vec12 sum = Vec12::Zero();
    patterns.add_fixed_end(3, at_end, sum);
    return sum;
  };
  const Vec12 of_one = system.fixed_end_forces(3, loads.beams).force;

  patterns.set(pattern, 2);
  patterns.begin_substep();
  CHECK(force(0.25) == 1.5 * whole);
  CHECK(fixed_end(false).isZero(0));
  CHECK(fixed_end(true) == 2 * of_one);
  patterns.begin_substep();  // the substep was not accepted
  CHECK(force(1).isZero(0));
  patterns.accept();
  patterns.begin_substep();
  CHECK(force(1) == 2 * whole);
  CHECK(force(0) == 2 * whole);
  patterns.jump(pattern, 4);
  CHECK(force(0) == 2 * whole);
  patterns.begin_substep();
  CHECK(force(0.5) == 4 * whole);
  CHECK(fixed_end(false) == 4 * of_one);
}
