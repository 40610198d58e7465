// Second order in motion: a mass on a post that its weight presses, against the stiffness that a beam-column has in
// closed form, below and above the critical load.
#include <catch2/catch.hpp>

#include "post_with_mass.h"

using namespace topple::test;

namespace {

constexpr double push = 1e3;

/// E I in the plane of the push, by the post's own give: H h^3/(3 EI) and its shear apart.
double bending_stiffness() {
  FrameModel model = post();
  model.beams[0].shear_modulus *= 1e9;
  LoadSet load;
  load.nodes = {{1, unit(0, push)}};
  return push * std::pow(height, 3) / (3 * solve_one(model, load).displacements[1](0));
}

/// Of a cantilever under a load P on top, along the push: exact, P/(tan(aL)/a - L) with a^2 = P/EI (S. P. Timoshenko,
/// J. M. Gere, Theory of Elastic Stability, 1-3).
double exact_stiffness(double P) {
  const double a = std::sqrt(P / bending_stiffness());
  return P / (std::tan(a * height) / a - height);
}

/// The same of one cubic, its rotation condensed.
double cubic_stiffness(double P) {
  const double EI = bending_stiffness(), L = height;
  const double across = 12 * EI / (L * L * L) - 1.2 * P / L, mixed = -6 * EI / (L * L) + 0.1 * P,
               turn = 4 * EI / L - 2.0 / 15 * P * L;
  return across - mixed * mixed / turn;
}

double critical() { return std::pow(pi / (2 * height), 2) * bending_stiffness(); }

FrameDynamics pressed(double P, double substep, double spectral_radius = 1, RayleighDamping damping = {}) {
  DynamicOptions options;
  options.substep = substep;
  options.spectral_radius = spectral_radius;
  options.damping = damping;
  options.second_order = true;
  FrameModel model = post();
  model.beams[0].shear_modulus *= 1e9;
  LoadSet weight;
  weight.nodes = {{1, unit(2, -P)}};
  const std::vector<Vec6> rest = solve_one(model, weight).displacements;
  FrameDynamics frame(model, mass_on_post(), options);
  frame.set_node_load(1, components(push, 0, -P, 0, 0, 0));
  frame.set_state(rest, std::vector<Vec6>(2, Vec6::Zero()));
  return frame;
}

}  // namespace

TEST_CASE("A sudden push on a pressed post peaks at twice its second-order answer, after half of the longer period") {
  for (const double share : {0.2, 0.5, 0.8}) {
    const double P = share * critical(), k = cubic_stiffness(P), period = 2 * pi * std::sqrt(tip_mass / k);
    INFO("P/Pcr " << share);
    // The cubic's critical load is 0.75 % above the exact one: near it the stiffness left is off by more.
    CHECK(k == Approx(exact_stiffness(P)).epsilon(0.01 / (1 - share)));
    FrameDynamics frame = pressed(P, period / 200);
    double peak = 0, at = 0, moment = 0;
    for (int n = 0; n < 150; ++n) {
      frame.advance();
      const double x = frame.displacements()[1].x();
      if (x > peak) at = frame.time();
      peak = std::max(peak, x);
      const Vec12 forces = frame.beam_end_forces(0);
      moment = std::max(moment, std::hypot(forces(4), forces(5)));
    }
    CHECK(peak == Approx(2 * push / k).epsilon(1e-3));
    CHECK(at == Approx(period / 2).epsilon(0.01));
    // At the foot: what restores the mass, k x over the height, and its weight over the way that it has gone.
    CHECK(moment == Approx(k * peak * height + P * peak).epsilon(1e-3));
    CHECK(frame.counters().unsettled == 0);
  }
}

TEST_CASE("A post pressed beyond its critical load falls over as fast as its negative stiffness says") {
  const double P = 1.5 * critical(), k = cubic_stiffness(P), rate = std::sqrt(-k / tip_mass);
  REQUIRE(k < 0);
  const auto error = [&](double h) {
    FrameDynamics frame = pressed(P, h);
    while (frame.time() < 3 / rate) frame.advance();
    const double exact = push / -k * (std::cosh(rate * frame.time()) - 1);
    return std::abs(frame.displacements()[1].x() / exact - 1);
  };
  const double coarse = error(0.03 / rate), fine = error(0.015 / rate);
  INFO("errors " << coarse << ", " << fine);
  CHECK(coarse < 2e-3);
  CHECK(std::log2(coarse / fine) == Approx(2).margin(0.2));
}

TEST_CASE("With second order energy balances to rounding, the work of geometric forces within that of loads") {
  for (const double spectral_radius : {1.0, 0.8}) {
    const double P = 0.6 * critical();
    FrameDynamics frame = pressed(P, 1.0 / 480, spectral_radius, {0.4, 2e-4});
    const double at_start = frame.energy().elastic;
    double worst = 0, size = 0;
    for (int n = 0; n < 2000; ++n) {
      frame.advance();
      worst = std::max(worst, std::abs(balance(frame.energy(), at_start)));
      size = std::max(size, frame.energy().external_work);
    }
    CHECK(worst < 1e-9 * size);
    CHECK(frame.energy().damped > 0.1 * size);
  }
}

TEST_CASE("A beam that holds nothing at one end is pushed nowhere by what hangs there") {
  // A bar under its own weight hangs from a node; its lower end let go of a node that moves.
  FrameModel model = post();
  model.supports = {{1, fixed()}, {0, components(rigid, 1e4, rigid, rigid, rigid, rigid)}};
  model.beams[0].density = 7850;
  model.beams[0].end_stiffness[0].setZero();
  MassModel masses;
  masses.nodes = {{0, tip_mass, Vec3::Zero()}};
  DynamicOptions options;
  options.second_order = true;
  options.substep = 1.0 / 480;
  FrameDynamics frame(model, masses, options);
  frame.set_beam_loads(0, {uniform_load(0, height, components(-1e5, 0, 0, 0, 0, 0))});
  frame.set_state({unit(1, 0.1), Vec6::Zero()}, std::vector<Vec6>(2, Vec6::Zero()));
  const double before = frame.displacements()[0].y();
  frame.advance();
  // The mass swings on its spring alone; the bar bends under nothing.
  const double w = std::sqrt(1e4 / tip_mass);
  CHECK(frame.displacements()[0].y() == Approx(before * std::cos(w / 480)).epsilon(1e-4));
  CHECK(std::abs(frame.beam_end_forces(0)(1)) + std::abs(frame.beam_end_forces(0)(2)) < 1e-9);
}
