// The law of impact against closed forms of mechanics and against a numerically integrated mass on a spring.
#include "simulation/impact/indentation.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using topple::structure::Indentation;
namespace {
constexpr double never = std::numeric_limits<double>::infinity();
constexpr double g = 9.80665;

/// Largest spring force on a mass that arrives at `speed` with its weight acting, by velocity Verlet in small steps.
double integrated_peak(double mass, double speed, double weight, double stiffness) {
  const double period = 2 * M_PI * std::sqrt(mass / stiffness), dt = period / 200000;
  double d = 0, v = speed, a = weight / mass, peak = 0;
  for (int i = 0; i < 200000 && v > -1e-12; ++i) {
    d += v * dt + 0.5 * a * dt * dt;
    const double next = (weight - stiffness * d) / mass;
    v += 0.5 * (a + next) * dt;
    a = next;
    peak = std::max(peak, stiffness * d);
  }
  return peak;
}
}  // namespace

TEST_CASE("a weight dropped on a light elastic beam peaks at 1 + sqrt(1 + 2 h/d) times its weight") {
  const double mass = 120, weight = mass * g, stiffness = 8e5, d = weight / stiffness;
  for (const double h : {0.0, 0.01, 0.5, 3.0}) {
    Indentation body(mass, std::sqrt(2 * g * h), weight, 0);
    REQUIRE(body.push(1 / stiffness, never) == Indentation::Stop::stood);
    CHECK(body.peak_force() == Approx(weight * (1 + std::sqrt(1 + 2 * h / d))).epsilon(1e-12));  // rounding
  }
}

TEST_CASE("a weight laid on suddenly is felt twice") {
  Indentation body(500, 0, 500 * g, 0);
  REQUIRE(body.push(1e-6, never) == Indentation::Stop::stood);
  CHECK(body.peak_force() == Approx(2 * 500 * g).epsilon(1e-14));
}

TEST_CASE("a mass on a spring is stopped by v sqrt(k m)") {
  Indentation body(500, 60, 0, 0);
  REQUIRE(body.push(1 / 3e6, never) == Indentation::Stop::stood);
  CHECK(body.peak_force() == Approx(60 * std::sqrt(3e6 * 500)).epsilon(1e-14));
  CHECK(body.elastic_rebound_speed() == Approx(60).epsilon(1e-12));  // all of it is stored
}

TEST_CASE("the peak agrees with a mass on a spring that is integrated in time, also when pushed from below") {
  for (const double weight : {3000.0, 0.0, -3000.0}) {
    Indentation body(300, 4, weight, 0);
    REQUIRE(body.push(1 / 2e5, never) == Indentation::Stop::stood);
    // Verlet with 2e5 steps a period: relative error below (2 pi / 2e5)^2, and the peak is sampled at its flat top
    CHECK(body.peak_force() == Approx(integrated_peak(300, 4, weight, 2e5)).epsilon(1e-8));
  }
}

TEST_CASE("the speed left after a break is what energy leaves") {
  const double mass = 500, speed = 60, weight = 700, stiffness = 4e6, failure = 9e5;
  Indentation body(mass, speed, weight, 0);
  REQUIRE(body.push(1 / stiffness, failure) == Indentation::Stop::failed);
  const double travel = failure / stiffness;
  const double energy = mass * speed * speed / 2 + weight * travel - failure * failure / (2 * stiffness);
  CHECK(body.speed() == Approx(std::sqrt(2 * energy / mass)).epsilon(1e-12));
  CHECK(body.force() == failure);
}

TEST_CASE("pushing goes on after a break with the new stiffness from the new place") {
  const double mass = 400, speed = 20, k1 = 3e6, k2 = 5e5, failure = 2e5, shift = 0.02;
  Indentation body(mass, speed, 0, 0);
  REQUIRE(body.push(1 / k1, failure) == Indentation::Stop::failed);
  body.shift(shift);
  REQUIRE(body.push(1 / k2, never) == Indentation::Stop::stood);
  const double d = failure / k1, start = std::max(0.0, k2 * (d - shift));
  const double kinetic = mass * speed * speed / 2 - failure * d / 2;
  CHECK(body.peak_force() == Approx(std::sqrt(start * start + 2 * k2 * kinetic)).epsilon(1e-12));
}

TEST_CASE("a softer structure that is already pushed beyond its next failure breaks on at once") {
  Indentation body(400, 20, 0, 0);
  REQUIRE(body.push(1e-6, 1e5) == Indentation::Stop::failed);
  const double speed = body.speed();
  REQUIRE(body.push(1e-6, 5e4) == Indentation::Stop::failed);
  CHECK(body.speed() == speed);
}

TEST_CASE("a body on its way up does not catch a place that springs away from it") {
  Indentation body(100, 5, -100 * g, 0);
  REQUIRE(body.push(1e-5, 1e4) == Indentation::Stop::failed);
  body.shift(10);
  CHECK(body.push(1e-5, never) == Indentation::Stop::missed);
}

TEST_CASE("a place that gives way by three metres lets the body go on with the speed that it has there") {
  // 1000 kg at 10 m/s on 1e-2 m/N would go 32 m deep.
  Indentation body(1000, 10, 0, 0);
  CHECK(body.push(1e-3 * 10, never) == Indentation::Stop::missed);
  CHECK(body.indentation() == Approx(3).epsilon(1e-12));
  CHECK(body.speed() == Approx(std::sqrt(100 - 3.0 * 3.0 / 1e-2 / 1000)).epsilon(1e-12));
}

TEST_CASE("what a break takes from under a contact is what the contact held less what it holds after") {
  Indentation body(1000, 1, 0, 0);
  REQUIRE(body.push(1e-6, 1e4) == Indentation::Stop::failed);
  CHECK(body.stored(1e-6) == Approx(0.5 * 1e4 * 1e4 * 1e-6).epsilon(1e-12));
  body.shift(0.004);  // of the 10 mm that it is deep
  CHECK(body.stored(2e-6) == Approx(0.5 * 0.006 * 0.006 / 2e-6).epsilon(1e-12));
}

TEST_CASE("first contact shares momentum with the structure's mass and loses what a plastic contact loses") {
  const double m = 200, M = 75, v = 12;
  Indentation body(m, v, 0, M);
  CHECK(body.speed() * (m + M) == Approx(m * v).epsilon(1e-14));
  CHECK(body.lost_at_contact() == Approx(m * v * v / 2 - (m + M) * body.speed() * body.speed() / 2).epsilon(1e-12));
}
