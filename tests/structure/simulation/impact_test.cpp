// The law of impact in closed form, against textbook answers and against an integration of the same equations in small
// steps that shares no code with it.
#include "simulation/impact/impact.h"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace topple::structure;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

namespace {

Matrix one(double value) { return Matrix::Constant(1, 1, value); }
Vector single(double value) { return Vector::Constant(1, value); }

/// Mobility of places on one free rigid body: unit normals along z at x along a bar of this mass and inertia.
Matrix mobility_of_bar(double mass, double inertia, const std::vector<double>& x) {
  const auto n = static_cast<Eigen::Index>(x.size());
  Matrix L(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      L(i, j) = 1 / mass + x[static_cast<std::size_t>(i)] * x[static_cast<std::size_t>(j)] / inertia;
  return L;
}

/// The same motion by the classical Runge-Kutta method, in steps so short that its error is below 1e-9 of the answer:
/// places let go for good when their force comes to zero, and those that a break moved ahead are met again.
struct Integrated {
  Vector depth, speed, impulse, peak;
  std::vector<char> gone;
};
Integrated integrate(const Matrix& L, const Matrix& C, const Vector& v, const Vector& a, double until, int steps) {
  const Eigen::Index n = v.size();
  Integrated now{Vector::Zero(n), v, Vector::Zero(n), Vector::Zero(n),
                 std::vector<char>(static_cast<std::size_t>(n), 0)};
  const auto force = [&](const Vector& d) {
    std::vector<int> touching;
    for (Eigen::Index i = 0; i < n; ++i)
      if (now.gone[static_cast<std::size_t>(i)] == 0) touching.push_back(static_cast<int>(i));
    Vector f = Vector::Zero(n);
    if (touching.empty()) return f;
    const Matrix own = C(touching, touching);
    const Vector pressed = d(touching);
    const Vector solved = own.fullPivLu().solve(pressed);
    f(touching) = solved;
    return f;
  };
  const double h = until / steps;
  for (int k = 0; k < steps; ++k) {
    const auto rate = [&](const Vector& d) { return Vector(a - L * force(d)); };
    const Vector f0 = force(now.depth);
    const Vector k1v = rate(now.depth), k1d = now.speed;
    const Vector k2v = rate(now.depth + h / 2 * k1d), k2d = now.speed + h / 2 * k1v;
    const Vector k3v = rate(now.depth + h / 2 * k2d), k3d = now.speed + h / 2 * k2v;
    const Vector k4v = rate(now.depth + h * k3d), k4d = now.speed + h * k3v;
    now.depth += h / 6 * (k1d + 2 * k2d + 2 * k3d + k4d);
    now.speed += h / 6 * (k1v + 2 * k2v + 2 * k3v + k4v);
    const Vector f1 = force(now.depth);
    now.impulse += h / 2 * (f0 + f1);
    now.peak = now.peak.cwiseMax(f1);
    for (Eigen::Index i = 0; i < n; ++i)
      if (k > 0 && f1(i) < 0) now.gone[static_cast<std::size_t>(i)] = 1;
  }
  return now;
}

}  // namespace

TEST_CASE("a weight that falls on a spring presses with W + sqrt(W^2 + k m v^2), one that is laid down with 2 W") {
  const double m = 300, k = 2e6, g = 9.81;
  for (const double v : {0.0, 0.5, 12.0}) {
    Impact impact(one(1 / m), one(1 / k), single(v), single(g));
    const Impact::Stop stop = impact.push();
    const double w = m * g, expected = w + std::sqrt(w * w + k * m * v * v);
    // Rounding alone: the peak is found to the last digits of its time, at which it is flat.
    CHECK(impact.peak_force()(0) == Approx(expected).epsilon(1e-12));
    CHECK(stop == (v > 0 ? Impact::Stop::parted : Impact::Stop::held));
  }
}

TEST_CASE("two free bodies part with their speeds exchanged by the elastic law and momentum kept") {
  const double m1 = 40, m2 = 700, v = 9;
  Impact impact(one(1 / m1 + 1 / m2), one(3e-8), single(v), single(0));
  CHECK(impact.push() == Impact::Stop::parted);
  CHECK(impact.closing_speed()(0) == Approx(-v).epsilon(1e-12));
  const double mass = 1 / (1 / m1 + 1 / m2);
  CHECK(impact.impulse()(0) == Approx(2 * mass * v).epsilon(1e-12));
  CHECK(impact.peak_force()(0) == Approx(v * std::sqrt(mass / 3e-8)).epsilon(1e-12));
}

TEST_CASE("what fails at a force leaves the speed that energy gives, and the push goes on through the wall") {
  const double m = 500, k = 8e6, v = 20, w = m * 9.81, limit = 4e5;
  Impact impact(one(1 / m), one(1 / k), single(v), single(9.81));
  const auto used = [&](const Vector& force) { return force(0) / limit; };
  REQUIRE(impact.push(used) == Impact::Stop::failed);
  CHECK(impact.force()(0) == Approx(limit).epsilon(1e-12));
  const double squared = v * v - (limit * limit - 2 * w * limit) / (k * m);
  CHECK(impact.closing_speed()(0) == Approx(std::sqrt(squared)).epsilon(1e-12));

  // Behind it a softer wall, 0.3 m farther on: free flight under gravity, then the same law from there.
  const double softer = 2e6, ahead = 0.3, met_at = ahead - limit / k;
  impact.change(one(1 / m), one(1 / softer), single(ahead));
  CHECK(impact.force()(0) == 0);
  impact.push();
  const double there = squared + 2 * 9.81 * met_at;
  CHECK(impact.peak_force()(0) == Approx(w + std::sqrt(w * w + softer * m * there)).epsilon(1e-12));
}

TEST_CASE("a plate that lands flat on four equal springs gives each half of what one spring would feel") {
  const double m = 1000, side = 2, k = 5e6, v = 4;
  const double inertia = m * (side * side) / 12;  // about each axis in its plane
  Matrix L(4, 4);
  const std::array<std::array<double, 2>, 4> at{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      L(i, j) = 1 / m + (at[static_cast<std::size_t>(i)][0] * at[static_cast<std::size_t>(j)][0] +
                         at[static_cast<std::size_t>(i)][1] * at[static_cast<std::size_t>(j)][1]) *
                            side * side / 4 / inertia;
  // The four corners have three freedoms: their mobility is singular.
  Impact impact(L, Matrix::Identity(4, 4) / k, Vector::Constant(4, v), Vector::Zero(4));
  CHECK(impact.push() == Impact::Stop::parted);
  for (int i = 0; i < 4; ++i) {
    CHECK(impact.peak_force()(i) == Approx(v * std::sqrt(k * m) / 2).epsilon(1e-10));
    CHECK(impact.impulse()(i) == Approx(m * v / 2).epsilon(1e-10));
  }
}

TEST_CASE("a bar that lands flat on end springs of 3 k and k feels 0.966 and 0.947 v sqrt(k m)") {
  const double m = 120, length = 5, k = 1e6, v = 3;
  Matrix C = Matrix::Zero(2, 2);
  C(0, 0) = 1 / (3 * k);
  C(1, 1) = 1 / k;
  Impact impact(mobility_of_bar(m, m * length * length / 12, {-length / 2, length / 2}), C, Vector::Constant(2, v),
                Vector::Zero(2));
  impact.push();
  // The published values have three digits.
  CHECK(impact.peak_force()(0) / (v * std::sqrt(k * m)) == Approx(0.966).margin(5e-4));
  CHECK(impact.peak_force()(1) / (v * std::sqrt(k * m)) == Approx(0.947).margin(5e-4));
}

TEST_CASE("a free bar struck at its end meets with a quarter of its mass, in the middle with all of it") {
  const double m = 90, length = 6, k = 4e5, v = 7;
  for (const auto& [x, share] : {std::pair{length / 2, 0.25}, {0.0, 1.0}}) {
    Impact impact(mobility_of_bar(m, m * length * length / 12, {x}), one(1 / k), single(v), single(0));
    impact.push();
    CHECK(impact.peak_force()(0) == Approx(v * std::sqrt(k * share * m)).epsilon(1e-12));
  }
}

TEST_CASE("several places at one instant move as an integration in small steps says") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int trial = 0; trial < 20; ++trial) {
    const int n = 1 + trial % 4;
    // Places on a bar, on springs that know of each other.
    std::vector<double> x;
    for (int i = 0; i < n; ++i) x.push_back(-2 + 4 * (i + 0.8 * unit(random)) / n);
    const double m = 50 + 400 * unit(random);
    const Matrix L = mobility_of_bar(m, m * 16 / 12, x);
    const Matrix B = Matrix::NullaryExpr(n, n, [&] { return unit(random) - 0.5; });
    const Matrix C = (0.3 * B * B.transpose() + Matrix::Identity(n, n)) * 1e-6;
    const double spin = 0.5 * unit(random), fall = 2 + 3 * unit(random);
    Vector v(n), a = Vector::Constant(n, 9.81);
    for (int i = 0; i < n; ++i) v(i) = fall + spin * x[static_cast<std::size_t>(i)];

    Impact impact(L, C, v, a);
    impact.push();
    const double until = impact.time();
    const Integrated expected = integrate(L, C, v, a, until, 40000);
    const double largest = expected.peak.maxCoeff();
    INFO("trial " << trial);
    for (int i = 0; i < n; ++i) {
      // Peaks are read at steps, of which 40,000 cover a few swings: quadratic in the step, 1e-7. A place that lets go
      // does so up to one step late in the integration, which moves impulses by less than 1e-5.
      CHECK(impact.peak_force()(i) == Approx(expected.peak(i)).margin(1e-5 * largest));
      CHECK(impact.impulse()(i) == Approx(expected.impulse(i)).margin(1e-5 * expected.impulse.cwiseAbs().maxCoeff()));
      CHECK(impact.closing_speed()(i) == Approx(expected.speed(i)).margin(1e-4 * v.cwiseAbs().maxCoeff()));
    }
    // Momentum: what the places felt is what changed the speeds.
    const Vector change = v + a * until - L * impact.impulse() - impact.closing_speed();
    CHECK(change.norm() < 1e-12 * v.norm());
  }
}

