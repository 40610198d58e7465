// The reference of the benchmarks against closed forms, worked out in the same precision: it must be right to far below
// the rounding of double precision, or it cannot judge.
#include <catch2/catch.hpp>

#include "extended_frame.h"

namespace {

using reference::Quad;
using namespace topple::solver;

/// Far above quadruple rounding (1e-34) times the condition of these few freedoms, far below double rounding (1e-16).
constexpr double limit = 1e-28;

double off(Quad value, Quad expected) {
  const Quad difference = value / expected - 1;
  return static_cast<double>(difference < 0 ? -difference : difference);
}

Beam along_x(int first, int second, double length) {
  Beam beam;
  beam.node = {first, second};
  beam.length = length;
  beam.youngs_modulus = 210e9;
  beam.shear_modulus = 81e9;
  beam.area = 0.011;
  beam.Iy = 1.6e-4;
  beam.Iz = 1.2e-5;
  beam.J = 4e-7;
  return beam;
}

FrameModel cantilever(double length) {
  FrameModel model;
  model.nodes = {Vec3::Zero(), Vec3(length, 0, 0)};
  model.beams = {along_x(0, 1, length)};
  model.supports = {{0, Vec6::Constant(rigid)}};
  return model;
}

}  // namespace

TEST_CASE("the reference gives a cantilever's tip under a load to quadruple precision") {
  FrameModel model = cantilever(3);
  model.beams[0].shear_area_z = 0.004;
  LoadSet loads;
  loads.nodes.push_back({1, Vec6(0, 0, -7, 0, 0, 0)});
  const auto answer = reference::solve<Quad>(model, loads);
  const Quad E = 210e9, G = 81e9, I = 1.6e-4, As = 0.004;
  CHECK(off(answer.displacements[1][2], Quad(-7) * 27 / (3 * E * I) - Quad(7) * 3 / (G * As)) < limit);
  CHECK(off(answer.reactions[0][2], 7) < limit);
  CHECK(off(answer.reactions[0][4], -21) < limit);
}

TEST_CASE("the reference gives a distributed load's deflection and end forces to quadruple precision") {
  const FrameModel model = cantilever(3);
  LoadSet loads;
  BeamLoad load;
  load.beam = 0;
  load.to = 3;
  load.first[1] = load.last[1] = 5;
  loads.beams.push_back(load);
  const auto answer = reference::solve<Quad>(model, loads);
  const Quad E = 210e9, I = 1.2e-5;
  CHECK(off(answer.displacements[1][1], Quad(5) * 81 / (8 * E * I)) < limit);
  CHECK(off(answer.beam_end_forces[0][5], Quad(-45) / 2) < limit);
}

TEST_CASE("the reference condenses a spring at a member's end exactly") {
  FrameModel model = cantilever(3);
  model.beams[0].end_stiffness[0][4] = 2e6;  // turns about y at the support
  LoadSet loads;
  loads.nodes.push_back({1, Vec6(0, 0, -7, 0, 0, 0)});
  const auto answer = reference::solve<Quad>(model, loads);
  const Quad E = 210e9, I = 1.6e-4, k = 2e6;
  CHECK(off(answer.displacements[1][2], Quad(-7) * 27 / (3 * E * I) - Quad(7) * 9 / k) < limit);
}

TEST_CASE("the reference holds a structure on a support spring and tells what the spring bears") {
  FrameModel model = cantilever(3);
  Vec6 spring = Vec6::Zero();
  spring[2] = 1e5;
  model.supports.push_back({1, spring});
  LoadSet loads;
  loads.nodes.push_back({1, Vec6(0, 0, -7, 0, 0, 0)});
  const auto answer = reference::solve<Quad>(model, loads);
  const Quad bending = 3 * Quad(210e9) * Quad(1.6e-4) / 27, k = 1e5;
  CHECK(off(answer.displacements[1][2], Quad(-7) / (bending + k)) < limit);
  CHECK(off(answer.reactions[1][2], 7 * k / (bending + k)) < limit);
}

TEST_CASE("the reference refuses what it does not know, and what does not stand") {
  FrameModel model = cantilever(3);
  LoadSet loads;
  loads.settlements.push_back({0, 2, 0.1});
  CHECK_THROWS_WITH(reference::solve<Quad>(model, loads), Catch::Contains("settlements"));
  model.supports.clear();
  CHECK_THROWS_WITH(reference::solve<Quad>(model, {}), Catch::Contains("not stable"));
}
