// Releases at both ends, in every combination that a broken joint leaves behind.
#include "elements/beam.h"

#include <Eigen/QR>
#include <catch2/catch.hpp>

#include "frames.h"

using namespace topple::test;

namespace {
constexpr double L = 3.0;

BeamLoad some_load() { return uniform_load(0, L, components(10, 20, -30, 0, 4, 5)); }
}  // namespace

TEST_CASE("a beam broken at one end hangs on the other with all of its load") {
  FrameModel model = single_beam(L, fixed(), fixed());
  for (std::size_t broken : {0U, 1U}) {
    model.beams[0].end_stiffness = {fixed(), fixed()};
    model.beams[0].end_stiffness[broken].setZero();
    LoadSet loads;
    loads.beams = {some_load()};
    const StaticSolution s = solve_one(model, loads);
    const auto lost = static_cast<Eigen::Index>(6 * broken), kept = 6 - lost;
    CHECK(s.beam_end_forces[0].segment<6>(lost).norm() == 0);
    const double lever = kept == 0 ? L / 2 : -L / 2;  // of the resultant about the end that is kept
    Vec6 expected = -L * components(10, 20, -30, 0, 4, 5);
    expected(4) += -30 * L * lever;
    expected(5) -= 20 * L * lever;
    CHECK((s.beam_end_forces[0].segment<6>(kept) - expected).norm() < 1e-12 * expected.norm());
  }
}

TEST_CASE("a beam broken at both ends is not there: no stiffness, no load") {
  FrameModel model = single_beam(L, fixed(), components(rigid, rigid, rigid, rigid, rigid, rigid));
  model.beams[0].end_stiffness = {Vec6::Zero(), Vec6::Zero()};
  LoadSet loads;
  loads.beams = {some_load()};
  const StaticSolution s = solve_one(model, loads);
  CHECK(s.beam_end_forces[0].norm() == 0);
  CHECK(s.reactions[0].norm() == 0);
}

TEST_CASE("torsion released at both ends is no mechanism until a torque acts") {
  FrameModel model = single_beam(L, fixed(), fixed());
  model.beams[0].end_stiffness[0](3) = model.beams[0].end_stiffness[1](3) = 0;
  LoadSet bending, torque;
  bending.beams = {uniform_load(0, L, unit(2, -100))};
  torque.beams = {uniform_load(0, L, unit(3, 5))};
  CHECK(solve_one(model, bending).reactions[0](2) == Approx(150).epsilon(1e-13));
  StaticAnalysis analysis(model);
  CHECK_THROWS_AS(analysis.solve(std::span(&torque, 1)), Instability);
}

TEST_CASE("a pin at each end leaves a bar that bears q L/2 at both ends without moments") {
  FrameModel model = single_beam(L, fixed(), fixed());
  for (Vec6& end : model.beams[0].end_stiffness) end(4) = end(5) = 0;
  LoadSet loads;
  loads.beams = {uniform_load(0, L, components(0, 50, -100, 0, 0, 0))};
  const Vec12 f = solve_one(model, loads).beam_end_forces[0];
  CHECK(f(2) == Approx(150).epsilon(1e-13));
  CHECK(f(8) == Approx(150).epsilon(1e-13));
  CHECK(f(1) == Approx(-75).epsilon(1e-13));
  CHECK(f(4) == 0);
  CHECK(f(11) == 0);
}

TEST_CASE("releases that let a beam move by itself are an instability that names the beam") {
  const auto with = [](const Vec6& first, const Vec6& second) {
    FrameModel model = single_beam(L, fixed(), fixed());
    model.beams[0].end_stiffness = {first, second};
    return model;
  };
  Vec6 pin = fixed(), slide = fixed(), shear = fixed();
  pin(4) = pin(5) = 0;
  slide(0) = 0;
  shear(1) = 0;
  for (const FrameModel& model : {with(pin, Vec6::Zero()), with(slide, slide), with(shear, shear)}) {
    try {
      StaticAnalysis analysis(model);
      FAIL("accepted");
    } catch (const Instability& e) {
      CHECK(e.mechanism.beams == std::vector<int>{0});
      CHECK(std::string(e.what()).find("beam 0") != std::string::npos);
    }
  }
}

TEST_CASE("a spring beside a released end is condensed with it") {
  // Shear spring at the first end, pin at the second: P at midspan; the first end bears P/2 + M/L.
  FrameModel model = single_beam(L, fixed(), fixed());
  Beam& b = model.beams[0];
  b.shear_area_y = b.shear_area_z = 0;
  const double EI = b.youngs_modulus * b.Iy, P = 600, k = 3 * EI / (L * L * L);
  b.end_stiffness[0](2) = k;
  b.end_stiffness[1](4) = 0;
  LoadSet loads;
  loads.beams = {point_load(0, L / 2, unit(2, -P))};
  // Propped cantilever whose clamped end rests on k: take R at the pin as unknown. Seen from the clamp the pin moves by
  // (P - R)/k + 5 P L3/48EI - R L3/3EI = 0.
  const double R = (P / k + 5 * P * L * L * L / (48 * EI)) / (1 / k + L * L * L / (3 * EI));
  CHECK(solve_one(model, loads).reactions[1](2) == Approx(R).epsilon(1e-12));
}

TEST_CASE("any mixture of springs and releases equals the springs built beside a rigid beam and eliminated") {
  // Dense elimination by an orthogonal decomposition, which takes loose motions in its stride: all 4096 choices of
  // released components are too many, so a fixed stride through them, the rest springs of sizes from soft to stiff.
  FrameModel model = single_beam(L, fixed(), fixed());
  Beam& b = model.beams[0];
  const Mat12 whole = CondensedBeam(b).stiffness();
  BeamLoad load = some_load();
  load.from = 0.4;
  load.last = components(-10, 50, 30, 2, -4, 1);
  const Vec12 held = CondensedBeam(b).fixed_end_forces(std::span(&load, 1)).force;
  int compared = 0;
  for (int choice = 0; choice < 4096; choice += 37) {
    Vec12 k;
    for (int f = 0; f < 12; ++f) {
      const double size = whole(f, f) * std::pow(10.0, (choice / 37 + 5 * f) % 7 - 3);
      k(f) = (choice >> f & 1) != 0 ? 0 : size;
      b.end_stiffness[static_cast<std::size_t>(f / 6)](f % 6) = k(f);
    }
    const CondensedBeam condensed(b);
    if (condensed.loose() || condensed.absent()) continue;
    const Mat12 springs = k.asDiagonal();
    // Of dynamic size: the compiler takes minutes over the fixed one.
    const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> inner(Eigen::MatrixXd(whole + springs));
    const Mat12 expected = springs - springs * inner.solve(springs);
    const Vec12 forces = springs * inner.solve(held);
    // The dense elimination loses the digits between the stiffest and the softest spring, six decades and more.
    CHECK((condensed.stiffness() - expected).norm() < 1e-8 * whole.norm());
    const FixedEndForces fixed_end = condensed.fixed_end_forces(std::span(&load, 1));
    if (fixed_end.unbalanced == 0) CHECK((fixed_end.force - forces).norm() < 1e-7 * held.norm());
    ++compared;
  }
  CHECK(compared > 15);
}
