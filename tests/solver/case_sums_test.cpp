// Sums of load cases, against each sum solved by itself.
#include "topple/solver/case_sums.h"

#include <catch2/catch.hpp>

#include "frames.h"

using namespace topple::test;

namespace {

/// Weight of the beams, wind on all nodes, a heated beam with a support that sinks.
std::vector<LoadSet> three_cases(const FrameModel& model) {
  std::vector<LoadSet> cases(3);
  for (int i = 0; i < static_cast<int>(model.beams.size()); ++i) {
    const Beam& beam = model.beams[static_cast<std::size_t>(i)];
    const Vec3 down = beam.axes * Vec3(0, 0, -5000);
    cases[0].beams.push_back(uniform_load(i, beam.length, components(down.x(), down.y(), down.z(), 0, 0, 0)));
  }
  for (int n = 0; n < static_cast<int>(model.nodes.size()); ++n)
    cases[1].nodes.push_back({n, components(900, 400, 0, 0, 0, 50)});
  BeamLoad heat;
  heat.kind = BeamLoad::Kind::temperature;
  heat.beam = 4;
  heat.strain = 1e-4;
  heat.curvature_z = 2e-4;
  cases[2].beams.push_back(heat);
  cases[2].settlements.push_back({0, 2, -0.01});
  return cases;
}

LoadSet added_up(const std::vector<LoadSet>& cases, const Eigen::VectorXd& factors) {
  LoadSet sum;
  for (std::size_t c = 0; c < cases.size(); ++c) {
    const double f = factors(static_cast<Eigen::Index>(c));
    for (NodeLoad load : cases[c].nodes) sum.nodes.push_back({load.node, f * load.load});
    for (Settlement s : cases[c].settlements) sum.settlements.push_back({s.node, s.component, f * s.value});
    for (BeamLoad load : cases[c].beams) {
      load.first *= f;
      load.last *= f;
      load.strain *= f;
      load.curvature_y *= f;
      load.curvature_z *= f;
      sum.beams.push_back(load);
    }
  }
  return sum;
}

double largest(const StaticSolution& s) {
  double most = 0;
  for (const Vec6& u : s.displacements) most = std::max(most, u.head<3>().cwiseAbs().maxCoeff());
  return most;
}

double difference(const StaticSolution& a, const StaticSolution& b) {
  double most = 0, force = 0, forces = 0;
  for (std::size_t n = 0; n < a.displacements.size(); ++n)
    most = std::max(most, (a.displacements[n] - b.displacements[n]).cwiseAbs().maxCoeff());
  for (std::size_t i = 0; i < a.beam_end_forces.size(); ++i) {
    force = std::max(force, (a.beam_end_forces[i] - b.beam_end_forces[i]).cwiseAbs().maxCoeff());
    forces = std::max(forces, b.beam_end_forces[i].cwiseAbs().maxCoeff());
  }
  for (std::size_t i = 0; i < a.reactions.size(); ++i)
    force = std::max(force, (a.reactions[i] - b.reactions[i]).cwiseAbs().maxCoeff());
  return std::max(most / largest(b), force / forces);
}

}  // namespace

TEST_CASE("Sums of load cases have the answers that each of them has by itself") {
  const FrameModel model = tower(3, 4);
  const std::vector<LoadSet> cases = three_cases(model);
  Eigen::MatrixXd factors(3, 6);
  factors << 1.35, 1, 1, 0, 1.2, 0,  //
      0, 1.5, -1.5, 1, 0.6, 0,       //
      0, 0, 1, 1, -2, 0;
  const CaseSums sums = solve_case_sums(model, cases, factors);
  REQUIRE(sums.solutions.size() == 6);
  StaticAnalysis alone(model);
  for (Eigen::Index j = 0; j < 5; ++j) {
    const LoadSet sum = added_up(cases, factors.col(j));
    const StaticSolution expected = alone.solve({&sum, 1}).front();
    const StaticSolution& found = sums.solutions[static_cast<std::size_t>(j)];
    // Both are right to a condition of some 1e5 times rounding.
    CHECK(difference(found, expected) < 1e-11);
    CHECK(found.quality.backward_error <= 1e-14);
    CHECK(found.quality.converged);
    CHECK(found.quality.error_bound > 0);
  }
  CHECK(largest(sums.solutions[5]) == 0);
}

TEST_CASE("Where load cases cancel, what is left of them is right to its own last digits") {
  const FrameModel model = tower(3, 4);
  std::vector<LoadSet> cases = three_cases(model);
  cases.resize(2);
  // A millionth of the first one is all that is left.
  cases[1] = cases[0];
  cases[1].nodes.push_back({30, unit(0, 1)});
  Eigen::MatrixXd factors(2, 3);
  factors << 1, -1, 0.5,  //
      -1, 1, -0.5;
  const CaseSums sums = solve_case_sums(model, cases, factors);
  LoadSet left;
  left.nodes.push_back({30, unit(0, -1)});
  const StaticSolution expected = solve_one(model, left);
  CHECK(difference(sums.solutions[0], expected) < 1e-9);
  for (const StaticSolution& found : sums.solutions) CHECK(found.quality.backward_error <= 1e-14);
}

TEST_CASE("Load cases that only in sum load nothing that is loose are solved as sums") {
  // A truss bar between two hinges: a moment on its node acts on nothing that resists turning.
  FrameModel model =
      single_beam(2, components(rigid, rigid, rigid, rigid, rigid, rigid), components(0, rigid, rigid, 0, 0, 0));
  model.beams[0].end_stiffness[1].tail<3>().setZero();
  std::vector<LoadSet> cases(2);
  cases[0].nodes = {{1, components(1000, 0, 0, 0, 5, 0)}};
  cases[1].nodes = {{1, components(1000, 0, 0, 0, -5, 0)}};
  CHECK_THROWS_AS(solve_case_sums(model, cases, Eigen::MatrixXd::Identity(2, 3)), Instability);
  const CaseSums sums = solve_case_sums(model, cases, Eigen::MatrixXd::Ones(2, 3));
  const Beam& beam = model.beams[0];
  for (const StaticSolution& found : sums.solutions)
    CHECK(found.displacements[1](0) == Approx(2000 * beam.length / (beam.youngs_modulus * beam.area)).epsilon(1e-13));
}

TEST_CASE("Sums of load cases need a factor for each case") {
  const FrameModel model = tower(2, 1);
  const std::vector<LoadSet> cases = three_cases(model);
  CHECK_THROWS_WITH(solve_case_sums(model, cases, Eigen::MatrixXd::Ones(2, 4)),
                    Catch::Contains("2 factors for 3 cases"));
}
