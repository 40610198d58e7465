// Joints that break one after the other, against an integration of the same row of masses that shares no code: Dormand
// and Prince's fifth order with steps that it chooses itself, each break found on its solution.
#include <array>
#include <catch2/catch.hpp>
#include <functional>

#include "frames.h"
#include "topple/solver/frame_dynamics.h"

using namespace topple::test;

namespace {

constexpr int count = 20;

/// Masses in a row that move along z, each on a hanger; neighbours shear the link between them.
struct Row {
  double mass = 400, hanger = 6e6, link = 2e6, weight = 4000;
  double capacity = 7000;  ///< of a hanger
  double pull = 0;         ///< on the first mass, growing by this each second
  bool first_hanger = true;
};

FrameModel frame_of(const Row& row) {
  FrameModel model;
  for (int i = 0; i < count; ++i) model.nodes.emplace_back(i, 0, 0);
  for (int i = 0; i < count; ++i) {
    model.nodes.emplace_back(i, 0, 2);
    model.supports.push_back({i, components(rigid, rigid, 0, rigid, rigid, rigid)});
    model.supports.push_back({count + i, fixed()});
    add_beam(model, i, count + i);
    model.beams.back().area = row.hanger * 2 / model.beams.back().youngs_modulus;
  }
  for (int i = 0; i + 1 < count; ++i) {
    add_beam(model, i, i + 1);
    Beam& link = model.beams.back();
    link.shear_area_y = link.shear_area_z = 0;
    link.Iy = link.Iz = row.link / (12 * link.youngs_modulus);
  }
  return model;
}

struct Break {
  int hanger = -1;
  double time = 0;
};

class TensionLimit : public JointLaw {
 public:
  explicit TensionLimit(double capacity) : capacity_(capacity) {}
  [[nodiscard]] double beam_utilisation(int beam, const Vec12& forces) const override {
    return end_utilisation(beam, 0, forces);
  }
  [[nodiscard]] double end_utilisation(int beam, int end, const Vec12& forces) const override {
    return beam < count && end == 0 ? -forces(0) / capacity_ : 0;
  }

