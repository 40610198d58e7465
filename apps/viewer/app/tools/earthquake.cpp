#include "app/tools/earthquake.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "topple/structure/error.h"

namespace topple::viewer {
namespace {

using structure::TimeHistory;

constexpr double pi = std::numbers::pi;
constexpr double interval = 0.01;  // s, between the times of a computed motion

/// Kanai and Tajimi's spectrum, by the circular frequency; its scale means nothing here.
double kanai_tajimi(double frequency) {
  constexpr double ground = 5 * pi, damping = 0.6;
  const double r2 = (frequency / ground) * (frequency / ground), d2 = 4 * damping * damping * r2;
  return (1 + d2) / ((1 - r2) * (1 - r2) + d2);
}

double envelope(double share) {
  constexpr double swells = 0.1, dies = 0.5;
  if (share < swells) return share / swells;
  return share < dies ? 1.0 : std::max(0.0, (1 - share) / (1 - dies));
}

std::vector<double> process(const std::vector<double>& times, double duration, std::mt19937_64& chance) {
  constexpr int waves = 80;
  constexpr double lowest = 0.4 * pi, highest = 30 * pi;  // rad/s: 0.2 to 15 Hz
  const double step = (highest - lowest) / waves;
  std::array<double, waves> phase{};
  for (double& one : phase)  // mt19937_64's numbers are the same everywhere; a distribution's need not be
    one = 2 * pi * static_cast<double>(chance() >> 11U) / static_cast<double>(std::uint64_t{1} << 53U);
  std::vector<double> values;
  for (const double t : times) {
    double sum = 0;
    for (int k = 0; k < waves; ++k) {
      const double w = lowest + (k + 0.5) * step;
      sum += std::sqrt(2 * kanai_tajimi(w) * step) * std::cos(w * t + phase[static_cast<std::size_t>(k)]);
    }
    values.push_back(envelope(t / duration) * sum);
  }
  return values;
}

}  // namespace

structure::Vec3 ground_acceleration(const TimeHistory& ground, double time) {
  structure::Vec3 sum = structure::Vec3::Zero();
  if (ground.times.empty() || time < ground.times.front() || time > ground.times.back()) return sum;
  const auto after = std::upper_bound(ground.times.begin(), ground.times.end(), time);
  const auto next = std::min(static_cast<std::size_t>(after - ground.times.begin()), ground.times.size() - 1);
  const std::size_t last = next == 0 ? 0 : next - 1;
  const double length = ground.times[next] - ground.times[last];
  const double share = length > 0 ? (time - ground.times[last]) / length : 0;
  for (const TimeHistory::Series& one : ground.series)
    if (one.axis >= 0) sum[one.axis] += one.values[last] + share * (one.values[next] - one.values[last]);
  return sum;
}

void require_ground(const TimeHistory& ground) {
  for (const TimeHistory::Series& one : ground.series)
    if (one.axis < 0)
      throw structure::InputError(ground.file + ": a column is a load case; accepted for an earthquake: ax, ay, az");
}

TimeHistory strong_motion(double peak, double duration, std::uint64_t seed) {
  TimeHistory ground;
  ground.file = "computed";
  const auto count = static_cast<int>(std::ceil(duration / interval));
  for (int i = 0; i <= count; ++i) ground.times.push_back(i * duration / count);
  std::mt19937_64 chance(seed);
  double largest = 0;
  for (int axis = 0; axis < 2; ++axis) {
    TimeHistory::Series one;
    one.axis = axis;
    one.values = process(ground.times, duration, chance);
    for (const double a : one.values) largest = std::max(largest, std::abs(a));
    ground.series.push_back(std::move(one));
  }
  for (TimeHistory::Series& one : ground.series)
    for (double& a : one.values) a *= peak / largest;
  return ground;
}

}  // namespace topple::viewer
