// Distributions of outputs, probability of collapse, and what both hang on.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "study/fragility_fit.h"
#include "study/samples_statistics.h"

namespace topple::structure {

using study::moments;

namespace {

/// Numbers of one output with the samples that have one.
struct Column {
  std::vector<double> values;
  std::vector<const Sample*> of;
};

Column column_of(std::span<const Sample> samples, const std::function<std::optional<double>(const Sample&)>& value) {
  Column column;
  for (const Sample& sample : samples) {
    if (!sample.failed.empty()) continue;
    const auto number = value(sample);
    if (!number || !std::isfinite(*number)) continue;
    column.values.push_back(*number);
    column.of.push_back(&sample);
  }
  return column;
}

std::optional<Interval> mean_interval(double mean, double sd, std::size_t count) {
  constexpr std::size_t least = 5;  // below, the expansion of Student's t does not hold
  if (count < least) return std::nullopt;
  const auto n = static_cast<double>(count);
  const double half = study::student_t(n - 1) * sd / std::sqrt(n);
  return Interval{mean - half, mean + half};
}

std::vector<std::array<double, 3>> convergence_of(const std::vector<double>& values) {
  constexpr std::size_t points = 100;
  std::vector<std::array<double, 3>> result;
  const std::size_t every = std::max<std::size_t>(1, values.size() / points);
  double mean = 0, squares = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    // B. P. Welford, Technometrics 4, 1962.
    const double n = static_cast<double>(i + 1), away = values[i] - mean;
    mean += away / n;
    squares += away * (values[i] - mean);
    if ((i + 1) % every != 0 && i + 1 != values.size()) continue;
    const auto interval = mean_interval(mean, i > 0 ? std::sqrt(squares / (n - 1)) : 0, i + 1);
    if (interval) result.push_back({n, mean, (*interval)[1] - mean});
  }
  return result;
}

OutputStatistics statistics_of(const std::string& name, const Column& column, std::size_t samples) {
  OutputStatistics result;
  result.name = name;
  result.count = column.values.size();
  result.missing = samples - result.count;
  if (column.values.empty()) return result;
  const study::Moments of = moments(column.values);
  result.mean = of.mean;
  result.sd = of.sd;
  result.mean_interval = mean_interval(of.mean, of.sd, result.count);
  std::vector<double> sorted = column.values;
  std::sort(sorted.begin(), sorted.end());
  result.least = sorted.front();
  result.largest = sorted.back();
  for (const double share : {0.05, 0.25, 0.5, 0.75, 0.95}) result.quantiles.push_back(study::quantile(sorted, share));
  result.convergence = convergence_of(column.values);
  return result;
}

/// Rank correlations and first-order indices from any samples.
OutputInfluences influences_of(const StudyTask& task, const std::string& name, const Column& column,
                               std::uint64_t seed) {
  OutputInfluences result{name, {}};
  const std::vector<double>& y = column.values;
  constexpr std::size_t least = 10, least_for_classes = 50;
  if (y.size() < least || moments(y).sd == 0) return result;
  const std::vector<double> ranks_y = study::ranks(y);
  for (std::size_t v = 0; v < task.sampler.variables().size(); ++v) {
    std::vector<double> x;
    for (const Sample* sample : column.of) x.push_back(input_number(task.sampler.variables()[v], sample->inputs[v]));
    if (moments(x).sd == 0) continue;
    InputInfluence influence;
    influence.input = task.sampler.variables()[v].name;
    influence.rank_correlation = study::correlation(study::ranks(x), ranks_y);
    const double z = std::atanh(std::clamp(influence.rank_correlation, -1 + 1e-15, 1 - 1e-15));
    const double half = 1.959963984540054 * std::sqrt(1.06 / (static_cast<double>(y.size()) - 3));
    influence.interval = Interval{std::tanh(z - half), std::tanh(z + half)};
    if (y.size() >= least_for_classes && task.sampler.sampling() != Sampling::saltelli) {
      const double error = study::bootstrap_error(y.size(), seed, [&](const std::vector<std::size_t>& chosen) {
        std::vector<double> cx, cy;
        for (const std::size_t i : chosen) {
          cx.push_back(x[i]);
          cy.push_back(y[i]);
        }
        return study::correlation_ratio(cx, cy);
      });
      influence.first_order = {study::correlation_ratio(x, y), error};
    }
    result.inputs.push_back(std::move(influence));
  }
  return result;
}

/// Values of whole blocks of a "saltelli" design: A, B, then A with one coordinate of B each.
struct Blocks {
  std::size_t width = 0;
  std::vector<double> values;
  [[nodiscard]] std::size_t count() const { return width > 0 ? values.size() / width : 0; }
};

Blocks blocks_of(std::size_t variables, const Column& column) {
  Blocks blocks{variables + 2, {}};
  for (std::size_t i = 0; i + blocks.width <= column.of.size();) {
    const std::uint64_t first = column.of[i]->number;
    if (first % blocks.width == 0 && column.of[i + blocks.width - 1]->number == first + blocks.width - 1) {
      for (std::size_t k = 0; k < blocks.width; ++k) blocks.values.push_back(column.values[i + k]);
      i += blocks.width;
    } else {
      ++i;
    }
  }
  return blocks;
}

/// First and total index of variable v from the chosen blocks.
std::array<double, 2> indices_of(const Blocks& blocks, std::size_t v, const std::vector<std::size_t>& chosen) {
  double sum = 0, squares = 0;
  for (const std::size_t i : chosen) {
    const double a = blocks.values[i * blocks.width], b = blocks.values[i * blocks.width + 1];
    sum += a + b;
    squares += a * a + b * b;
  }
  const auto n = static_cast<double>(chosen.size());
  const double mean = sum / (2 * n), variance = squares / (2 * n) - mean * mean;
  if (!(variance > 0)) return {0, 0};
  double first = 0, total = 0;
  for (const std::size_t i : chosen) {
    const double* f = &blocks.values[i * blocks.width];
    first += (f[1] - mean) * (f[v + 2] - f[0]);
    total += 0.5 * (f[0] - f[v + 2]) * (f[0] - f[v + 2]);
  }
  return {first / n / variance, total / n / variance};
}

void add_sobol_indices(const StudyTask& task, const Column& column, std::uint64_t seed, OutputInfluences& influences) {
  const Blocks blocks = blocks_of(task.sampler.variables().size(), column);
  constexpr std::size_t least = 8;
  if (blocks.count() < least) return;
  std::vector<std::size_t> all(blocks.count());
  std::iota(all.begin(), all.end(), 0);
  for (InputInfluence& influence : influences.inputs) {
    std::size_t v = 0;
    while (task.sampler.variables()[v].name != influence.input) ++v;
    const auto value = indices_of(blocks, v, all);
    const auto error = [&](std::size_t which) {
      return study::bootstrap_error(blocks.count(), seed,
                                    [&](const auto& c) { return indices_of(blocks, v, c)[which]; });
    };
    influence.first_order = {value[0], error(0)};
    influence.total = {value[1], error(1)};
  }
}

void add_parts(PartShares& shares, std::span<const Sample> samples, const Building& building) {
  const std::size_t members = building.members.size(), panels = building.panels.size();
  std::vector<double> counts(members + panels + building.joints.size());
  for (const Sample& sample : samples) {
    if (!sample.failed.empty()) continue;
    if (sample.parts.size() > (counts.size() + 3) / 4) return;  // of another building: the parts vary
    ++shares.samples;
    for (std::size_t d = 0; d < sample.parts.size(); ++d) {
      const char c = sample.parts[d];
      const int digit = c <= '9' ? c - '0' : c - 'a' + 10;
      for (std::size_t b = 0; b < 4 && 4 * d + b < counts.size(); ++b) counts[4 * d + b] += (digit >> b) & 1;
    }
  }
  if (shares.samples == 0) return;
  for (double& count : counts) count /= static_cast<double>(shares.samples);
  const auto at = [&](std::size_t i) { return counts.begin() + static_cast<std::ptrdiff_t>(i); };
  shares.members.assign(at(0), at(members));
  shares.panels.assign(at(members), at(members + panels));
  shares.joints.assign(at(members + panels), counts.end());
}

}  // namespace

