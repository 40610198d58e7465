// Hinges that yield while a frame moves: against the closed form of a sudden load on an elastic, perfectly plastic
// spring, and against an integration of a shear frame that shares no code.
#include <catch2/catch.hpp>

#include "post_with_mass.h"

using namespace topple::test;

namespace {

class Yielding : public JointLaw {
 public:
  explicit Yielding(std::vector<PlasticHinge> hinges) : hinges_(std::move(hinges)) {}
  [[nodiscard]] double beam_utilisation(int, const Vec12&) const override { return 0; }
  [[nodiscard]] double end_utilisation(int, int, const Vec12&) const override { return 0; }
  [[nodiscard]] std::span<const PlasticHinge> plastic_hinges() const override { return hinges_; }

 private:
  std::vector<PlasticHinge> hinges_;
};

constexpr double capacity = 9e4;
double spring_of_post() {
  FrameModel model = post();
  LoadSet load;
  load.nodes = {{1, unit(0, 1)}};
  return 1 / solve_one(model, load).displacements[1](0);
}
/// The component of the foot's end forces that the push bends.
int bent() {
  FrameModel model = post();
  LoadSet load;
  load.nodes = {{1, unit(0, 1)}};
  const Vec12 forces = solve_one(model, load).beam_end_forces[0];
  return std::abs(forces(4)) > std::abs(forces(5)) ? 4 : 5;
}

struct Pushed {
  double largest = 0, turned = 0, unbalanced = 0;
  DynamicEnergy energy;
};
Pushed push_post(double share, double substep, double spectral_radius, RayleighDamping damping = {}) {
  DynamicOptions options;
  options.substep = substep;
  options.spectral_radius = spectral_radius;
  options.damping = damping;
  FrameDynamics frame(post(), mass_on_post(), options);
  frame.set_node_load(1, unit(0, share * capacity / height));
  const Yielding law({{0, 0, bent(), capacity, 10}});
  Pushed result;
  const double period = 2 * pi * std::sqrt(tip_mass / spring_of_post());
  while (frame.time() < 3 * period) {
    frame.advance(&law);
    result.largest = std::max(result.largest, frame.displacements()[1](0));
    const DynamicEnergy& energy = frame.energy();
    result.unbalanced = std::max(result.unbalanced, std::abs(balance(energy, 0)));
  }
  result.unbalanced /= frame.energy().external_work;
  result.turned = std::abs(frame.plastic_rotations(0)(bent()));
  result.energy = frame.energy();
  return result;
}

}  // namespace

TEST_CASE("A sudden load of 1 - 1/(2 m) of what a post yields at bends it to m times its elastic limit") {
  const double yields_at = capacity / height / spring_of_post();
  for (const double ductility : {1.5, 2.0, 5.0}) {
    const double share = 1 - 1 / (2 * ductility);
    double errors[2];
    for (int fine = 0; fine < 2; ++fine) {
      const Pushed pushed = push_post(share, fine ? 1e-4 : 2e-4, 1);
      errors[fine] = std::abs(pushed.largest / (ductility * yields_at) - 1);
      // What it turned is what it went beyond the elastic limit, about its foot.
      CHECK(pushed.turned == Approx((ductility - 1) * yields_at / height).epsilon(2e-3));
      CHECK(pushed.energy.dissipated == Approx(capacity * pushed.turned).epsilon(1e-12));
      CHECK(pushed.unbalanced < 1e-9);  // rounding: s M is a thousandfold K at such substeps
    }
    INFO("ductility " << ductility << ": errors " << errors[0] << ", " << errors[1]);
    CHECK(errors[1] < 1e-3);
    CHECK(errors[1] < 0.75 * errors[0] + 1e-6);  // first order or better
  }
}

TEST_CASE("What a plastic hinge does balances with damping and with a method that dissipates") {
  const Pushed pushed = push_post(0.9, 1e-3, 0.8, {0.3, 1e-3});
  CHECK(pushed.turned > 0);
  CHECK(pushed.unbalanced < 1e-9);  // rounding: s M is a thousandfold K at such substeps
}

