// Axial force that changes along a member: columns under their own weight, by closed form and against themselves in
// pieces.
#include <catch2/catch.hpp>
#include <cmath>

#include "topple/solver/buckling.h"
#include "topple/solver/second_order.h"

using namespace topple::solver;

namespace {

constexpr double E = 2e11, I = 3e-5, height = 12;

/// A cantilever that stands on its foot, in equal pieces; bending in the x-z plane is by Iy.
FrameModel column(int pieces, double shear_area = 0) {
  FrameModel model;
  for (int i = 0; i <= pieces; ++i) model.nodes.emplace_back(0, 0, height * i / pieces);
  for (int i = 0; i < pieces; ++i) {
    Beam beam;
    beam.node = {i, i + 1};
    beam.axes << 0, 0, 1, 0, -1, 0, 1, 0, 0;
    beam.length = height / pieces;
    beam.youngs_modulus = E;
    beam.shear_modulus = 8e10;
    beam.area = 0.01;
    beam.shear_area_y = beam.shear_area_z = shear_area;
    beam.Iy = I;
    beam.Iz = 2 * I;
    beam.J = 1e-6;
    model.beams.push_back(beam);
  }
  model.supports = {{0, Vec6::Constant(rigid)}};
  return model;
}

/// Per length: down from `foot` to `head`, and across (along x), whole or by piece.
LoadSet load(int pieces, double foot, double head, double across = 0) {
  LoadSet set;
  for (int i = 0; i < pieces; ++i) {
    BeamLoad own;
    own.beam = i;
    own.to = height / pieces;
    own.first(0) = -(foot + (head - foot) * i / pieces);
    own.last(0) = -(foot + (head - foot) * (i + 1) / pieces);
    own.first(2) = own.last(2) = across;
    set.beams.push_back(own);
  }
  return set;
}

/// Timoshenko and Gere, 2.11: with the weight q per length, the slope at x below the free head obeys
/// EI s'' + q x s = 0, s'(0) = 0. Its series in x^3 first vanishes at the foot at the critical q.
double critical_weight() {
  const auto foot_slope = [](double a) {
    double term = 1, sum = 1;
    for (int k = 1; k < 40; ++k) {
      term *= -a / (3.0 * k * (3.0 * k - 1));
      sum += term;
    }
    return sum;
  };
  double low = 7, high = 9;
  for (int i = 0; i < 100; ++i) (foot_slope((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
  return low * E * I / std::pow(height, 3);
}

double tip(int pieces, const LoadSet& set, double shear_area = 0) {
  const FrameModel model = column(pieces, shear_area);
  const StaticSolution linear = StaticAnalysis(model).solve({&set, 1}).front();
  return SecondOrderAnalysis(model, SecondOrder::exact).solve(set, linear).solution.displacements.back()(0);
}

}  // namespace

TEST_CASE("a column buckles under its own weight at the closed form, in one piece and in eight") {
  CHECK(critical_weight() * std::pow(height, 3) / (E * I) == Approx(7.8373).epsilon(1e-5));  // as it is printed
  for (const int pieces : {1, 8}) {
    const auto modes = buckling_modes(column(pieces), load(pieces, 100, 100), 1, {});
    REQUIRE(modes.size() == 1);
    INFO(pieces << " pieces");
    CHECK(modes[0].factor * 100 == Approx(critical_weight()).epsilon(1e-9));
  }
}

TEST_CASE("under its own weight and wind a column leans the same whatever the pieces that it is cut into") {
  const double heavy = 0.7 * critical_weight();
  // A weight that grows downwards makes the axial force a parabola.
  for (const double head : {1.0, 0.2})
    for (const double shear_area : {0.0, 2e-4}) {
      const double whole = tip(1, load(1, heavy, head * heavy, 800), shear_area);
      CHECK(whole > 1.2 * 800 * std::pow(height, 4) / (8 * E * I));  // far from first order
      for (const int pieces : {8, 64})
        // Short pieces are stiff: 64 of them cost eight digits.
        CHECK(tip(pieces, load(pieces, heavy, head * heavy, 800), shear_area) == Approx(whole).epsilon(1e-8));
    }
}

TEST_CASE("moments along a heavy column are those of its displaced pieces") {
  const double heavy = 0.5 * critical_weight();
  const LoadSet set = load(1, heavy, heavy, 500);
  const FrameModel model = column(1);
  const StaticSolution linear = StaticAnalysis(model).solve({&set, 1}).front();
  const SecondOrderSolution found = SecondOrderAnalysis(model, SecondOrder::exact).solve(set, linear);
  const Beam& beam = model.beams.front();
  const SecondOrderDiagram diagram(beam, found.axial, 0, found.solution.beam_end_forces[0],
                                   beam_rigid_end_displacements(beam, found.solution.displacements));
  // Statics of what stands above a cut: wind times lever, and each length's weight times its lead over the cut.
  const double head = found.solution.displacements[1](0);
  const auto deflection = [&](double x) { return diagram.values(x)[BeamDiagram::deflection_z] + x / height * head; };
  for (const double cut : {0.0, 3.0, 7.5}) {
    constexpr int steps = 400;  // Simpson's rule
    double moment = 500 * std::pow(height - cut, 2) / 2;
    const double h = (height - cut) / steps;
    for (int i = 0; i <= steps; ++i) {
      const double weight = (i == 0 || i == steps ? 1 : i % 2 == 1 ? 4 : 2) * h / 3;
      moment += weight * heavy * (deflection(cut + i * h) - deflection(cut));
    }
    CHECK(std::abs(diagram.values(cut)[BeamDiagram::moment_y]) == Approx(moment).epsilon(1e-7));
  }
}
