// What samples are fed: numbers by counter, Sobol points, distributions, correlation.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <set>

#include "study/counter_random.h"
#include "study/normal_distribution.h"
#include "study/shuffled.h"
#include "study/sobol_sequence.h"
#include "topple/structure/study/study.h"

using namespace topple::structure;
using namespace topple::structure::study;

namespace {

Distribution uniform(double low, double high) {
  Distribution d;
  d.low = low;
  d.high = high;
  return d;
}

Distribution of(Distribution::Kind kind, double mean, double sd) {
  Distribution d;
  d.kind = kind;
  d.mean = mean;
  d.sd = sd;
  return d;
}

/// Mean and standard deviation by the midpoint rule over the shares.
std::pair<double, double> moments_of(const Distribution& d) {
  constexpr int n = 200'000;
  double sum = 0, squares = 0;
  for (int i = 0; i < n; ++i) {
    const double x = d.quantile((i + 0.5) / n).number;
    sum += x;
    squares += x * x;
  }
  return {sum / n, std::sqrt(squares / n - sum / n * (sum / n))};
}

}  // namespace

TEST_CASE("Philox gives the words that its authors publish") {
  // kat_vectors of Random123 1.09, philox4x32 with 10 rounds.
  CHECK(philox({0, 0, 0, 0}, {0, 0}) == Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
  const std::uint32_t f = 0xffffffff;
  CHECK(philox({f, f, f, f}, {f, f}) == Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
  CHECK(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}) ==
        Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});
}

TEST_CASE("Sobol points are those of Joe and Kuo, and lie evenly") {
  // The first ten in three dimensions, as their program prints them (in the order of a Gray code).
  const double published[10][3] = {{0, 0, 0},
                                   {0.5, 0.5, 0.5},
                                   {0.75, 0.25, 0.25},
                                   {0.25, 0.75, 0.75},
                                   {0.375, 0.375, 0.625},
                                   {0.875, 0.875, 0.125},
                                   {0.625, 0.125, 0.875},
                                   {0.125, 0.625, 0.375},
                                   {0.1875, 0.3125, 0.9375},
                                   {0.6875, 0.8125, 0.4375}};
  for (std::uint64_t n = 0; n < 10; ++n)
    for (std::uint32_t d = 0; d < 3; ++d) CHECK(sobol_bits(n ^ (n >> 1), d) * 0x1p-32 == published[n][d]);
  // Every coordinate of the first 2^10 points falls once into each of as many parts.
  for (const std::uint32_t d : {0U, 1U, 7U, 100U, 255U, 511U}) {
    std::set<std::uint32_t> parts;
    for (std::uint64_t k = 0; k < 1024; ++k) parts.insert(sobol_bits(k, d) >> 22);
    CHECK(parts.size() == 1024);
  }
  // The first two together: once into each of 16 by 16 squares.
  std::set<std::uint32_t> squares;
  for (std::uint64_t k = 0; k < 256; ++k) squares.insert((sobol_bits(k, 0) >> 28 << 4) | sobol_bits(k, 1) >> 28);
  CHECK(squares.size() == 256);
}

TEST_CASE("A shuffled order has each place once") {
  for (const std::uint64_t n : {1ULL, 2ULL, 3ULL, 16ULL, 17ULL, 1000ULL}) {
    std::set<std::uint64_t> places;
    std::uint64_t fixed = 0;
    for (std::uint64_t i = 0; i < n; ++i) {
      places.insert(shuffled(i, n, 5, 3));
      fixed += shuffled(i, n, 5, 3) == i;
    }
    CHECK(places.size() == n);
    CHECK(*places.rbegin() == n - 1);
    if (n == 1000) CHECK(fixed < 10);  // one is expected; ten have a probability below 1e-6
  }
}

TEST_CASE("The normal distribution and its inverse agree with tables") {
  CHECK(normal_quantile(0.975) == Approx(1.959963984540054).epsilon(1e-15));
  CHECK(normal_quantile(1e-10) == Approx(-6.361340902404056).epsilon(1e-14));
  CHECK(normal_quantile(0.5) == 0);
  for (double z = -8; z < 6; z += 0.37)  // above, 1 - share has too few digits left
    CHECK(normal_quantile(normal_share(z)) == Approx(z).margin(1e-7));
}

