// What the samples of a study say, against tables and closed forms.
#include <catch2/catch.hpp>
#include <cmath>

#include "study/counter_random.h"
#include "study/fragility_fit.h"
#include "study/normal_distribution.h"
#include "study/samples_statistics.h"
#include "topple/structure/study/study_statistics.h"

using namespace topple::structure;
using namespace topple::structure::study;

namespace {

/// The function of Ishigami and Homma (1990), whose Sobol indices are known: a = 7, b = 0.1.
class Ishigami : public SampleEvaluator {
 public:
  void evaluate(Sample& sample) override {
    const double x = sample.inputs[0].number, y = sample.inputs[1].number, z = sample.inputs[2].number;
    sample.outputs = {std::sin(x) + 7 * std::sin(y) * std::sin(y) + 0.1 * z * z * z * z * std::sin(x)};
  }
};

StudyTask ishigami(Sampling sampling, std::uint64_t samples) {
  Distribution d;
  d.low = -M_PI;
  d.high = M_PI;
  StudyTask task;
  task.sampler = StudySampler({{"x", d}, {"y", d}, {"z", d}}, {}, sampling, samples, 5);
  task.outputs = {"f"};
  task.make_evaluator = [] { return std::make_unique<Ishigami>(); };
  return task;
}

}  // namespace

TEST_CASE("Wilson's interval, Student's t and quantiles are those of tables") {
  // 7 of 20: Newcombe, Statist. Med. 17, 1998 gives the method; worked by hand from its formula with z = 1.959964.
  const Interval seven = Proportion{7, 20}.wilson();
  CHECK(seven[0] == Approx(0.18119).margin(1e-5));
  CHECK(seven[1] == Approx(0.56714).margin(1e-5));
  CHECK(Proportion{0, 10}.wilson()[0] == 0);
  CHECK(Proportion{0, 10}.wilson()[1] == Approx(0.27753).margin(1e-5));
  // Tables of Student's t to three digits after the point.
  CHECK(student_t(4) == Approx(2.776).margin(2e-3));
  CHECK(student_t(9) == Approx(2.262).margin(5e-4));
  CHECK(student_t(29) == Approx(2.045).margin(5e-4));
  std::vector<double> sorted(100);
  for (std::size_t i = 0; i < 100; ++i) sorted[i] = static_cast<double>(i);
  const StudyQuantile median = quantile(sorted, 0.5);
  CHECK(median.value == 49.5);
  // Conover's table for n = 100: the 40th and 61st order statistic.
  REQUIRE(median.interval);
  CHECK((*median.interval)[0] == 39);
  CHECK((*median.interval)[1] == 60);
}

TEST_CASE("What is the same in all samples has no deviation, whatever rounding adds up to") {
  for (const int count : {2, 3, 25, 999}) {
    const std::vector<double> alike(static_cast<std::size_t>(count), 0.1);
    CHECK(moments(alike).mean == 0.1);
    CHECK(moments(alike).sd == 0);
  }
}

TEST_CASE("Rank correlation is that of Spearman, equal values included") {
  const std::vector<double> x{106, 100, 86, 101, 99, 103, 97, 113, 112, 110}, y{7, 27, 2, 50, 28, 29, 20, 12, 6, 17};
  CHECK(correlation(ranks(x), ranks(y)) == Approx(-29.0 / 165).epsilon(1e-12));  // 1 - 6 * 194 / (10 * 99)
  CHECK(ranks(std::vector<double>{3, 1, 3, 2}) == std::vector<double>{2.5, 0, 2.5, 1});
}

TEST_CASE("Sobol indices of a known function are found, with an error that tells how well") {
  // V = a^2/8 + b pi^4/5 + b^2 pi^8/18 + 1/2; V1 = (1 + b pi^4/5)^2 / 2, V2 = a^2/8, V13 = b^2 pi^8 (1/18 - 1/50).
  const double p4 = std::pow(M_PI, 4), p8 = p4 * p4;
  const double v = 49.0 / 8 + 0.1 * p4 / 5 + 0.01 * p8 / 18 + 0.5, v1 = 0.5 * (1 + 0.02 * p4) * (1 + 0.02 * p4);
  const double v2 = 49.0 / 8, v13 = 0.01 * p8 * (1.0 / 18 - 1.0 / 50);
  const double first[3] = {v1 / v, v2 / v, 0}, total[3] = {(v1 + v13) / v, v2 / v, v13 / v};
  Study study;
  study.record = {{"f", Recorded::From::ready, "", ""}};
  for (const Sampling sampling : {Sampling::saltelli, Sampling::random}) {
    const StudyTask task = ishigami(sampling, 5 * 2048);
    const auto samples = run_samples(task);
    const StudyStatistics statistics = study_statistics(study, task, samples, nullptr);
    REQUIRE(statistics.influences.size() == 1);
    REQUIRE(statistics.influences[0].inputs.size() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
      const InputInfluence& one = statistics.influences[0].inputs[i];
      REQUIRE(one.first_order);
      const auto [index, error] = *one.first_order;
      CHECK(error > 0);
      CHECK(error < 0.05);
      // Four errors by bootstrap, and what thirty classes blur.
      CHECK(std::abs(index - first[i]) < 4 * error + (sampling == Sampling::random ? 0.01 : 0));
      CHECK(one.total.has_value() == (sampling == Sampling::saltelli));
      if (one.total) CHECK(std::abs((*one.total)[0] - total[i]) < 4 * (*one.total)[1]);
    }
    CHECK(statistics.outputs[0].mean == Approx(3.5).margin(4 * std::sqrt(v / 2048)));
    CHECK(statistics.outputs[0].sd == Approx(std::sqrt(v)).epsilon(0.05));
  }
}

TEST_CASE("A lognormal fragility curve is found again from what was drawn from it") {
  std::vector<double> x;
  std::vector<bool> hit;
  for (std::uint64_t k = 0; k < 4000; ++k) {
    x.push_back(10 + 70 * unit_interval(random_bits(3, Drawn::sample, k, 0)));
    hit.push_back(normal_share(std::log(x.back() / 35) / 0.3) > unit_interval(random_bits(3, Drawn::sample, k, 1)));
  }
  const Fragility fragility = fit_fragility("speed", x, hit);
  REQUIRE(fragility.median);
  // Standard errors about 0.3/sqrt(4000 * 0.4) = 0.0075 of the logarithm of the median, and 0.01 of the dispersion.
  CHECK(*fragility.median == Approx(35).epsilon(0.03));
  CHECK(*fragility.dispersion == Approx(0.3).margin(0.04));
  CHECK_FALSE(fragility.falling);
  CHECK(fragility.classes.size() == 10);
  hit.flip();
  CHECK(fit_fragility("strength", x, hit).falling);
  for (std::size_t i = 0; i < x.size(); ++i) hit[i] = x[i] > 40;
  CHECK_FALSE(fit_fragility("a step", x, hit).median);
}
