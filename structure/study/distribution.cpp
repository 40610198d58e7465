#include <algorithm>
#include <cmath>
#include <numeric>

#include "study/normal_distribution.h"
#include "topple/structure/study/study.h"

namespace topple::structure {

namespace {

/// What is left of a standard normal variable between z = a and b; drawn in the tail where the numbers are fine.
double cut_normal(double u, double a, double b) {
  if (a > 0) return -cut_normal(1 - u, -b, -a);
  const double low = study::normal_share(a), high = study::normal_share(b);
  return std::clamp(study::normal_quantile(low + u * (high - low)), a, b);
}

/// The share of a list at which a value ends, of values with weights.
const StudyValue& chosen(const Distribution& d, double u) {
  const double all = d.weights.empty() ? static_cast<double>(d.values.size())
                                       : std::accumulate(d.weights.begin(), d.weights.end(), 0.0);
  double below = 0;
  for (std::size_t i = 0; i < d.values.size(); ++i) {
    below += d.weights.empty() ? 1 : d.weights[i];
    if (u * all < below) return d.values[i];
  }
  return d.values.back();
}

}  // namespace

StudyValue Distribution::quantile(double u) const {
  StudyValue value;
  switch (kind) {
    case Kind::uniform:
      value.number = low + u * (high - low);
      return value;
    case Kind::normal:
      value.number = std::clamp(mean + sd * cut_normal(u, (low - mean) / sd, (high - mean) / sd), low, high);
      return value;
    case Kind::lognormal: {
      const double of_logarithm = std::sqrt(std::log1p((sd / mean) * (sd / mean)));
      const double middle = std::log(mean) - 0.5 * of_logarithm * of_logarithm;
      const auto standard = [&](double bound) {
        return bound <= 0 ? -std::numeric_limits<double>::infinity() : (std::log(bound) - middle) / of_logarithm;
      };
      value.number = std::clamp(std::exp(middle + of_logarithm * cut_normal(u, standard(low), standard(high))),
                                std::max(low, 0.0), high);
      return value;
    }
    case Kind::choice:
    case Kind::grid:
      break;
  }
  return chosen(*this, u);
}

}  // namespace topple::structure
