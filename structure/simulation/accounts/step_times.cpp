#include <algorithm>
#include <cmath>
#include <numeric>

#include "topple/structure/collapse_report.h"

namespace topple::structure {

namespace {

/// Nearest-rank percentile of sorted values.
double rank(const std::vector<double>& sorted, double share) {
  const auto n = static_cast<double>(sorted.size());
  const auto index = static_cast<std::size_t>(std::max(0.0, std::ceil(share * n) - 1));
  return sorted[std::min(index, sorted.size() - 1)];
}

StepTimes::Percentiles percentiles(std::vector<double> milliseconds) {
  if (milliseconds.empty()) return {};
  std::sort(milliseconds.begin(), milliseconds.end());
  const double sum = std::accumulate(milliseconds.begin(), milliseconds.end(), 0.0);
  return {sum / static_cast<double>(milliseconds.size()), rank(milliseconds, 0.50), rank(milliseconds, 0.95),
          rank(milliseconds, 0.99), milliseconds.back()};
}

}  // namespace

void StepTimes::add(const Simulation& simulation) {
  const std::array<double, 6>& seconds = simulation.stage_seconds();
  const double sum = 1e3 * std::accumulate(seconds.begin(), seconds.end(), 0.0);
  if (sum == 0) return;  // an idle step runs no stage
  for (std::size_t i = 0; i < seconds.size(); ++i) stages_[i] += 1e3 * seconds[i];
  const double engine = 1e3 * simulation.collision_engine_seconds();
  engine_ += engine;
  whole_.push_back(sum);
  own_.push_back(sum - engine);
}

StepTimes::Percentiles StepTimes::whole() const { return percentiles(whole_); }
StepTimes::Percentiles StepTimes::without_collision_engine() const { return percentiles(own_); }

std::array<double, 6> StepTimes::mean_by_stage() const {
  std::array<double, 6> mean{};
  if (whole_.empty()) return mean;
  for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = stages_[i] / static_cast<double>(whole_.size());
  return mean;
}

double StepTimes::mean_collision_engine() const {
  return whole_.empty() ? 0 : engine_ / static_cast<double>(whole_.size());
}

}  // namespace topple::structure
