#pragma once
// The best design of a study: numbers and choices for which an output is least or greatest while others keep to bounds.
// Each design is tried on the same samples of what varies by chance. The search is a function of the study alone, so
// that it goes the same way on any number of threads, and after a restart, when the journal's samples are not computed
// again.
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "topple/structure/study/study.h"

namespace topple::structure {

/// A design and what it does, in the mean over its samples.
struct StudyDesign {
  std::uint64_t run = 0;           ///< its number in the search
  std::vector<StudyValue> chosen;  ///< one for each variable of `choose`
  std::vector<double> outputs;     ///< means; NaN where no sample has one
  double objective = 0;            ///< the mean of the output that is least or greatest
  double violation = 0;            ///< 0: all bounds hold; else the sum of what is missing, each over its bound
  std::size_t failed = 0;          ///< samples
};

/// The answer of an optimisation.
struct OptimiseResult {
  std::string method;                     ///< that was used
  StudyDesign best;                       ///< of all designs whose bounds hold, else the one closest to them
  std::vector<StudyDesign> designs;       ///< in order of their runs
  std::vector<StudyDesign> finalists;     ///< the best of them by the means over all their samples, best first
  std::vector<Sample> unseen;             ///< of the best, on samples that the search has not used
  std::vector<std::string> chosen_names;  ///< of StudyDesign::chosen
  bool finished = false;                  ///< false: stopped before its end
};

/// A task whose samples are numbered by design and repeat, for the journal: sample design * repeats + r, then those of
/// the finalists, and of the answer. Throws InputError.
class StudyOptimiser {
 public:
  /// Reads the model and scenario. Throws InputError.
  explicit StudyOptimiser(const Study& study);
  ~StudyOptimiser();
  /// Moves: what is moved from may only be destroyed or assigned to.
  StudyOptimiser(StudyOptimiser&&) noexcept;
  /// For the journal.
  [[nodiscard]] const StudyTask& task() const;
  /// Goes on from what the journal has.
  [[nodiscard]] OptimiseResult run(const StudyRun& run, StudyJournal& journal) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace topple::structure