TEST_CASE("A post that has turned swings about where it stays, and turns no further under the same load") {
  const Pushed once = push_post(1 - 1 / 3.0, 5e-4, 1);
  DynamicOptions options;
  options.substep = 5e-4;
  options.spectral_radius = 1;
  FrameDynamics frame(post(), mass_on_post(), options);
  const double sign = once.turned > 0 ? 1 : -1;
  // As found: the sign of the turn is that of what the hinge holds.
  const Vec12 forces = [&] {
    LoadSet load;
    load.nodes = {{1, unit(0, 1)}};
    return solve_one(post(), load).beam_end_forces[0];
  }();
  frame.set_plastic_rotation(0, 0, bent(), sign * std::copysign(once.turned, forces(bent())));
  const double stays = once.turned * height;
  frame.set_state({Vec6::Zero(), Vec6::Zero()}, std::vector<Vec6>(2, Vec6::Zero()));
  const Yielding law({{0, 0, bent(), capacity, 10}});
  double least = 1, most = -1;
  for (int n = 0; n < 4000; ++n) {
    frame.advance(&law);
    least = std::min(least, frame.displacements()[1](0));
    most = std::max(most, frame.displacements()[1](0));
  }
  // It starts straight, which is as far from where it stays as it swings to the other side.
  CHECK((least + most) / 2 == Approx(stays).epsilon(1e-3));
}

