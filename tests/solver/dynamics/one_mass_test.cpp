// A frame that moves against closed forms: one mass on a spring, two springs of which one goes.
#include <catch2/catch.hpp>

#include "frames.h"
#include "topple/solver/frame_dynamics.h"

using namespace topple::test;

namespace {

constexpr double mass = 250, stiffness = 4e5;
const double angular_frequency = std::sqrt(stiffness / mass), period = 2 * pi / angular_frequency;

/// One node that moves along z alone, on a spring.
FrameModel one_mass() {
  FrameModel model;
  model.nodes = {Vec3(0, 0, 0)};
  model.supports = {{0, components(rigid, rigid, stiffness, rigid, rigid, rigid)}};
  return model;
}

MassModel its_mass() {
  MassModel masses;
  masses.nodes = {{0, mass, Vec3::Zero()}};
  return masses;
}

DynamicOptions with(double substep, double spectral_radius, RayleighDamping damping = {}) {
  DynamicOptions options;
  options.substep = substep;
  options.spectral_radius = spectral_radius;
  options.damping = damping;
  return options;
}

double height(const FrameDynamics& frame) { return frame.displacements()[0].z(); }

/// The largest difference from the free vibration that starts with this velocity, over three periods.
double error_of_free_vibration(int substeps, double spectral_radius, double velocity) {
  FrameDynamics frame(one_mass(), its_mass(), with(period / substeps, spectral_radius));
  frame.set_state({Vec6::Zero()}, {unit(2, velocity)});
  double worst = 0;
  for (int n = 0; n < 3 * substeps; ++n) {
    frame.advance();
    const double exact = velocity / angular_frequency * std::sin(angular_frequency * frame.time());
    worst = std::max(worst, std::abs(height(frame) - exact));
  }
  return worst;
}

}  // namespace

TEST_CASE("A mass on a spring swings as sin(wt), with an error that falls with the square of the substep") {
  for (const double spectral_radius : {1.0, 0.8, 0.5}) {
    const double coarse = error_of_free_vibration(100, spectral_radius, 1),
                 fine = error_of_free_vibration(200, spectral_radius, 1);
    const double order = std::log2(coarse / fine);
    INFO("spectral radius " << spectral_radius << ": errors " << coarse << ", " << fine << ", order " << order);
    CHECK(order > 1.9);
    CHECK(order < 2.1);
  }
}

TEST_CASE("The period is longer by the square of the substep, as the trapezoidal rule has it") {
  // tan(w' h/2) = w h/2 (T. J. R. Hughes, The Finite Element Method, 9.1).
  const int substeps = 40;
  const double h = period / substeps;
  FrameDynamics frame(one_mass(), its_mass(), with(h, 1));
  frame.set_state({unit(2, 0.01)}, {Vec6::Zero()});
  const double discrete = 2 / h * std::atan(angular_frequency * h / 2);
  for (int n = 1; n <= 10 * substeps; ++n) {
    frame.advance();
    // Rounding over 400 substeps.
    CHECK(height(frame) == Approx(0.01 * std::cos(discrete * n * h)).margin(1e-12));
  }
}

TEST_CASE("A load at once is felt twice, within 0.1 % at 200 substeps a period") {
  for (const double spectral_radius : {1.0, 0.8}) {
    FrameDynamics frame(one_mass(), its_mass(), with(period / 200, spectral_radius));
    frame.set_node_load(0, unit(2, -1000));
    double peak = 0;
    for (int n = 0; n < 400; ++n) {
      frame.advance();
      peak = std::max(peak, -height(frame));
    }
    CHECK(peak / (1000 / stiffness) == Approx(2.0).epsilon(1e-3));
  }
}

TEST_CASE("A load that grows over a period and stays leaves the mass at rest") {
  // f t/T for T = one period: u = f/k (t/T - sin(wt)/(wT)), so that at T both velocity and distance from rest are 0.
  FrameDynamics frame(one_mass(), its_mass(), with(period / 200, 1));
  LoadSet push;
  push.nodes = {{0, unit(2, 1000)}};
  const int pattern = frame.add_pattern(push);
  const double rest = 1000 / stiffness;
  for (int n = 1; n <= 600; ++n) {
    frame.set_pattern(pattern, std::min(1.0, n / 200.0));
    frame.advance();
    const double t = frame.time() / period;
    const double exact = t < 1 ? rest * (t - std::sin(2 * pi * t) / (2 * pi)) : rest;
    // (w h)^2/12 of the period is 8e-5: over the growth it leaves that share of the amplitude rest/(2 pi), several
    // fold.
    CHECK(height(frame) == Approx(exact).margin(5e-4 * rest));
  }
}

