#pragma once
// Timing for the benchmarks: contestants take turns, so that whatever else the machine does meanwhile hits all of them,
// and the median of each is compared.
#include <algorithm>
#include <chrono>
#include <ctime>
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

/// Of repeated runs: median and quartiles.
struct Spread {
  double median = 0, low = 0, high = 0;
  std::size_t runs = 0;
};

inline Spread spread_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  return {at(0.5), at(0.25), at(0.75), values.size()};
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

/// What one contestant took: medians in seconds.
struct Spending {
  double wall = 0;
  double processor = 0;  ///< of all threads of this program together
};

/// Like interleaved_medians(), with the processor time beside the wall time: on a busy machine it tells more.
inline std::vector<Spending> interleaved_spending(int rounds,
                                                  std::initializer_list<std::function<void()>> contestants) {
  std::vector<std::vector<double>> wall(contestants.size()), processor(contestants.size());
  for (int round = 0; round <= rounds; ++round) {
    std::size_t i = 0;
    for (const auto& work : contestants) {
      const std::clock_t before = std::clock();
      const double t = seconds(work);
      if (round > 0) {
        wall[i].push_back(t);
        processor[i].push_back(static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC);
      }
      ++i;
    }
  }
  std::vector<Spending> result;
  for (std::size_t i = 0; i < wall.size(); ++i) result.push_back({median(wall[i]), median(processor[i])});
  return result;
}

}  // namespace topple::bench
