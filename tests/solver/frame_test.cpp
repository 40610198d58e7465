// Whole frames: closed forms, equilibrium, turned frames, ill-scaled ones.
#include <catch2/catch.hpp>

#include "frames.h"

using namespace topple::test;

namespace {

LoadSet tower_loads(const FrameModel& model) {
  LoadSet loads;
  for (std::size_t i = 0; i < model.beams.size(); ++i) {
    const Vec3 down = model.beams[i].axes * Vec3(0, 0, -5000);
    loads.beams.push_back(
        uniform_load(static_cast<int>(i), model.beams[i].length, components(down.x(), down.y(), down.z(), 0, 0, 0)));
  }
  for (std::size_t n = 0; n < model.nodes.size(); n += 3) {
    loads.nodes.push_back({static_cast<int>(n), components(1000, -700, 300, 50, 60, 70)});
  }
  return loads;
}

double imbalance(const FrameModel& model, const LoadSet& loads, const StaticSolution& s) {
  Balance balance;
  for (const NodeLoad& load : loads.nodes) balance.add(model.nodes[static_cast<std::size_t>(load.node)], load.load);
  for (const BeamLoad& load : loads.beams) {
    const Beam& b = model.beams[static_cast<std::size_t>(load.beam)];
    const Vec3 start = model.nodes[static_cast<std::size_t>(b.node[0])] + b.offset[0];
    const Vec3 middle = start + b.axes.transpose() * Vec3(b.length / 2, 0, 0);
    Vec6 resultant;
    resultant << b.axes.transpose() * load.first.head<3>() * b.length,
        b.axes.transpose() * load.first.tail<3>() * b.length;
    balance.add(middle, resultant);
  }
  for (std::size_t i = 0; i < model.supports.size(); ++i) {
    balance.add(model.nodes[static_cast<std::size_t>(model.supports[i].node)], s.reactions[i]);
  }
  return balance.error();
}

}  // namespace

TEST_CASE("a portal frame under a lateral load shares it as the slope-deflection closed form says") {
  // Fixed feet, height h, span l, all of one section, no axial or shear deformation: k = h/l; under H at the top the
  // foot moments are H h (3k + 1)/(2 (6k + 1)), the corner moments H h 3k/(2 (6k + 1)) (Kleinlogel, frame 1; beam and
  // posts of equal I). Axial stiffness is made 1e9 times larger, so the closed form holds to 1e-8.
  const double h = 3, l = 5, H = 1000, k = h / l;
  FrameModel model;
  model.nodes = {Vec3(0, 0, 0), Vec3(0, 0, h), Vec3(l, 0, h), Vec3(l, 0, 0)};
  add_beam(model, 0, 1);
  add_beam(model, 1, 2);
  add_beam(model, 3, 2);
  for (Beam& b : model.beams) {
    b.shear_area_y = b.shear_area_z = 0;
    b.area = 1e4;
    b.Iz = b.Iy;  // posts bend about their y or z in the frame's plane by their axes; one value serves all
  }
  model.supports = {{0, fixed()}, {3, fixed()}};
  LoadSet loads;
  loads.nodes = {{1, unit(0, H / 2)}, {2, unit(0, H / 2)}};
  const StaticSolution s = solve_one(model, loads);
  const double foot = H * h * (3 * k + 1) / (2 * (6 * k + 1)), corner = H * h * 3 * k / (2 * (6 * k + 1));
  CHECK(std::abs(s.reactions[0](4)) == Approx(foot).epsilon(1e-7));
  CHECK(std::abs(s.reactions[1](4)) == Approx(foot).epsilon(1e-7));
  CHECK(std::abs(s.beam_end_forces[1](4)) == Approx(corner).epsilon(1e-7));
  CHECK(s.reactions[0](2) == Approx(-2 * corner / l).epsilon(1e-7));
}

TEST_CASE("reactions of a tower balance its loads to rounding, moments included") {
  const FrameModel model = tower(3, 6);
  const LoadSet loads = tower_loads(model);
  const StaticSolution s = solve_one(model, loads);
  CHECK(imbalance(model, loads, s) < 1e-10);
  CHECK(s.quality.backward_error <= 1e-14);
  CHECK(s.quality.error_bound < 1e-6);
}

