#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

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

/// A design near one of the best: a step or two along the list, or a normal step, in about one variable (mutation of an
/// evolution strategy, H.-G. Beyer, H.-P. Schwefel, Natural Computing 1, 2002). Where independent distributions cannot
/// follow how variables depend on each other, these go on.
double mutated(const Belief& belief, double place, double share, double chance, double step) {
  if (chance >= share) return place;
  if (belief.probability.empty()) {
    constexpr double deviation = 0.1;
    return std::clamp(place + deviation * normal_quantile(step), 0.0, 1.0);
  }
  const double last = static_cast<double>(belief.probability.size() - 1);
  constexpr double far = 0.2;  // anywhere in the list
  if (step < far) return std::floor(step / far * (last + 1));
  const double by = std::floor((step - far) / (1 - far) * 4);  // -2, -1, 1, 2
  return std::clamp(place + (by < 2 ? by - 2 : by - 1), 0.0, last);
}

/// Generations of about the square root of all runs: as many of them as there are designs in each.
int generation_size(int runs) { return std::clamp(static_cast<int>(std::lround(1.2 * std::sqrt(runs))), 4, 200); }

struct Tried {
  StudyDesign design;
  std::vector<double> places;
};

}  // namespace

namespace {

/// Design d: every other one of later generations is drawn near one of the elite.
std::vector<double> next_design(const SearchSpace& space, const std::vector<Belief>& beliefs,
                                const std::vector<Tried>& elite, int d, int again) {
  const auto u = [&](std::size_t what) {
    const auto k = static_cast<std::uint64_t>(d) | (static_cast<std::uint64_t>(again) << 32);
    return unit_interval(random_bits(space.seed, Drawn::search, k, static_cast<std::uint32_t>(what)));
  };
  const std::size_t n = beliefs.size();
  const bool near = !elite.empty() && d % 2 == 1;
  const std::size_t parent = elite.empty() ? 0 : static_cast<std::size_t>(u(3 * n) * static_cast<double>(elite.size()));
  std::vector<double> place;
  for (std::size_t v = 0; v < n; ++v)
    place.push_back(
        near ? mutated(beliefs[v], elite[parent].places[v], 1.5 / static_cast<double>(n), u(n + v), u(2 * n + v))
             : draw(beliefs[v], u(v)));
  return place;
}

}  // namespace

void cross_entropy(const SearchSpace& space, const TryDesigns& attempt, const Better& better) {
  std::vector<Belief> beliefs = first_beliefs(space);
  const int size = generation_size(space.runs);
  std::vector<Tried> elite;
  std::set<std::vector<double>> known;
  for (int first = 0; first < space.runs; first += size) {
    std::vector<std::vector<double>> places;
    std::vector<std::vector<StudyValue>> designs;
    for (int d = first; d < std::min(first + size, space.runs); ++d) {
      std::vector<double> place;
      // One that was tried already says nothing new.
      constexpr int attempts = 20;
      for (int again = 0; again < attempts; ++again) {
        place = next_design(space, beliefs, elite, d, again);
        if (known.insert(place).second) break;
      }
      auto& design = designs.emplace_back();
      for (std::size_t v = 0; v < beliefs.size(); ++v) design.push_back(value_of(space.variables[v], place[v]));
      places.push_back(std::move(place));
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