TEST_CASE("a place that lies behind after a break is met again when the others have let it") {
  // Two places on a bar; the first breaks and its place moves 2 cm on. The bar turns about the second until it is met.
  const double m = 200, length = 4, k = 3e6, v = 2;
  const Matrix L = mobility_of_bar(m, m * length * length / 12, {-length / 2, length / 2});
  const Matrix C = Matrix::Identity(2, 2) / k;
  Impact impact(L, C, Vector::Constant(2, v), Vector::Zero(2));
  const auto used = [&](const Vector& force) { return force(0) / 2e4; };
  REQUIRE(impact.push(used) == Impact::Stop::failed);
  Vector shift(2);
  shift << 0.02, 0;
  impact.change(L, C, shift);
  CHECK_FALSE(impact.touches(0));
  CHECK(impact.touches(1));
  const double energy_before = impact.stored();
  impact.push();
  CHECK(impact.peak_force()(0) > 2e4);
  CHECK(energy_before > 0);
  CHECK_FALSE(impact.goes_on());
}

TEST_CASE("an impact without places, with sizes that differ or a matrix of another kind is refused") {
  CHECK_THROWS_AS(Impact(Matrix(0, 0), Matrix(0, 0), Vector(0), Vector(0)), std::invalid_argument);
  CHECK_THROWS_AS(Impact(one(1), one(1), Vector::Ones(2), single(0)), std::invalid_argument);
  CHECK_THROWS_AS(Impact(one(0), one(1), single(1), single(0)), std::invalid_argument);
  CHECK_THROWS_AS(Impact(one(1), one(-1), single(1), single(0)), std::invalid_argument);
  CHECK_THROWS_AS(Impact(one(1), one(1), single(std::nan("")), single(0)), std::invalid_argument);
}
