// Releases at both ends, in every combination that a broken joint leaves behind.
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