TEST_CASE("Damping of a share of the critical one decays as exp(-ratio w t), in stiffness, in mass, in both") {
  const double ratio = 0.05;
  const double a1 = 2 * ratio / angular_frequency, a0 = 2 * ratio * angular_frequency;
  for (const RayleighDamping damping : {RayleighDamping{0, a1}, RayleighDamping{a0, 0},
                                        rayleigh_damping(ratio, angular_frequency, angular_frequency)}) {
    const auto worst = [&](int substeps) {
      FrameDynamics frame(one_mass(), its_mass(), with(period / substeps, 1, damping));
      frame.set_state({Vec6::Zero()}, {unit(2, 1)});
      const double damped = angular_frequency * std::sqrt(1 - ratio * ratio);
      double error = 0;
      for (int n = 0; n < 4 * substeps; ++n) {
        frame.advance();
        const double t = frame.time();
        const double exact = std::exp(-ratio * angular_frequency * t) * std::sin(damped * t) / damped;
        error = std::max(error, std::abs(height(frame) - exact) * angular_frequency);
      }
      return error;
    };
    const double coarse = worst(100), fine = worst(200);
    INFO("a0 " << damping.mass << ", a1 " << damping.stiffness << ": " << coarse << ", " << fine);
    CHECK(fine < 4e-3);  // of the amplitude; (w h)^2/12 x 8 pi for the phase, and as much again
    CHECK(std::log2(coarse / fine) > 1.9);
    CHECK(std::log2(coarse / fine) < 2.1);
  }
}

TEST_CASE("Damping that comes on the way goes on from the motion there, and decays by its own ratio") {
  const double ratio = 0.05;
  const int substeps = 200;
  FrameDynamics frame(one_mass(), its_mass(), with(period / substeps, 1));
  frame.set_state({unit(2, 0.01)}, {Vec6::Zero()});
  for (int n = 0; n < substeps / 2; ++n) frame.advance();
  const double before = frame.energy().kinetic + frame.energy().elastic, from = frame.time();
  const double u0 = height(frame), v0 = frame.velocities()[0].z();
  frame.set_damping(rayleigh_damping(ratio, angular_frequency, angular_frequency));
  CHECK(height(frame) == Approx(u0).epsilon(1e-13));  // in other scales
  CHECK(frame.velocities()[0].z() == Approx(v0).epsilon(1e-13));
  const double w = angular_frequency, damped = w * std::sqrt(1 - ratio * ratio);
  for (int n = 0; n < 3 * substeps; ++n) {
    frame.advance();
    const double t = frame.time() - from;
    const double exact =
        std::exp(-ratio * w * t) * (u0 * std::cos(damped * t) + (v0 + ratio * w * u0) / damped * std::sin(damped * t));
    CHECK(height(frame) == Approx(exact).margin(4e-3 * 0.01));  // as above
  }
  const DynamicEnergy& e = frame.energy();
  CHECK(e.damped > 0.5 * before);
  CHECK(e.kinetic + e.elastic + e.damped + e.numerical == Approx(before).epsilon(1e-10));
  CHECK_THROWS_AS(frame.set_damping({-1, 0}), std::invalid_argument);
  CHECK_THROWS_AS(frame.set_damping({0, std::nan("")}), std::invalid_argument);
}

TEST_CASE("A ground that accelerates at once swings the mass about its new rest, relative to the ground") {
  FrameDynamics frame(one_mass(), its_mass(), with(period / 200, 1));
  const int ground = frame.add_ground_acceleration(Vec3(0, 0, 1));
  frame.jump_pattern(ground, 2.5);
  double lowest = 0;
  for (int n = 0; n < 220; ++n) {
    frame.advance();
    lowest = std::min(lowest, height(frame));
  }
  CHECK(lowest == Approx(-2 * 2.5 * mass / stiffness).epsilon(1e-3));
}

