// Frames one after the other with equations that are kept, against each analysed by itself.
#include "topple/solver/kept_equations.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <thread>

#include "frames.h"

using namespace topple::test;

namespace {

/// Two storeys of 3 x 2 posts with beams both ways and membranes; the upper floor is a rigid one.
FrameModel two_storeys(double stiffness, double spring) {
  FrameModel model;
  for (int level = 0; level < 3; ++level)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 2; ++j) model.nodes.emplace_back(5.1 * i, 4.3 * j, 3.2 * level);
  const auto node = [](int level, int i, int j) { return 6 * level + 2 * i + j; };
  for (int level = 0; level < 2; ++level)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 2; ++j) {
        add_beam(model, node(level, i, j), node(level + 1, i, j));
        if (i < 2) add_beam(model, node(level + 1, i, j), node(level + 1, i + 1, j));
        if (j < 1) add_beam(model, node(level + 1, i, j), node(level + 1, i, j + 1));
      }
  for (Beam& beam : model.beams) beam.youngs_modulus *= stiffness;
  for (int i = 0; i < 2; ++i) {
    Shell shell;
    shell.node = {node(1, i, 0), node(1, i + 1, 0), node(1, i + 1, 1), node(1, i, 1)};
    shell.youngs_modulus = 30e9;
    shell.poisson_ratio = 0.2;
    shell.thickness = 0.15;
    model.shells.push_back(shell);
  }
  for (int n = 0; n < 5; ++n) model.supports.push_back({n, fixed()});
  model.supports.push_back({5, components(spring, spring, rigid, spring, spring, spring)});
  model.diaphragms.push_back({{12, 13, 14, 15, 16, 17}});
  return model;
}

std::vector<LoadSet> loads() {
  std::vector<LoadSet> sets(2);
  for (int n = 6; n < 18; ++n) {
    sets[0].nodes.push_back({n, components(0, 0, -4e4, 0, 0, 0)});
    sets[1].nodes.push_back({n, components(9e3, 3e3, 0, 0, 0, 100)});
  }
  return sets;
}

void check_same_bits(const std::vector<StaticSolution>& a, const std::vector<StaticSolution>& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    CHECK(a[k].displacements == b[k].displacements);
    CHECK(a[k].reactions == b[k].reactions);
    CHECK(a[k].beam_end_forces == b[k].beam_end_forces);
    CHECK(a[k].shell_corner_forces == b[k].shell_corner_forces);
    CHECK(a[k].quality.backward_error == b[k].quality.backward_error);
    CHECK(a[k].quality.condition == b[k].quality.condition);
  }
}

std::vector<StaticSolution> alone(const FrameModel& model) {
  const std::vector<LoadSet> sets = loads();
  return StaticAnalysis(model).solve(sets);
}

}  // namespace

TEST_CASE("Frames that differ in numbers alone have the bits of an analysis of each, and are ordered once") {
  KeptEquations kept;
  AnalysisStatistics statistics;
  const std::vector<LoadSet> sets = loads();
  for (const double stiffness : {1.0, 0.9, 1.3, 0.9}) {
    FrameModel model = two_storeys(stiffness, 1e7 * stiffness);
    model.shells[1].thickness *= stiffness;
    model.nodes[17].x() += 0.1 * stiffness;  // the arms of the rigid floor as well
    check_same_bits(kept.solve(model, sets, {}, statistics), alone(model));
    CHECK(statistics.factor_entries > 0);
  }
  CHECK(kept.reused() == 3);
}

TEST_CASE("A frame of other elements or held in other freedoms is ordered anew") {
  KeptEquations kept;
  AnalysisStatistics statistics;
  const std::vector<LoadSet> sets = loads();
  FrameModel held = two_storeys(1, 1e7), less = held, turned = held;
  held.supports[5].stiffness = fixed();
  less.beams.pop_back();
  std::swap(turned.beams[1].node, turned.beams[2].node);
  turned.beams[1] = make_beam(turned, turned.beams[1].node[0], turned.beams[1].node[1]);
  turned.beams[2] = make_beam(turned, turned.beams[2].node[0], turned.beams[2].node[1]);
  for (const FrameModel& model : {two_storeys(1, 1e7), held, less, turned, two_storeys(1, 1e7)})
    check_same_bits(kept.solve(model, sets, {}, statistics), alone(model));
  CHECK(kept.reused() == 0);
}

TEST_CASE("What is kept serves on after a frame that cannot stand, and one that is refused") {
  KeptEquations kept;
  AnalysisStatistics statistics;
  const std::vector<LoadSet> sets = loads();
  const FrameModel sound = two_storeys(1, 1e7);
  FrameModel loose = sound, refused = sound;
  for (Beam& beam : loose.beams) {  // sways: every end a hinge
    beam.end_stiffness[0].tail<3>().setZero();
    beam.end_stiffness[1].tail<3>().setZero();
  }
  refused.beams[3].area = -1;
  check_same_bits(kept.solve(sound, sets, {}, statistics), alone(sound));
  CHECK_THROWS_AS(kept.solve(loose, sets, {}, statistics), Instability);
  check_same_bits(kept.solve(sound, sets, {}, statistics), alone(sound));
  CHECK_THROWS_AS(kept.solve(refused, sets, {}, statistics), std::invalid_argument);
  check_same_bits(kept.solve(sound, sets, {}, statistics), alone(sound));
}

TEST_CASE("Sums of load cases have the same bits with equations that are kept") {
  KeptEquations kept;
  const std::vector<LoadSet> cases = loads();
  Eigen::MatrixXd factors(2, 3);
  factors << 1, 0, 1.35, 0, 1, -0.9;
  for (const double stiffness : {1.0, 0.8, 1.1}) {
    const FrameModel model = two_storeys(stiffness, 1e7);
    check_same_bits(kept.solve_case_sums(model, cases, factors).solutions,
                    solve_case_sums(model, cases, factors).solutions);
  }
  CHECK(kept.reused() == 2);
}

TEST_CASE("Frames analysed at once on several threads have the bits of each by itself") {
  const FrameModel model = tower(5, 8);
  LoadSet load;
  for (int n = 0; n < static_cast<int>(model.nodes.size()); ++n)
    load.nodes.push_back({n, components(900, 400, -2e4, 0, 0, 50)});
  const StaticSolution alone = solve_one(model, load);
  std::atomic<int> others{0};
  const auto repeat = [&] {
    for (int i = 0; i < 20; ++i) others += solve_one(model, load).displacements == alone.displacements ? 0 : 1;
  };
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) threads.emplace_back(repeat);
  for (std::thread& thread : threads) thread.join();
  CHECK(others == 0);
}