TEST_CASE("a frame turned in space has turned answers") {
  FrameModel model = tower(2, 4);
  // Nothing may be aligned: offsets, a roll of some members, a partial release.
  for (std::size_t i = 0; i < model.beams.size(); i += 2) {
    const Mat3 roll = Eigen::AngleAxisd(0.3 * static_cast<double>(i), Vec3::UnitX()).toRotationMatrix();
    model.beams[i].axes = roll * model.beams[i].axes;
  }
  model.beams[3].end_stiffness[1](4) = 2e6;
  model.beams[5].end_stiffness[0](5) = 0;
  const LoadSet loads = tower_loads(model);
  const Mat3 R =
      (Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()) * Eigen::AngleAxisd(1.9, Vec3(-2, 0.3, 1).normalized()))
          .toRotationMatrix();
  const FrameModel turned_model = rotated(model, R);
  LoadSet turned_loads = loads;
  for (NodeLoad& load : turned_loads.nodes) load.load = rotated(load.load, R);
  const StaticSolution a = solve_one(model, loads), b = solve_one(turned_model, turned_loads);
  double largest = 0, difference = 0, force = 0, force_difference = 0;
  for (std::size_t n = 0; n < model.nodes.size(); ++n) {
    largest = std::max(largest, a.displacements[n].norm());
    difference = std::max(difference, (rotated(a.displacements[n], R) - b.displacements[n]).norm());
  }
  for (std::size_t i = 0; i < model.beams.size(); ++i) {
    force = std::max(force, a.beam_end_forces[i].norm());
    force_difference = std::max(force_difference, (a.beam_end_forces[i] - b.beam_end_forces[i]).norm());
  }
  CHECK(difference < 1e-10 * largest);
  CHECK(force_difference < 1e-10 * force);
}

TEST_CASE("a beam cut into pieces at skewed angles answers like the whole") {
  const Vec3 tip(2, -1.5, 2.5);
  FrameModel whole, cut;
  whole.nodes = {Vec3::Zero(), tip};
  add_beam(whole, 0, 1);
  whole.supports = {{0, fixed()}};
  const int pieces = 7;
  for (int i = 0; i <= pieces; ++i) cut.nodes.push_back(tip * i / pieces);
  for (int i = 0; i < pieces; ++i) add_beam(cut, i, i + 1);
  cut.supports = {{0, fixed()}};
  const Vec6 load = components(1, 2, 3, 4, 5, 6);
  LoadSet on_whole, on_cut;
  on_whole.nodes = {{1, load}};
  on_cut.nodes = {{pieces, load}};
  const Vec6 a = solve_one(whole, on_whole).displacements[1], b = solve_one(cut, on_cut).displacements[pieces];
  CHECK((a - b).norm() < 1e-11 * a.norm());
}

TEST_CASE("stiffness ratios of 1e10 and millimetres still reach a backward error of rounding") {
  FrameModel model = tower(2, 3);
  for (std::size_t i = 0; i < model.beams.size(); i += 5) model.beams[i].youngs_modulus *= 1e10;
  LoadSet loads = tower_loads(model);
  StaticAnalysis stiff(model);
  const StaticSolution s = stiff.solve(std::span(&loads, 1)).front();
  CHECK(s.quality.converged);
  CHECK(s.quality.backward_error <= 1e-14);
  CHECK(s.quality.condition > 1e9);

  FrameModel in_mm = tower(2, 3);
  const StaticSolution in_m = solve_one(in_mm, loads);
  for (Vec3& node : in_mm.nodes) node *= 1e3;
  for (Beam& b : in_mm.beams) {
    b.length *= 1e3;
    b.youngs_modulus *= 1e-6;
    b.shear_modulus *= 1e-6;
    for (double* area : {&b.area, &b.shear_area_y, &b.shear_area_z}) *area *= 1e6;
    for (double* second : {&b.Iy, &b.Iz, &b.J}) *second *= 1e12;
  }
  for (BeamLoad& load : loads.beams) {
    load.to *= 1e3;
    load.first *= 1e-3;
    load.last *= 1e-3;
  }
  for (NodeLoad& load : loads.nodes) load.load.tail<3>() *= 1e3;
  const StaticSolution mm = solve_one(in_mm, loads);
  CHECK(mm.quality.backward_error <= 1e-14);
  // The estimate works on scaled freedoms: units change it by no more than the powers of two of the scaling.
  CHECK(mm.quality.condition < 10 * in_m.quality.condition);
  for (std::size_t n = 0; n < in_mm.nodes.size(); ++n) {
    CHECK((mm.displacements[n].head<3>() - 1e3 * in_m.displacements[n].head<3>()).norm() <
          1e-8 * (1 + mm.displacements[n].norm()));
  }
}

TEST_CASE("many load sets solved together equal each solved alone") {
  const FrameModel model = tower(2, 3);
  std::vector<LoadSet> sets(3);
  sets[0] = tower_loads(model);
  sets[1].nodes = {{5, unit(0, 1000)}};
  sets[2].settlements = {{0, 2, -0.01}};
  StaticAnalysis analysis(model);
  const auto together = analysis.solve(sets);
  for (std::size_t i = 0; i < sets.size(); ++i) {
    const auto alone = analysis.solve(std::span(&sets[i], 1));
    double largest = 0, difference = 0;
    for (std::size_t n = 0; n < model.nodes.size(); ++n) {
      largest = std::max(largest, alone[0].displacements[n].norm());
      difference = std::max(difference, (alone[0].displacements[n] - together[i].displacements[n]).norm());
    }
    CHECK(difference < 1e-10 * largest);
  }
}
