// The lognormal fragility curve of greatest likelihood.
#include "study/fragility_fit.h"

#include <algorithm>
#include <cmath>

#include "study/normal_distribution.h"

namespace topple::structure::study {

namespace {

/// d/dz of log of the share below z, stable far out (Mills' ratio).
double score(double z) {
  constexpr double far = -30;
  if (z < far) return -z - 1 / z;
  constexpr double root_two_pi = 2.5066282746310002;
  return std::exp(-0.5 * z * z) / root_two_pi / normal_share(z);
}

}  // namespace

std::optional<std::array<double, 2>> fit_probit(std::span<const double> x, const std::vector<bool>& hit) {
  // Fisher scoring for P = Phi(a + b x), which has one maximum at most.
  double a = 0, b = 0;
  constexpr int most = 100;
  for (int iteration = 0; iteration < most; ++iteration) {
    double ga = 0, gb = 0, aa = 0, ab = 0, bb = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double z = a + b * x[i];
      const double up = score(z), down = score(-z);
      const double slope = hit[i] ? up : -down, weight = up * down;
      ga += slope;
      gb += slope * x[i];
      aa += weight;
      ab += weight * x[i];
      bb += weight * x[i] * x[i];
    }
    const double determinant = aa * bb - ab * ab;
    if (!(determinant > 1e-12 * aa * bb)) return std::nullopt;
    double da = (bb * ga - ab * gb) / determinant, db = (aa * gb - ab * ga) / determinant;
    const double step = std::max(std::abs(da), std::abs(db));
    constexpr double longest = 5;
    if (step > longest) {
      da *= longest / step;
      db *= longest / step;
    }
    a += da;
    b += db;
    constexpr double unbounded = 1e4;  // all of one kind lie beyond all of the other: the likelihood has no maximum
    if (std::abs(a) > unbounded || std::abs(b) > unbounded) return std::nullopt;
    if (step < 1e-10 * (1 + std::abs(a) + std::abs(b))) return std::array<double, 2>{a, b};
  }
  return std::nullopt;
}

Fragility fit_fragility(std::string input, std::span<const double> x, const std::vector<bool>& hit) {
  Fragility result;
  result.input = std::move(input);
  std::vector<std::size_t> order(x.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return x[i] < x[j]; });
  const std::size_t classes = std::clamp<std::size_t>(x.size() / 10, 1, 10);
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = std::min(order.size(), i + (order.size() + classes - 1) / classes);
    while (end < order.size() && x[order[end]] == x[order[end - 1]]) ++end;
    Fragility::Class one{x[order[i]], x[order[end - 1]], {}};
    for (std::size_t k = i; k < end; ++k) one.collapsed.hits += hit[order[k]];
    one.collapsed.of = end - i;
    result.classes.push_back(one);
    i = end;
  }
  if (std::any_of(x.begin(), x.end(), [](double value) { return !(value > 0); })) return result;
  std::vector<double> logarithm;
  double middle = 0;
  for (const double value : x) middle += std::log(value) / static_cast<double>(x.size());
  for (const double value : x) logarithm.push_back(std::log(value) - middle);
  const auto fit = fit_probit(logarithm, hit);
  if (!fit || (*fit)[1] == 0) return result;
  result.falling = (*fit)[1] < 0;
  result.median = std::exp(middle - (*fit)[0] / (*fit)[1]);
  result.dispersion = 1 / std::abs((*fit)[1]);
  return result;
}

}  // namespace topple::structure::study
