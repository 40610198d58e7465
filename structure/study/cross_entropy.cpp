#include <algorithm>
#include <cmath>
#include <numeric>

#include "study/counter_random.h"
#include "study/design_search.h"
#include "study/normal_distribution.h"

namespace topple::structure::study {

namespace {

// Rubinstein and Kroese, sections 2.5 and 5.1: how far distributions move with each generation, and what keeps them
// from settling on one value before others were tried.
constexpr double moved = 0.7;
constexpr double least_probability = 0.02, least_deviation = 0.02;
constexpr double elite_share = 0.25;

/// How one variable is drawn now: probabilities of its list, or a normal variable cut to the unit interval.
struct Belief {
  std::vector<double> probability;
  double mean = 0.5, deviation = 10;  ///< so wide that it is uniform at first
};

std::vector<Belief> first_beliefs(const SearchSpace& space) {
  std::vector<Belief> beliefs;
  for (const StudyVariable& variable : space.variables) {
    Belief& belief = beliefs.emplace_back();
    if (!SearchSpace::discrete(variable)) continue;
    belief.probability = variable.distribution.weights;
    if (belief.probability.empty()) belief.probability.assign(variable.distribution.values.size(), 1);
    const double all = std::accumulate(belief.probability.begin(), belief.probability.end(), 0.0);
    for (double& p : belief.probability) p /= all;
  }
  return beliefs;
}

/// Place in the list, or in the unit interval.
double draw(const Belief& belief, double u) {
  if (belief.probability.empty()) {
    const double low = normal_share(-belief.mean / belief.deviation);
    const double high = normal_share((1 - belief.mean) / belief.deviation);
    return std::clamp(belief.mean + belief.deviation * normal_quantile(low + u * (high - low)), 0.0, 1.0);
  }
  double below = 0;
  for (std::size_t i = 0; i < belief.probability.size(); ++i) {
    below += belief.probability[i];
    if (u < below) return static_cast<double>(i);
  }
  return static_cast<double>(belief.probability.size() - 1);
}

StudyValue value_of(const StudyVariable& variable, double place) {
  if (SearchSpace::discrete(variable)) return variable.distribution.values[static_cast<std::size_t>(place)];
  constexpr double end = 1e-9;  // normal variables have no last value
  const bool bounded = variable.distribution.kind == Distribution::Kind::uniform;
  return variable.distribution.quantile(bounded ? place : std::clamp(place, end, 1 - end));
}

void learn(Belief& belief, const std::vector<double>& places) {
  const auto n = static_cast<double>(places.size());
  if (!belief.probability.empty()) {
    double all = 0;
    for (std::size_t i = 0; i < belief.probability.size(); ++i) {
      const auto seen = static_cast<double>(std::count(places.begin(), places.end(), static_cast<double>(i)));
      double& p = belief.probability[i];
      p = std::max(least_probability, moved * seen / n + (1 - moved) * p);
      all += p;
    }
    for (double& p : belief.probability) p /= all;
    return;
  }
  double mean = 0, squares = 0;
  for (const double place : places) mean += place / n;
  for (const double place : places) squares += (place - mean) * (place - mean) / n;
  constexpr double uniform_deviation = 0.28867513459481287;  // of the unit interval
  belief.mean = moved * mean + (1 - moved) * belief.mean;
  belief.deviation = std::max(least_deviation,
                              moved * std::sqrt(squares) + (1 - moved) * std::min(belief.deviation, uniform_deviation));
}

/// Generations of about the square root of all runs: as many of them as there are designs in each.
int generation_size(int runs) { return std::clamp(static_cast<int>(std::lround(1.2 * std::sqrt(runs))), 4, 200); }

struct Tried {
  StudyDesign design;
  std::vector<double> places;
};

}  // namespace

void cross_entropy(const SearchSpace& space, const TryDesigns& attempt, const Better& better) {
  std::vector<Belief> beliefs = first_beliefs(space);
  const int size = generation_size(space.runs);
  std::vector<Tried> elite;
  for (int first = 0; first < space.runs; first += size) {
    std::vector<std::vector<double>> places;
    std::vector<std::vector<StudyValue>> designs;
    for (int d = first; d < std::min(first + size, space.runs); ++d) {
      auto& place = places.emplace_back();
      auto& design = designs.emplace_back();
      for (std::size_t v = 0; v < beliefs.size(); ++v) {
        const auto bits =
            random_bits(space.seed, Drawn::search, static_cast<std::uint64_t>(d), static_cast<std::uint32_t>(v));
        place.push_back(draw(beliefs[v], unit_interval(bits)));
        design.push_back(value_of(space.variables[v], place.back()));
      }
    }
    const std::size_t asked = designs.size();
    const std::vector<StudyDesign> done = attempt(std::move(designs));
    if (done.size() < asked) return;
    // The best of before stay among those that are learnt from.
    for (std::size_t d = 0; d < done.size(); ++d) elite.push_back({done[d], places[d]});
    std::stable_sort(elite.begin(), elite.end(),
                     [&](const Tried& a, const Tried& b) { return better(a.design, b.design); });
    elite.resize(std::min(elite.size(), std::max<std::size_t>(2, static_cast<std::size_t>(elite_share * size))));
    for (std::size_t v = 0; v < beliefs.size(); ++v) {
      std::vector<double> of_variable;
      for (const Tried& one : elite) of_variable.push_back(one.places[v]);
      learn(beliefs[v], of_variable);
    }
  }
}

void random_search(const SearchSpace& space, const TryDesigns& attempt) {
  const std::vector<Belief> beliefs = first_beliefs(space);
  std::vector<std::vector<StudyValue>> designs;
  for (int d = 0; d < space.runs; ++d) {
    auto& design = designs.emplace_back();
    for (std::size_t v = 0; v < beliefs.size(); ++v) {
      const auto bits =
          random_bits(space.seed, Drawn::search, static_cast<std::uint64_t>(d), static_cast<std::uint32_t>(v));
      design.push_back(value_of(space.variables[v], draw(beliefs[v], unit_interval(bits))));
    }
  }
  (void)attempt(std::move(designs));
}

}  // namespace topple::structure::study
