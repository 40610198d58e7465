// What a tall frame's second order, buckling and modes have in common on any number of threads.
#include <catch2/catch.hpp>

#include "solver/frames.h"
#include "topple/solver/buckling.h"
#include "topple/solver/kept_memory.h"
#include "topple/solver/modes.h"
#include "topple/solver/second_order.h"

using namespace topple::test;

namespace {

/// Of more beams than are found together, some of them pressed hard.
struct TallFrame {
  FrameModel model;
  LoadSet loads;

  TallFrame() {
    constexpr int bays = 6, storeys = 12, row = bays + 1, floor = row * row;
    for (int k = 0; k <= storeys; ++k)
      for (int j = 0; j < row; ++j)
        for (int i = 0; i < row; ++i) model.nodes.emplace_back(6.0 * i, 5.5 * j, 3.5 * k);
    for (int k = 0; k < storeys; ++k)
      for (int n = 0; n < floor; ++n) {
        const int top = (k + 1) * floor + n;
        add_beam(model, k * floor + n, top);
        if (n % row < bays) add_beam(model, top, top + 1);
        if (n / row < bays) add_beam(model, top, top + row);
        loads.nodes.push_back({top, components(800, 300, -90000, 0, 0, 0)});
      }
    for (Beam& beam : model.beams) beam.Iz *= 4;
    for (Beam& beam : model.beams) beam.density = 7850;
    for (int n = 0; n < floor; ++n) model.supports.push_back({n, fixed()});
  }
};

bool same_bits(const std::vector<Vec6>& a, const std::vector<Vec6>& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin());
}

}  // namespace

TEST_CASE(
    "Second order, buckling and modes have the same bits on one thread and on two, in memory that was used before",
    "[second_order][buckling][modes]") {
  const TallFrame frame;
  REQUIRE(frame.model.beams.size() > 1024);
  AnalysisOptions one, two;
  two.threads = 2;
  const StaticSolution linear = solve_one(frame.model, frame.loads);
  const KeptMemory kept;
  const auto run = [&](const AnalysisOptions& options) {
    return SecondOrderAnalysis(frame.model, SecondOrder::exact, options).solve(frame.loads, linear);
  };
  const SecondOrderSolution alone = run(one), together = run(two);
  CHECK(alone.iterations > 2);
  CHECK(same_bits(alone.solution.displacements, together.solution.displacements));
  CHECK(alone.axial.first_axial == together.axial.first_axial);

  const auto modes_alone = buckling_modes(frame.model, frame.loads, 2, one);
  const auto modes_together = buckling_modes(frame.model, frame.loads, 2, two, 1e6, {}, &linear);
  REQUIRE(modes_alone.size() == 2);
  REQUIRE(modes_together.size() == 2);
  for (std::size_t k = 0; k < 2; ++k) {
    CHECK(modes_alone[k].factor == modes_together[k].factor);
    CHECK(same_bits(modes_alone[k].shape, modes_together[k].shape));
  }

  const auto shapes = [&](const AnalysisOptions& options) {
    return natural_modes(frame.model, {}, 3, options, &alone.axial).modes;
  };
  const auto swing_alone = shapes(one), swing_together = shapes(two);
  REQUIRE(swing_alone.size() == 3);
  REQUIRE(swing_together.size() == 3);
  for (std::size_t k = 0; k < 3; ++k) {
    CHECK(swing_alone[k].angular_frequency == swing_together[k].angular_frequency);
    CHECK(same_bits(swing_alone[k].shape, swing_together[k].shape));
  }
}

TEST_CASE("A second-order answer found by an earlier tangent's factor is in equilibrium with its own axial forces",
          "[second_order]") {
  const TallFrame frame;
  const StaticSolution linear = solve_one(frame.model, frame.loads);
  const SecondOrderSolution found = SecondOrderAnalysis(frame.model, SecondOrder::exact).solve(frame.loads, linear);
  // By the last axial forces alone, with no iteration before: one more turn from there moves nothing.
  const SecondOrderSolution again =
      SecondOrderAnalysis(frame.model, SecondOrder::exact).solve(frame.loads, found.solution);
  double largest = 0, off = 0, first_order = 0;
  for (std::size_t n = 0; n < frame.model.nodes.size(); ++n) {
    largest = std::max(largest, found.solution.displacements[n].norm());
    off = std::max(off, (found.solution.displacements[n] - again.solution.displacements[n]).norm());
    first_order = std::max(first_order, linear.displacements[n].norm());
  }
  CHECK(again.iterations == 2);
  CHECK(largest > 1.05 * first_order);  // the axial forces matter
  // Rounding times the condition of the tangent.
  CHECK(off <= found.solution.quality.error_bound * largest);
  CHECK(off <= 1e-8 * largest);
  CHECK(found.solution.quality.converged);
}
