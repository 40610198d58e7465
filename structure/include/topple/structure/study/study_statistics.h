#pragma once
// What the samples of a study say: distributions with their confidence, the probability of collapse, what it hangs on.
// All intervals are of 95 %. Failed samples and outputs without a number are left out and counted.
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "topple/structure/building.h"
#include "topple/structure/formats/json_tree.h"
#include "topple/structure/study/study.h"

namespace topple::structure {

using Interval = std::array<double, 2>;

/// The value below which a share of the samples lies.
struct StudyQuantile {
  double share = 0;                  ///< 0 to 1
  double value = 0;                  ///< between order statistics, linear (R. J. Hyndman, Y. Fan, 1996, type 7)
  std::optional<Interval> interval;  ///< between order statistics; none where there are too few samples
};
/// What the samples say of one output.
struct OutputStatistics {
  std::string name;                       ///< of the output
  std::size_t count = 0;                  ///< samples with a number
  std::size_t missing = 0;                ///< samples without one
  double mean = 0;                        ///< arithmetic
  double sd = 0;                          ///< sample standard deviation
  double least = 0;                       ///< smallest
  double largest = 0;                     ///< largest
  std::optional<Interval> mean_interval;  ///< Student's t
  std::vector<StudyQuantile> quantiles;   ///< 0.05, 0.25, 0.5, 0.75, 0.95
  /// Number of samples, mean and half the width of its interval, as they came by number.
  std::vector<std::array<double, 3>> convergence;
};

/// A share of samples with its interval (E. B. Wilson, J. Am. Stat. Assoc. 22, 1927).
struct Proportion {
  std::size_t hits = 0;  ///< samples of which it holds
  std::size_t of = 0;    ///< samples in all
  /// hits over all; 0 without samples.
  [[nodiscard]] double share() const { return of > 0 ? static_cast<double>(hits) / static_cast<double>(of) : 0; }
  /// Wilson's interval.
  [[nodiscard]] Interval wilson() const;
};

/// What one output owes to one input.
struct InputInfluence {
  std::string input;                 ///< by its name
  double rank_correlation = 0;       ///< Spearman's
  std::optional<Interval> interval;  ///< by Fisher's transformation (E. C. Fieller et al., Biometrika 44, 1957)
  /// Sobol indices with their standard error by bootstrap. First order: of the variance that goes when the input is
  /// known; total: that stays when all others are. From a "saltelli" design (Saltelli et al. 2010, M. J. W. Jansen
  /// 1999); else the first order alone, from classes of equal counts, as a correlation ratio freed of its bias (T. L.
  /// Kelley, 1935).
  std::optional<std::array<double, 2>> first_order;
  std::optional<std::array<double, 2>> total;  ///< index and standard error
};
/// What one output owes to every input.
struct OutputInfluences {
  std::string output;                  ///< by its name
  std::vector<InputInfluence> inputs;  ///< one for each variable
};

/// Probability of collapse over an input: a lognormal curve fitted by maximum likelihood (J. W. Baker, Efficient
/// analytical fragility function fitting using dynamic structural analysis, Earthq. Spectra 31, 2015).
struct Fragility {
  std::string input;  ///< by its name
  /// Samples with an input in a range.
  struct Class {
    double from = 0;       ///< from this value
    double to = 0;         ///< up to this value
    Proportion collapsed;  ///< how many collapsed
  };
  std::vector<Class> classes;        ///< in order of `from`
  bool falling = false;              ///< collapse becomes rarer as the input grows (a strength)
  std::optional<double> median;      ///< of the fitted curve
  std::optional<double> dispersion;  ///< none: the fit has no finite answer
};

/// How often each part of the building fell.
struct PartShares {
  std::vector<double> members;  ///< per member
  std::vector<double> panels;   ///< per panel
  std::vector<double> joints;   ///< share of samples in which it fell, or broke
  std::size_t samples = 0;      ///< that were counted
};

/// All that the samples say.
struct StudyStatistics {
  std::size_t planned = 0;                   ///< asked for
  std::size_t done = 0;                      ///< computed
  std::size_t failed = 0;                    ///< without an answer
  std::vector<OutputStatistics> outputs;     ///< in the order of the task
  std::optional<Proportion> collapse;        ///< none: the study does not say what a collapse is
  std::vector<OutputInfluences> influences;  ///< of each output, and of "collapse"
  std::optional<Fragility> fragility;        ///< none: none was asked for
  PartShares parts;                          ///< empty where it is not known
};

/// `samples` in order of their numbers. `parts` is left empty where the building has other parts than the samples.
[[nodiscard]] StudyStatistics study_statistics(const Study& study, const StudyTask& task,
                                               std::span<const Sample> samples, const Building* building);
/// Whether a sample counts as a collapse; none where it failed or lacks a number that is asked about.
[[nodiscard]] std::optional<bool> collapsed(const Study& study, const StudyTask& task, const Sample& sample);
/// An input as a number: that of a choice by its place in the list.
[[nodiscard]] double input_number(const StudyVariable& variable, const StudyValue& value);
/// study.json; `optimise` is the answer of an optimisation, where there was one.
[[nodiscard]] std::string study_json(const Study& study, const StudyTask& task, std::span<const Sample> samples,
                                     const StudyStatistics& statistics, const Building* building,
                                     const JsonTree& optimise = {});

}  // namespace topple::structure