 private:
  double capacity_;
};

std::vector<Break> by_the_frame(const Row& row, double h, double until, double spectral_radius) {
  DynamicOptions options;
  options.substep = h;
  options.spectral_radius = spectral_radius;
  MassModel masses;
  for (int i = 0; i < count; ++i) masses.nodes.push_back({i, row.mass, Vec3::Zero()});
  FrameDynamics frame(frame_of(row), masses, options);
  for (int i = 0; i < count; ++i) frame.set_node_load(i, unit(2, -row.weight));
  std::vector<Vec6> rest(2 * count, Vec6::Zero());
  for (int i = 0; i < count; ++i) rest[static_cast<std::size_t>(i)](2) = -row.weight / row.hanger;
  frame.set_state(rest, std::vector<Vec6>(2 * count, Vec6::Zero()));
  if (!row.first_hanger) frame.set_end_stiffness(0, 0, Vec6::Zero());
  LoadSet pull;
  pull.nodes = {{0, unit(2, -row.pull)}};
  const int growing = frame.add_pattern(pull);
  const TensionLimit law(row.capacity);
  std::vector<Break> breaks;
  while (frame.time() < until) {
    frame.set_pattern(growing, frame.time() + h);
    for (const JointBreak& one : frame.advance(&law)) breaks.push_back({one.beam, one.time});
  }
  return breaks;
}

/// y = positions, then velocities.
using Motion = std::array<double, 2 * count>;

Motion rates(const Row& row, const std::array<bool, count>& hangs, double t, const Motion& y) {
  Motion dy{};
  for (std::size_t i = 0; i < count; ++i) {
    double force = -row.weight - (hangs[i] ? row.hanger * y[i] : 0);
    if (i == 0) force -= row.pull * t;
    if (i > 0) force += row.link * (y[i - 1] - y[i]);
    if (i + 1 < count) force += row.link * (y[i + 1] - y[i]);
    dy[i] = y[count + i];
    dy[count + i] = force / row.mass;
  }
  return dy;
}

/// One step of Dormand and Prince's method (1980); the difference of its two orders in `error`.
Motion dormand_prince(const Row& row, const std::array<bool, count>& hangs, double t, const Motion& y, double h,
                      double& error) {
  static constexpr double c[7] = {0, 1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1, 1};
  static constexpr double a[7][6] = {{},
                                     {1.0 / 5},
                                     {3.0 / 40, 9.0 / 40},
                                     {44.0 / 45, -56.0 / 15, 32.0 / 9},
                                     {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
                                     {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
                                     {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
  static constexpr double low[7] = {5179.0 / 57600, 0,       7571.0 / 16695, 393.0 / 640, -92097.0 / 339200,
                                    187.0 / 2100,   1.0 / 40};
  std::array<Motion, 7> k;
  Motion next = y;
  for (std::size_t s = 0; s < 7; ++s) {
    next = y;
    for (std::size_t j = 0; j < s; ++j)
      for (std::size_t i = 0; i < next.size(); ++i) next[i] += h * a[s][j] * k[j][i];
    k[s] = rates(row, hangs, t + c[s] * h, next);
  }
  error = 0;
  for (std::size_t i = 0; i < next.size(); ++i) {
    double other = y[i];
    for (std::size_t s = 0; s < 7; ++s) other += h * low[s] * k[s][i];
    error = std::max(error, std::abs(next[i] - other) / (i < count ? 1e-3 : 1e-1));
  }
  return next;
}

std::vector<Break> by_itself(const Row& row, double until) {
  Motion y{};
  for (std::size_t i = 0; i < count; ++i) y[i] = -row.weight / row.hanger;
  std::array<bool, count> hangs;
  hangs.fill(true);
  hangs[0] = row.first_hanger;
  std::vector<Break> breaks;
  double t = 0, h = 1e-5;
  while (t < until) {
    double error = 0;
    const Motion next = dormand_prince(row, hangs, t, y, h, error);
    if (error > 1e-10) {
      h *= 0.5;
      continue;
    }
    int first = -1;
    for (std::size_t i = 0; i < count; ++i)
      if (hangs[i] && -row.hanger * next[i] > row.capacity &&
          (first < 0 || next[i] < next[static_cast<std::size_t>(first)]))
        first = static_cast<int>(i);
    if (first >= 0 && h > 1e-9) {  // narrowed down before it is passed
      h *= 0.5;
      continue;
    }
    t += h;
    y = next;
    if (first >= 0) {
      hangs[static_cast<std::size_t>(first)] = false;
      breaks.push_back({first, t});
    }
    h = std::min(h * 1.5, 1e-4);
  }
  return breaks;
}

void compare(const Row& row, double until, int expected) {
  const std::vector<Break> exact = by_itself(row, until);
  REQUIRE(std::ssize(exact) >= expected);
  double before = 0;
  for (const double h : {1.0 / 960, 1.0 / 1920, 1.0 / 3840}) {
    const std::vector<Break> found = by_the_frame(row, h, exact.back().time + 2 * h, 0.8);
    REQUIRE(found.size() >= exact.size());
    double worst = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
      INFO("break " << i << " at " << exact[i].time << ", found " << found[i].hanger << " at " << found[i].time);
      CHECK(found[i].hanger == exact[i].hanger);
      CHECK(std::abs(found[i].time - exact[i].time) < h);
      worst = std::max(worst, std::abs(found[i].time - exact[i].time));
    }
    INFO("substep " << h << ": worst time off by " << worst << " s");
    if (before > 0) CHECK(worst < 0.65 * before);  // first order or better
    before = worst;
  }
}

}  // namespace

TEST_CASE("A row of hangers fails one after the other, in order and time as an independent integration has it") {
  Row row;
  row.first_hanger = false;
  row.capacity = 6000;
  compare(row, 1.0, count - 1);
}

TEST_CASE("A zipper of bolts that is pulled open breaks bolt by bolt, as an independent integration has it") {
  Row row;
  row.weight = 0;
  row.link = 2e7;
  row.pull = 4e5;
  row.capacity = 7000;
  compare(row, 0.4, 8);
}
