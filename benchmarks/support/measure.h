#pragma once
// Timing for the benchmarks: contestants take turns, so that whatever else the machine does meanwhile hits all of them,
// and the median of each is compared.
#include <algorithm>
#include <chrono>
#include <functional>
#include <span>
#include <vector>

namespace topple::bench {

/// Wall time of one call in seconds.
inline double seconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Median wall time of each contestant over `rounds` rounds in which all run once, after one round that does not count.
inline std::vector<double> interleaved_medians(int rounds, std::span<const std::function<void()>> contestants) {
  std::vector<std::vector<double>> times(contestants.size());
  for (int round = 0; round <= rounds; ++round) {
    for (std::size_t i = 0; i < contestants.size(); ++i) {
      const double t = seconds(contestants[i]);
      if (round > 0) times[i].push_back(t);
    }
  }
  std::vector<double> result;
  for (auto& t : times) result.push_back(median(std::move(t)));
  return result;
}
inline std::vector<double> interleaved_medians(int rounds, std::initializer_list<std::function<void()>> contestants) {
  return interleaved_medians(rounds, std::span(contestants.begin(), contestants.size()));
}

}  // namespace topple::bench
