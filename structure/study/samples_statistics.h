#pragma once
// Statistics of plain lists of numbers.
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "topple/structure/study/study_statistics.h"

namespace topple::structure::study {

struct Moments {
  double mean = 0, sd = 0;  ///< of the sample, n - 1
};
[[nodiscard]] Moments moments(std::span<const double> values);
/// Student's t that is exceeded with a probability of 2.5 %, by expansion about the normal distribution (Abramowitz and
/// Stegun 26.7.5); for 4 degrees of freedom and more.
[[nodiscard]] double student_t(double freedoms);
[[nodiscard]] StudyQuantile quantile(std::span<const double> sorted, double share);
/// Middle ranks of equal ones.
[[nodiscard]] std::vector<double> ranks(std::span<const double> values);
/// Of products and moments; 0 where one of them does not vary.
[[nodiscard]] double correlation(std::span<const double> x, std::span<const double> y);
/// Share of the variance of y between classes of x of equal counts, freed of its bias.
[[nodiscard]] double correlation_ratio(std::span<const double> x, std::span<const double> y);
/// Standard deviation of `statistic` over samples drawn anew with replacement; it is handed indices below `count`.
[[nodiscard]] double bootstrap_error(std::size_t count, std::uint64_t seed,
                                     const std::function<double(const std::vector<std::size_t>&)>& statistic);

}  // namespace topple::structure::study
