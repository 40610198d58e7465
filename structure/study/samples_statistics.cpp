#include "study/samples_statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "study/counter_random.h"

namespace topple::structure {

namespace study {

namespace {

constexpr double normal_95 = 1.959963984540054;

}  // namespace

Moments moments(std::span<const double> values) {
  Moments result;
  const auto n = static_cast<double>(values.size());
  if (values.empty()) return result;
  // What is the same in all samples hangs on nothing, and must not seem to by rounding.
  if (std::all_of(values.begin(), values.end(), [&](double value) { return value == values.front(); }))
    return {values.front(), 0};
  for (const double value : values) result.mean += value / n;
  double squares = 0;
  for (const double value : values) squares += (value - result.mean) * (value - result.mean);
  result.sd = values.size() > 1 ? std::sqrt(squares / (n - 1)) : 0;
  return result;
}

double student_t(double freedoms) {
  const double z = normal_95, z2 = z * z, v = freedoms;
  const double first = (z2 + 1) / 4, second = ((5 * z2 + 16) * z2 + 3) / 96;
  const double third = (((3 * z2 + 19) * z2 + 17) * z2 - 15) / 384;
  const double fourth = ((((79 * z2 + 776) * z2 + 1482) * z2 - 1920) * z2 - 945) / 92160;
  return z * (1 + (first + (second + (third + fourth / v) / v) / v) / v);
}

StudyQuantile quantile(std::span<const double> sorted, double share) {
  const auto n = static_cast<double>(sorted.size());
  const double at = (n - 1) * share;
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  StudyQuantile result{share, sorted[below] + (at - std::floor(at)) * (sorted[above] - sorted[below]), {}};
  // So many samples lie below the quantile, by the normal approximation of the binomial distribution.
  const double half = normal_95 * std::sqrt(n * share * (1 - share));
  const double low = std::floor(n * share - half), high = std::ceil(n * share + half) + 1;
  if (low >= 1 && high <= n)
    result.interval = Interval{sorted[static_cast<std::size_t>(low) - 1], sorted[static_cast<std::size_t>(high) - 1]};
  return result;
}

std::vector<double> ranks(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> result(values.size());
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i + 1;
    while (end < order.size() && values[order[end]] == values[order[i]]) ++end;
    for (std::size_t k = i; k < end; ++k) result[order[k]] = 0.5 * static_cast<double>(i + end - 1);
    i = end;
  }
  return result;
}

double correlation(std::span<const double> x, std::span<const double> y) {
  const double mean_x = moments(x).mean, mean_y = moments(y).mean;
  double xx = 0, yy = 0, xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    yy += (y[i] - mean_y) * (y[i] - mean_y);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  return xx > 0 && yy > 0 ? xy / std::sqrt(xx * yy) : 0;
}

double correlation_ratio(std::span<const double> x, std::span<const double> y) {
  const std::size_t n = x.size();
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return x[a] < x[b]; });
  const auto most = std::max<std::size_t>(2, std::min<std::size_t>(30, static_cast<std::size_t>(std::sqrt(n))));
  const std::size_t least = (n + most - 1) / most;
  const double mean = moments(y).mean;
  double total = 0, within = 0, classes = 0;
  for (std::size_t i = 0; i < n;) {
    std::size_t end = std::min(i + least, n);
    while (end < n && x[order[end]] == x[order[end - 1]]) ++end;  // equal inputs stay together
    double class_mean = 0;
    for (std::size_t k = i; k < end; ++k) class_mean += y[order[k]] / static_cast<double>(end - i);
    for (std::size_t k = i; k < end; ++k) {
      within += (y[order[k]] - class_mean) * (y[order[k]] - class_mean);
      total += (y[order[k]] - mean) * (y[order[k]] - mean);
    }
    ++classes;
    i = end;
  }
  const auto count = static_cast<double>(n);
  if (!(total > 0) || count <= classes) return 0;
  return 1 - (within / (count - classes)) / (total / (count - 1));
}

double bootstrap_error(std::size_t count, std::uint64_t seed,
                       const std::function<double(const std::vector<std::size_t>&)>& statistic) {
  constexpr std::uint64_t resamples = 100;  // the error itself is then known to 7 %
  std::vector<double> values;
  std::vector<std::size_t> chosen(count);
  for (std::uint64_t r = 0; r < resamples; ++r) {
    for (std::size_t i = 0; i < count; ++i)
      chosen[i] = random_bits(seed, Drawn::bootstrap, i, static_cast<std::uint32_t>(r)) % count;
    values.push_back(statistic(chosen));
  }
  return moments(values).sd;
}

}  // namespace study

Interval Proportion::wilson() const {
  if (of == 0) return {0, 1};
  const auto n = static_cast<double>(of);
  const double z = study::normal_95, z2 = z * z, p = share();
  const double middle = (p + z2 / (2 * n)) / (1 + z2 / n);
  const double half = z / (1 + z2 / n) * std::sqrt(p * (1 - p) / n + z2 / (4 * n * n));
  return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

}  // namespace topple::structure