namespace {

/// Two storeys that shear: posts whose ends cannot turn, each with a hinge at both ends, under a ground that shakes.
constexpr double floor_mass[2] = {9000, 7000}, post_capacity[2] = {1.6e5, 0.9e5};
constexpr double turns_out = 0.001;

FrameModel shear_frame() {
  FrameModel model;
  model.nodes = {Vec3(0, 0, 0), Vec3(0, 0, height), Vec3(0, 0, 2 * height)};
  model.supports = {{0, fixed()},
                    {1, components(0, rigid, rigid, rigid, rigid, rigid)},
                    {2, components(0, rigid, rigid, rigid, rigid, rigid)}};
  add_beam(model, 0, 1);
  add_beam(model, 1, 2);
  for (Beam& beam : model.beams) beam.density = 0;
  return model;
}
/// N/m of one storey.
double storey_spring() {
  FrameModel model = shear_frame();
  LoadSet load;
  load.nodes = {{1, unit(0, 1)}};
  model.beams.pop_back();
  model.nodes.pop_back();
  model.supports.pop_back();
  return 1 / solve_one(model, load).displacements[1](0);
}
double ground(double t) { return 6 * std::sin(14 * t) + 3 * std::sin(31 * t); }  // m/s2

struct Shaken {
  std::vector<std::array<double, 2>> displacement;  ///< at each sampled time
  std::array<double, 2> drift{};                    ///< that stays, m
  double broke_at = -1;
};
constexpr double sampled = 0.01, shaken_for = 2.5;

Shaken by_the_frame(double h, bool breaks) {
  MassModel masses;
  for (int i = 0; i < 2; ++i) masses.nodes.push_back({i + 1, floor_mass[i], Vec3::Zero()});
  DynamicOptions options;
  options.substep = h;
  options.spectral_radius = 1;
  FrameDynamics frame(shear_frame(), masses, options);
  std::vector<PlasticHinge> hinges;
  for (int i = 0; i < 2; ++i)
    for (int end = 0; end < 2; ++end) hinges.push_back({i, end, bent(), post_capacity[i], breaks ? turns_out : 10});
  const Yielding law(hinges);
  const int shaking = frame.add_ground_acceleration(Vec3::UnitX());
  Shaken result;
  const int count = static_cast<int>(std::lround(shaken_for / h)), each = static_cast<int>(std::lround(sampled / h));
  for (int n = 1; n <= count; ++n) {
    frame.set_pattern(shaking, ground(n * h));
    for (const JointBreak& one : frame.advance(&law))
      if (result.broke_at < 0) result.broke_at = one.time;
    if (n % each == 0) result.displacement.push_back({frame.displacements()[1](0), frame.displacements()[2](0)});
    if (result.broke_at >= 0) break;
  }
  for (int i = 0; i < 2; ++i) result.drift[static_cast<std::size_t>(i)] = height * frame.plastic_rotations(i)(bent());
  return result;
}

/// The fourth-order method of Runge and Kutta with steps of a microsecond; rates of elastic, perfectly plastic storeys.
Shaken by_itself(bool breaks) {
  const double k = storey_spring(), h = 2e-6;
  using State = std::array<double, 6>;  // displacements, velocities, what the storeys bear
  const auto rates = [&](double t, const State& y) {
    State dy{};
    for (std::size_t i = 0; i < 2; ++i) {
      const double limit = 2 * post_capacity[i] / height;
      const double closing = y[2 + i] - (i > 0 ? y[1 + i] : 0);
      const bool yields = std::abs(y[4 + i]) >= limit && y[4 + i] * closing > 0;
      dy[i] = y[2 + i];
      dy[4 + i] = yields ? 0 : k * closing;
      dy[2 + i] = -ground(t) + (-y[4 + i] + (i == 0 ? y[5] : 0)) / floor_mass[i];
    }
    return dy;
  };
  const auto moved = [](State y, double by, const State& dy) {
    for (std::size_t i = 0; i < 6; ++i) y[i] += by * dy[i];
    return y;
  };
  State y{};
  Shaken result;
  double t = 0, next = sampled;
  for (; t < shaken_for - h / 2; t += h) {
    const State a = rates(t, y), b = rates(t + h / 2, moved(y, h / 2, a)), c = rates(t + h / 2, moved(y, h / 2, b)),
                d = rates(t + h, moved(y, h, c));
    for (std::size_t i = 0; i < 6; ++i) y[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
    for (std::size_t i = 0; i < 2; ++i) {
      const double limit = 2 * post_capacity[i] / height;
      y[4 + i] = std::clamp(y[4 + i], -limit, limit);
      result.drift[i] = y[i] - (i > 0 ? y[0] : 0) - y[4 + i] / k;
      if (breaks && result.broke_at < 0 && std::abs(result.drift[i]) > turns_out * height) result.broke_at = t + h;
    }
    if (t + h > next - h / 2) {
      result.displacement.push_back({y[0], y[1]});
      next += sampled;
    }
    if (result.broke_at >= 0) break;
  }
  return result;
}

double largest_difference(const Shaken& a, const Shaken& b) {
  double worst = 0;
  for (std::size_t n = 0; n < std::min(a.displacement.size(), b.displacement.size()); ++n)
    for (std::size_t i = 0; i < 2; ++i) worst = std::max(worst, std::abs(a.displacement[n][i] - b.displacement[n][i]));
  return worst;
}

}  // namespace

TEST_CASE(
    "A shaken shear frame that yields to and fro follows an integration of its own, with second order or near it") {
  const Shaken truth = by_itself(false);
  double largest = 0;
  for (const auto& at : truth.displacement) largest = std::max(largest, std::abs(at[1]));
  REQUIRE(std::abs(truth.drift[0]) > 0.005);  // both yield
  REQUIRE(std::abs(truth.drift[1]) > 0.001);
  const double coarse = largest_difference(by_the_frame(1.0 / 500, false), truth),
               fine = largest_difference(by_the_frame(1.0 / 1000, false), truth),
               finer = largest_difference(by_the_frame(1.0 / 2000, false), truth);
  INFO("differences " << coarse << ", " << fine << ", " << finer << " of " << largest);
  CHECK(finer < 2e-3 * largest);
  CHECK(finer < 0.6 * coarse);
  CHECK(std::abs(by_the_frame(1.0 / 2000, false).drift[0] - truth.drift[0]) < 5e-3 * std::abs(truth.drift[0]));
}

TEST_CASE("A hinge that has turned too far breaks within a substep of an integration of its own") {
  const Shaken truth = by_itself(true);
  REQUIRE(truth.broke_at > 0);
  for (const double h : {1.0 / 500, 1.0 / 1000, 1.0 / 2000}) {
    const Shaken found = by_the_frame(h, true);
    INFO("substep " << h << ": " << found.broke_at << ", " << truth.broke_at);
    CHECK(std::abs(found.broke_at - truth.broke_at) < h);
  }
}
