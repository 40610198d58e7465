#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "study/counter_random.h"
#include "study/normal_distribution.h"
#include "study/shuffled.h"
#include "study/sobol_sequence.h"
#include "topple/structure/study/study.h"

namespace topple::structure {

using study::Drawn;
using study::random_bits;
using study::unit_interval;

namespace {

/// Rows of the lower triangle, after each other, full rows. Throws std::invalid_argument.
std::vector<double> cholesky(std::size_t n, std::vector<double> matrix) {
  constexpr double least = 1e-12;  // of a pivot, whose whole is 1: below it the group has fewer numbers than variables
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = j; i < n; ++i) {
      double sum = matrix[i * n + j];
      for (std::size_t k = 0; k < j; ++k) sum -= matrix[i * n + k] * matrix[j * n + k];
      if (i == j && !(sum > least)) throw std::invalid_argument("the correlation is not positive definite");
      matrix[i * n + j] = i == j ? std::sqrt(sum) : sum / matrix[j * n + j];
    }
    for (std::size_t k = j + 1; k < n; ++k) matrix[j * n + k] = 0;
  }
  return matrix;
}

}  // namespace

StudySampler::StudySampler(std::vector<StudyVariable> variables, std::vector<CorrelatedGroup> groups, Sampling sampling,
                           std::uint64_t samples, std::uint64_t seed)
    : variables_(std::move(variables)), sampling_(sampling), samples_(samples), seed_(seed) {
  std::uint64_t combinations = 1;
  bool any_grid = false;
  constexpr std::uint64_t most = std::uint64_t{1} << 40;
  for (const StudyVariable& variable : variables_) {
    const bool grid = variable.distribution.kind == Distribution::Kind::grid;
    grid_stride_.push_back(grid ? combinations : 0);
    if (!grid) continue;
    any_grid = true;
    combinations *= variable.distribution.values.size();
    if (combinations > most) throw std::invalid_argument("the grids have more than 2^40 combinations");
  }
  if (samples_ == 0) {
    if (!any_grid) throw std::invalid_argument("the number of samples is missing");
    samples_ = combinations;
  }
  if (samples_ % combinations != 0)
    throw std::invalid_argument(std::to_string(samples_) + " samples for " + std::to_string(combinations) +
                                " combinations of the grids; accepted: a multiple of these");
  const std::uint64_t d = variables_.size();
  if (sampling_ == Sampling::saltelli && (any_grid || samples_ % (d + 2) != 0))
    throw std::invalid_argument("\"saltelli\" takes " + std::to_string(d + 2) +
                                " samples for each point and no grid; found " + std::to_string(samples_) + " samples");
  const std::uint64_t dimensions = sampling_ == Sampling::saltelli ? 2 * d : d;
  if ((sampling_ == Sampling::sobol || sampling_ == Sampling::saltelli) &&
      (dimensions > study::sobol_dimensions || samples_ > study::sobol_points))
    throw std::invalid_argument("a Sobol sequence has " + std::to_string(study::sobol_dimensions) +
                                " dimensions and 2^32 points; found " + std::to_string(dimensions) +
                                " dimensions; accepted there: \"random\" or \"latin\"");
  for (CorrelatedGroup& group : groups) {
    const std::size_t n = group.variables.size();
    groups_.push_back({std::move(group.variables), cholesky(n, std::move(group.correlation))});
  }
}

double StudySampler::point(std::uint64_t k, std::uint32_t dimension) const {
  const auto shift = static_cast<std::uint32_t>(random_bits(seed_, Drawn::shift, 0, dimension));
  return (static_cast<double>(study::sobol_bits(k, dimension) ^ shift) + 0.5) * 0x1p-32;
}

double StudySampler::share(std::uint64_t k, std::size_t variable) const {
  const auto v = static_cast<std::uint32_t>(variable);
  switch (sampling_) {
    case Sampling::latin: {
      const double within = unit_interval(random_bits(seed_, Drawn::sample, k, v));
      const auto part = static_cast<double>(study::shuffled(k, samples_, seed_, v));
      constexpr double below_one = 1 - 0x1p-53;
      return std::min((part + within) / static_cast<double>(samples_), below_one);
    }
    case Sampling::sobol:
      return point(k, v);
    case Sampling::saltelli: {
      // Blocks of d + 2: the point A, the point B, then A with one coordinate of B.
      const std::uint64_t d = variables_.size(), block = k % (d + 2);
      const bool of_b = block == 1 || block == variable + 2;
      return point(k / (d + 2), static_cast<std::uint32_t>(of_b ? d + variable : variable));
    }
    case Sampling::random:
      break;
  }
  return unit_interval(random_bits(seed_, Drawn::sample, k, v));
}

std::vector<StudyValue> StudySampler::values(std::uint64_t k) const {
  std::vector<double> shares(variables_.size());
  for (std::size_t v = 0; v < shares.size(); ++v)
    if (grid_stride_[v] == 0) shares[v] = share(k, v);
  for (const Group& group : groups_) {
    const std::size_t n = group.variables.size();
    std::vector<double> z(n);
    for (std::size_t i = 0; i < n; ++i) z[i] = study::normal_quantile(shares[group.variables[i]]);
    for (std::size_t i = 0; i < n; ++i) {
      double together = 0;
      for (std::size_t j = 0; j <= i; ++j) together += group.factor[i * n + j] * z[j];
      constexpr double end = 0x1p-53;
      shares[group.variables[i]] = std::clamp(study::normal_share(together), end, 1 - end);
    }
  }
  std::vector<StudyValue> values;
  for (std::size_t v = 0; v < shares.size(); ++v) {
    const Distribution& distribution = variables_[v].distribution;
    if (grid_stride_[v] == 0)
      values.push_back(distribution.quantile(shares[v]));
    else
      values.push_back(distribution.values[(k / grid_stride_[v]) % distribution.values.size()]);
  }
  return values;
}

}  // namespace topple::structure