TEST_CASE("Of two supports one goes: the mass swings to twice the way to its new rest") {
  // Two bars without mass from one node to the ceiling; the load was carried by both.
  FrameModel model;
  model.nodes = {Vec3(0, 0, 0), Vec3(0, 0, 2), Vec3(0, 0, 4)};
  add_beam(model, 0, 1);
  add_beam(model, 0, 2);
  model.supports = {{0, components(rigid, rigid, 0, rigid, rigid, rigid)}, {1, fixed()}, {2, fixed()}};
  const Beam& bar = model.beams[0];
  const double k1 = bar.youngs_modulus * bar.area / 2, k2 = bar.youngs_modulus * bar.area / 4, weight = 5e5;
  const double w = std::sqrt(k2 / mass), own_period = 2 * pi / w;
  FrameDynamics frame(model, its_mass(), with(own_period / 200, 1));
  frame.set_node_load(0, unit(2, -weight));
  std::vector<Vec6> rest(3, Vec6::Zero());
  rest[0](2) = -weight / (k1 + k2);
  frame.set_state(rest, std::vector<Vec6>(3, Vec6::Zero()));
  frame.advance();
  CHECK(height(frame) == Approx(rest[0](2)).epsilon(1e-12));  // nothing moves yet
  frame.set_end_stiffness(0, 0, Vec6::Zero());
  const double begin = frame.time(), stored = frame.energy().elastic;
  double lowest = 0, worst = 0;
  for (int n = 0; n < 200; ++n) {
    frame.advance();
    lowest = std::min(lowest, height(frame));
    const double exact = -weight / k2 + (rest[0](2) + weight / k2) * std::cos(w * (frame.time() - begin));
    worst = std::max(worst, std::abs(height(frame) - exact));
  }
  CHECK(lowest == Approx(rest[0](2) + 2 * (-weight / k2 - rest[0](2))).epsilon(1e-3));
  CHECK(worst < 1e-3 * weight / k2);  // phase: (w h)^2/12 x 2 pi
  // The strain energy of the bar that went is freed, no more and no less.
  CHECK(frame.energy().freed == Approx(0.5 * k1 * rest[0](2) * rest[0](2)).epsilon(1e-9));
  CHECK(stored == Approx(0.5 * (k1 + k2) * rest[0](2) * rest[0](2)).epsilon(1e-9));
}

TEST_CASE("An impulse on a damped mass leaves it what an implicit step of its damping leaves: J/(m + h a1 k)") {
  const double h = period / 20, impulse = 30;
  for (const double a1 : {0.0, 1e-6, 0.02 / angular_frequency, 2 / angular_frequency}) {
    FrameDynamics frame(one_mass(), its_mass(), with(h, 1, {0, a1}));
    const std::vector<std::vector<FrameDynamics::Impulse>> push = {{{0, unit(2, impulse)}}};
    const double exact = impulse / (mass + h * a1 * stiffness);
    INFO("damping of stiffness " << a1 << " s");
    CHECK(frame.velocities_of(push[0])[0].z() == Approx(exact).epsilon(1e-12));
    CHECK(frame.mobility(push)(0, 0) == Approx(impulse * exact).epsilon(1e-12));
    frame.strike(push[0]);
    CHECK(frame.velocities()[0].z() == Approx(exact).epsilon(1e-12));
  }
}

TEST_CASE("What an impulse leaves does not hang on substeps below its shortest duration") {
  const double duration = period / 20, impulse = 30, a1 = 2 / angular_frequency;
  for (const int parts : {1, 3, 16}) {
    INFO(parts << " substeps in its duration");
    DynamicOptions options = with(duration / parts, 1, {0, a1});
    options.shortest_impulse = duration;
    FrameDynamics frame(one_mass(), its_mass(), options);
    const std::vector<std::vector<FrameDynamics::Impulse>> push = {{{0, unit(2, impulse)}}};
    const double exact = impulse / (mass + duration * a1 * stiffness);
    CHECK(frame.velocities_of(push[0])[0].z() == Approx(exact).epsilon(1e-12));
    CHECK(frame.mobility(push)(0, 0) == Approx(impulse * exact).epsilon(1e-12));
    frame.strike(push[0]);
    CHECK(frame.velocities()[0].z() == Approx(exact).epsilon(1e-12));
    frame.advance();
    const DynamicEnergy& energy = frame.energy();
    CHECK(energy.kinetic + energy.elastic + energy.damped + energy.numerical == Approx(energy.struck).epsilon(1e-12));
  }
  DynamicOptions options = with(duration, 1, {0, a1});
  options.shortest_impulse = -duration;
  CHECK_THROWS_AS(FrameDynamics(one_mass(), its_mass(), options), std::invalid_argument);
}