TEST_CASE("Distributions have the mean and deviation that are asked for") {
  using Kind = Distribution::Kind;
  // The midpoint rule leaves out the tails beyond a share of 2.5e-6: below 1e-4 of the deviation.
  auto [mean, sd] = moments_of(of(Kind::normal, 5, 2));
  CHECK(mean == Approx(5).epsilon(1e-4));
  CHECK(sd == Approx(2).epsilon(2e-4));
  std::tie(mean, sd) = moments_of(of(Kind::lognormal, 388e6, 0.07 * 388e6));
  CHECK(mean == Approx(388e6).epsilon(1e-5));
  CHECK(sd == Approx(0.07 * 388e6).epsilon(5e-4));
  std::tie(mean, sd) = moments_of(uniform(-1, 3));
  CHECK(mean == Approx(1).epsilon(1e-9));
  CHECK(sd == Approx(4 / std::sqrt(12.0)).epsilon(1e-9));
  // Cut below at one deviation under the mean: mean + sd phi(-1) / (1 - Phi(-1)).
  Distribution cut = of(Kind::normal, 1, 0.1);
  cut.low = 0.9;
  const double phi = std::exp(-0.5) / std::sqrt(2 * M_PI), above = 0.5 * std::erfc(-1 / std::sqrt(2.0));
  CHECK(moments_of(cut).first == Approx(1 + 0.1 * phi / above).epsilon(1e-5));
  CHECK(cut.quantile(1e-9).number >= 0.9);
  // Far out in a tail numbers still differ: z above 6, mean of the rest 6 + 1/6 or so (Mills).
  Distribution tail = of(Kind::normal, 0, 1);
  tail.low = 6;
  CHECK(moments_of(tail).first == Approx(6.158).epsilon(1e-3));
  Distribution choice;
  choice.kind = Kind::choice;
  for (const double value : {10.0, 20.0, 30.0}) choice.values.push_back({value, {}});
  choice.weights = {1, 2, 1};
  CHECK(choice.quantile(0.24).number == 10);
  CHECK(choice.quantile(0.26).number == 20);
  CHECK(choice.quantile(0.76).number == 30);
}

TEST_CASE("A Latin hypercube has each part of each variable once") {
  const StudySampler sampler({{"a", uniform(0, 1)}, {"b", uniform(0, 1)}}, {}, Sampling::latin, 60, 9);
  for (std::size_t v = 0; v < 2; ++v) {
    std::set<int> parts;
    for (std::uint64_t k = 0; k < 60; ++k) parts.insert(static_cast<int>(sampler.values(k)[v].number * 60));
    CHECK(parts.size() == 60);
  }
}

TEST_CASE("Correlated variables have their correlation and keep their distributions") {
  using Kind = Distribution::Kind;
  const StudySampler sampler({{"a", of(Kind::normal, 3, 1)}, {"b", of(Kind::normal, 0, 2)}, {"c", uniform(0, 1)}},
                             {{{0, 1}, {1, 0.7, 0.7, 1}}}, Sampling::random, 20'000, 4);
  double ab = 0, a = 0, b = 0, aa = 0, bb = 0, ac = 0;
  const double n = 20'000;
  for (std::uint64_t k = 0; k < 20'000; ++k) {
    const auto x = sampler.values(k);
    a += x[0].number / n;
    b += x[1].number / n;
    ab += x[0].number * x[1].number / n;
    aa += x[0].number * x[0].number / n;
    bb += x[1].number * x[1].number / n;
    ac += (x[0].number - 3) * (x[2].number - 0.5) / n;
  }
  // Standard error of a correlation: (1 - r^2)/sqrt(n) = 0.0036, of a mean sd/sqrt(n); four of them.
  CHECK((ab - a * b) / std::sqrt((aa - a * a) * (bb - b * b)) == Approx(0.7).margin(0.015));
  CHECK(a == Approx(3).margin(0.03));
  CHECK(std::sqrt(bb - b * b) == Approx(2).margin(0.04));
  CHECK(std::abs(ac) < 4 * 0.289 / std::sqrt(n));
  CHECK_THROWS_AS(
      StudySampler({{"a", uniform(0, 1)}, {"b", uniform(0, 1)}}, {{{0, 1}, {1, 1, 1, 1}}}, Sampling::random, 10, 1),
      std::invalid_argument);
}

TEST_CASE("Grids go through every combination, and other variables stay random") {
  Distribution grid;
  grid.kind = Distribution::Kind::grid;
  for (const double value : {1.0, 2.0, 3.0}) grid.values.push_back({value, {}});
  Distribution two = grid;
  two.values.resize(2);
  const StudySampler sampler({{"a", grid}, {"b", two}, {"c", uniform(0, 1)}}, {}, Sampling::random, 0, 1);
  CHECK(sampler.samples() == 6);
  std::set<std::pair<double, double>> seen;
  for (std::uint64_t k = 0; k < 6; ++k) seen.emplace(sampler.values(k)[0].number, sampler.values(k)[1].number);
  CHECK(seen.size() == 6);
  CHECK(sampler.values(0)[2].number != sampler.values(1)[2].number);
  CHECK_THROWS_AS(StudySampler({{"a", grid}}, {}, Sampling::random, 4, 1), std::invalid_argument);
}

TEST_CASE("A sample's inputs do not depend on which others are drawn") {
  for (const Sampling sampling : {Sampling::random, Sampling::latin, Sampling::sobol, Sampling::saltelli}) {
    const std::vector<StudyVariable> variables{{"a", uniform(0, 1)}, {"b", of(Distribution::Kind::lognormal, 1, 0.2)}};
    const StudySampler forwards(variables, {}, sampling, 40, 3), backwards(variables, {}, sampling, 40, 3);
    const StudySampler other_seed(variables, {}, sampling, 40, 4);
    std::vector<double> first(40);
    for (std::uint64_t k = 0; k < 40; ++k) first[k] = forwards.values(k)[1].number;
    bool same = true, differs = false;
    for (std::uint64_t k = 40; k-- > 0;) {
      same = same && backwards.values(k)[1].number == first[k];
      differs = differs || other_seed.values(k)[1].number != first[k];
    }
    CHECK(same);
    CHECK(differs);
  }
}
