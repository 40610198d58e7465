// Values of loads that go with time, from substep to substep.
#include "dynamics/load_patterns.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <utility>

#include "assembly/frame_loads.h"
#include "assembly/scaled_equations.h"
#include "frames.h"
#include "topple/solver/frame_dynamics.h"

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

namespace {

const Vec6 pinned = components(rigid, rigid, rigid, 0, 0, 0);

/// A tower whose roof is a rigid floor; one node of it is held along x, and the foot 1 stands on a pin.
FrameModel held_tower() {
  FrameModel model = tower(3, 1);
  for (Beam& beam : model.beams) beam.density = 7850;
  model.diaphragms.push_back({{9, 10, 11, 12, 13, 14, 15, 16, 17}});
  model.supports[1].stiffness = pinned;
  model.supports.push_back({9, components(rigid, 0, 0, 0, 0, 0)});
  return model;
}

/// After ten substeps in which the support's stiffness is another one and the damping too.
std::vector<Vec6> moved_on(const FrameModel& model, const LoadSet& leaning, bool by_nodes, int support,
                           const Vec6& stiffness) {
  DynamicOptions options;
  options.substep = 1e-3;
  FrameDynamics frame(model, {}, options);
  const std::vector<Vec6> rest = solve_one(model, leaning).displacements;
  frame.set_state(rest, std::vector<Vec6>(rest.size(), Vec6::Zero()));
  frame.jump_pattern(by_nodes ? frame.add_pattern(leaning) : frame.add_holding_force(), 1);
  frame.advance();
  double worst = 0, size = 0;
  for (std::size_t n = 0; n < rest.size(); ++n) {
    worst = std::max(worst, (frame.displacements()[n] - rest[n]).norm());
    size = std::max(size, rest[n].norm());
  }
  CHECK(worst < 1e-9 * size);  // it is held
  frame.set_support_stiffness(support, stiffness);
  frame.advance();
  frame.set_damping({0.1, 1e-4});
  for (int n = 0; n < 8; ++n) frame.advance();
  return frame.displacements();
}

}  // namespace

TEST_CASE("What holds a frame stays with its nodes when a support lets a freedom go, or takes hold of one") {
  const FrameModel model = held_tower();
  LoadSet leaning;
  leaning.nodes = {{10, components(0, 2e4, -1e4, 5e3, 4e3, 0)},
                   {14, components(0, -3e4, 0, 0, 2e3, 6e3)},
                   {17, components(0, 4e4, -2e4, 0, 0, 0)}};  // none along what the roof's support holds
  const int foot = 4, roof = static_cast<int>(model.supports.size()) - 1;
  for (const auto& [support, stiffness] :
       {std::pair(foot, pinned), std::pair(1, fixed()), std::pair(roof, Vec6(Vec6::Zero()))}) {
    const std::vector<Vec6> held = moved_on(model, leaning, false, support, stiffness),
                            loaded = moved_on(model, leaning, true, support, stiffness);
    INFO("support " << support);
    double worst = 0, size = 0;
    for (std::size_t n = 0; n < held.size(); ++n) {
      worst = std::max(worst, (held[n] - loaded[n]).norm());
      size = std::max(size, loaded[n].norm());
    }
    CHECK(worst < 1e-9 * size);  // K u and loads agree to the rounding of a solve
    CHECK(size > 1e-4);
  }
}