double input_number(const StudyVariable& variable, const StudyValue& value) {
  if (value.is_number()) return value.number;
  const auto& values = variable.distribution.values;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (values[i].json == value.json) return static_cast<double>(i);
  return 0;
}

std::optional<bool> collapsed(const Study& study, const StudyTask& task, const Sample& sample) {
  if (!sample.failed.empty()) return std::nullopt;
  bool any = false;
  for (const OutputBounds& bounds : study.collapse_if) {
    const auto at = std::find(task.outputs.begin(), task.outputs.end(), bounds.output);
    const double value = sample.outputs[static_cast<std::size_t>(at - task.outputs.begin())];
    if (std::isnan(value)) return std::nullopt;
    any = any || bounds.holds(value);
  }
  return any;
}

StudyStatistics study_statistics(const Study& study, const StudyTask& task, std::span<const Sample> samples,
                                 const Building* building) {
  StudyStatistics result;
  result.planned = task.sampler.samples();
  result.done = samples.size();
  for (const Sample& sample : samples) result.failed += !sample.failed.empty();
  const auto add_influences = [&](const std::string& name, const Column& column) {
    OutputInfluences influences = influences_of(task, name, column, study.seed);
    if (task.sampler.sampling() == Sampling::saltelli) add_sobol_indices(task, column, study.seed, influences);
    if (!influences.inputs.empty()) result.influences.push_back(std::move(influences));
  };
  for (std::size_t i = 0; i < task.outputs.size(); ++i) {
    const Column column = column_of(samples, [&](const Sample& s) { return std::optional(s.outputs[i]); });
    result.outputs.push_back(statistics_of(task.outputs[i], column, samples.size()));
    add_influences(task.outputs[i], column);
  }
  if (!study.collapse_if.empty()) {
    const Column column = column_of(samples, [&](const Sample& sample) -> std::optional<double> {
      const auto is = collapsed(study, task, sample);
      return is ? std::optional(*is ? 1.0 : 0.0) : std::nullopt;
    });
    result.collapse.emplace();
    result.collapse->of = column.values.size();
    for (const double value : column.values) result.collapse->hits += value != 0;
    add_influences("collapse", column);
    const auto& variables = task.sampler.variables();
    for (std::size_t v = 0; v < variables.size(); ++v) {
      if (study.fragility.empty() || variables[v].name != study.fragility || column.of.empty()) continue;
      std::vector<double> x;
      std::vector<bool> hit;
      for (std::size_t i = 0; i < column.of.size(); ++i) {
        x.push_back(input_number(variables[v], column.of[i]->inputs[v]));
        hit.push_back(column.values[i] != 0);
      }
      result.fragility = study::fit_fragility(study.fragility, x, hit);
    }
  }
  if (building) add_parts(result.parts, samples, *building);
  return result;
}

}  // namespace topple::structure
