// Designs as samples: tried side by side, kept in the journal, compared.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include "study/design_search.h"
#include "study/run_each.h"
#include "study/study_tasks.h"
#include "study/study_value.h"
#include "topple/structure/error.h"

namespace topple::structure {

namespace {
class Tried;
}  // namespace

struct StudyOptimiser::State {
  Study study;
  OptimiseRequest request;
  StudyTask task;          ///< its samples are numbered design * repeats + r
  StudySampler chance;     ///< of `vary`: repeats, those of finalists, then the unseen
  std::size_t chosen = 0;  ///< the first so many variables
  std::string method;
  std::size_t objective = 0;

  [[nodiscard]] std::uint64_t repeats() const { return static_cast<std::uint64_t>(request.repeats); }
  [[nodiscard]] std::uint64_t finalist_repeats() const { return static_cast<std::uint64_t>(request.finalist_repeats); }
  [[nodiscard]] std::uint64_t first_finalist() const { return static_cast<std::uint64_t>(request.runs) * repeats(); }
  [[nodiscard]] std::uint64_t first_unseen() const {
    return first_finalist() + static_cast<std::uint64_t>(request.finalists) * finalist_repeats();
  }
  [[nodiscard]] Sample asked(std::uint64_t number, std::uint64_t of_chance,
                             const std::vector<StudyValue>& design) const;
  [[nodiscard]] StudyDesign judged(std::uint64_t run, std::vector<StudyValue> chosen_values,
                                   const std::vector<Sample>& samples) const;
  [[nodiscard]] double excess(const StudyDesign& design, std::size_t bound) const;
  [[nodiscard]] bool better(const StudyDesign& a, const StudyDesign& b) const;
  [[nodiscard]] bool choose_finalist(Tried& tried, const std::vector<std::vector<Sample>>& of_designs,
                                     OptimiseResult& result) const;
};

namespace {

std::string method_of(const OptimiseRequest& request, const std::vector<StudyVariable>& chosen,
                      const std::string& file) {
  const bool discrete = std::any_of(chosen.begin(), chosen.end(), study::SearchSpace::discrete);
  if (request.method.empty()) return discrete ? "cross-entropy" : "cobyla";
  if (discrete && (request.method == "cobyla" || request.method == "isres"))
    throw InputError(
        file + ", optimise.method: \"" + request.method +
        "\" takes continuous numbers alone, and a choice is among what is chosen; accepted: \"cross-entropy\"");
  return request.method;
}

/// Computes those that the journal lacks; false when it was stopped before all were there.
class Tried {
 public:
  Tried(const StudyTask& task, const StudyRun& run, StudyJournal& journal) : task_(task), run_(run), journal_(journal) {
    for (const Sample& sample : journal.found()) known_.emplace(sample.number, sample);
  }
  [[nodiscard]] bool compute(std::vector<Sample>& samples) {
    std::vector<Sample> missing;
    for (Sample& sample : samples) {
      const auto known = known_.find(sample.number);
      if (known == known_.end())
        missing.push_back(sample);
      else
        sample = same_inputs(known->second, sample);
    }
    const std::size_t count = missing.size();
    std::size_t done = 0;
    study::run_each(task_, run_, std::move(missing), [&](Sample&& sample) {
      journal_.add(sample);
      ++done;
      known_.emplace(sample.number, std::move(sample));
    });
    if (done < count) return false;
    for (Sample& sample : samples) sample = known_.at(sample.number);
    return true;
  }

 private:
  static const Sample& same_inputs(const Sample& known, const Sample& asked) {
    for (std::size_t v = 0; v < asked.inputs.size(); ++v)
      if (study::text_of(known.inputs[v]) != study::text_of(asked.inputs[v]))
        throw std::runtime_error("sample " + std::to_string(asked.number) +
                                 " of the journal has other inputs than the search asks for: it was made by another "
                                 "version of the program");
    return known;
  }
  const StudyTask& task_;
  const StudyRun& run_;
  StudyJournal& journal_;
  std::map<std::uint64_t, Sample> known_;
};

/// What happened in each of its samples: designs that differ in what has no effect (when a charge would go off that is
/// not used) are one.
using Outcome = std::vector<std::pair<std::vector<double>, std::string>>;
Outcome outcome_of(const std::vector<Sample>& samples) {
  Outcome outcome;
  for (const Sample& sample : samples) {
    outcome.emplace_back(sample.outputs, sample.parts);
    for (double& output : outcome.back().first)
      if (std::isnan(output)) output = std::numeric_limits<double>::infinity();  // so that it compares
  }
  return outcome;
}

}  // namespace

Sample StudyOptimiser::State::asked(std::uint64_t number, std::uint64_t of_chance,
                                    const std::vector<StudyValue>& design) const {
  Sample sample;
  sample.number = number;
  sample.inputs = design;
  if (!chance.variables().empty())
    for (StudyValue& value : chance.values(of_chance)) sample.inputs.push_back(std::move(value));
  return sample;
}

/// How far an output is beyond its bound, over the bound (or 1 where that is less).
double StudyOptimiser::State::excess(const StudyDesign& design, std::size_t bound) const {
  const OutputBounds& bounds = request.subject_to[bound];
  const auto at = std::find(task.outputs.begin(), task.outputs.end(), bounds.output) - task.outputs.begin();
  const double value = design.outputs[static_cast<std::size_t>(at)];
  if (std::isnan(value)) return std::numeric_limits<double>::infinity();
  double beyond = -std::numeric_limits<double>::infinity();
  if (std::isfinite(bounds.above))
    beyond = std::max(beyond, (bounds.above - value) / std::max(1.0, std::abs(bounds.above)));
  if (std::isfinite(bounds.below))
    beyond = std::max(beyond, (value - bounds.below) / std::max(1.0, std::abs(bounds.below)));
  return beyond;
}

StudyDesign StudyOptimiser::State::judged(std::uint64_t run, std::vector<StudyValue> chosen_values,
                                          const std::vector<Sample>& samples) const {
  StudyDesign design;
  design.run = run;
  design.chosen = std::move(chosen_values);
  design.outputs.assign(task.outputs.size(), 0);
  for (std::size_t i = 0; i < task.outputs.size(); ++i) {
    double count = 0;
    for (const Sample& sample : samples)
      if (sample.failed.empty() && !std::isnan(sample.outputs[i])) {
        design.outputs[i] += sample.outputs[i];
        ++count;
      }
    design.outputs[i] = count > 0 ? design.outputs[i] / count : std::numeric_limits<double>::quiet_NaN();
  }
  for (const Sample& sample : samples) design.failed += !sample.failed.empty();
  design.objective = design.outputs[objective];
  for (std::size_t b = 0; b < request.subject_to.size(); ++b) design.violation += std::max(0.0, excess(design, b));
  // A design that some samples fail with, or without the number that is looked for, keeps to nothing.
  if (design.failed > 0 || std::isnan(design.objective)) design.violation = std::numeric_limits<double>::infinity();
  return design;
}

bool StudyOptimiser::State::better(const StudyDesign& a, const StudyDesign& b) const {
  if (a.violation != b.violation) return a.violation < b.violation;
  if (a.violation > 0) return false;
  return request.greatest ? a.objective > b.objective : a.objective < b.objective;
}

/// The best of the search, each by all its samples; false when it was stopped before all were there. (Two stages, the
/// second for those that the first has left: B. L. Nelson, J. Swann, D. Goldsman, W. Song, Operations Research 49,
/// 2001.)
bool StudyOptimiser::State::choose_finalist(Tried& tried, const std::vector<std::vector<Sample>>& of_designs,
                                            OptimiseResult& result) const {
  if (request.finalists == 0) return true;
  std::vector<StudyDesign> order;
  std::set<Outcome> known;
  for (const StudyDesign& design : result.designs)
    if (known.insert(outcome_of(of_designs[design.run])).second) order.push_back(design);
  std::stable_sort(order.begin(), order.end(),
                   [&](const StudyDesign& one, const StudyDesign& other) { return better(one, other); });
  order.resize(std::min(order.size(), static_cast<std::size_t>(request.finalists)));
  std::vector<Sample> samples;
  for (std::size_t f = 0; f < order.size(); ++f)
    for (std::uint64_t r = 0; r < finalist_repeats(); ++r)
      samples.push_back(asked(first_finalist() + f * finalist_repeats() + r, repeats() + r, order[f].chosen));
  if (!tried.compute(samples)) return false;
  for (std::size_t f = 0; f < order.size(); ++f) {
    std::vector<Sample> all = of_designs[order[f].run];
    const auto from = samples.begin() + static_cast<std::ptrdiff_t>(f * finalist_repeats());
    all.insert(all.end(), from, from + static_cast<std::ptrdiff_t>(finalist_repeats()));
    result.finalists.push_back(judged(order[f].run, order[f].chosen, all));
  }
  std::stable_sort(result.finalists.begin(), result.finalists.end(),
                   [&](const StudyDesign& a, const StudyDesign& b) { return better(a, b); });
  result.best = result.finalists.front();
  return true;
}

StudyOptimiser::StudyOptimiser(const Study& study) : state_(std::make_unique<State>()) {
  State& s = *state_;
  if (!study.optimise) throw InputError(study.file + ": nothing is to be optimised; accepted: \"optimise\"");
  s.study = study;
  s.request = *study.optimise;
  if (study.base == Study::Base::none)
    throw InputError(study.file + ", optimise: nothing is run; accepted: a \"base\"");
  std::vector<Variation> all = s.request.choose;
  all.insert(all.end(), study.vary.begin(), study.vary.end());
  const std::shared_ptr<const study::StudyBase> base = study::sound_base(study, all);
  for (std::size_t e = 0; e < s.request.choose.size(); ++e) s.chosen += base->effects[e].count;
  const auto middle = base->variables.begin() + static_cast<std::ptrdiff_t>(s.chosen);
  const std::vector<StudyVariable> chosen(base->variables.begin(), middle);
  std::vector<CorrelatedGroup> groups = base->groups;
  for (CorrelatedGroup& group : groups)
    for (std::size_t& variable : group.variables) {
      if (variable < s.chosen)
        throw InputError(study.file +
                         ", groups: what is chosen does not vary by chance; accepted: entries of \"vary\"");
      variable -= s.chosen;
    }
  s.method = method_of(s.request, chosen, study.file);
  const auto unseen = static_cast<std::uint64_t>(s.request.unseen);
  try {
    // Of no use but for the names and the number of samples: values come from the search.
    std::vector<StudyVariable> names = base->variables;
    for (StudyVariable& variable : names)
      if (variable.distribution.kind == Distribution::Kind::grid)
        variable.distribution.kind = Distribution::Kind::choice;
    s.task.sampler = StudySampler(names, {}, Sampling::random, s.first_unseen() + unseen, study.seed);
    if (middle != base->variables.end())
      s.chance = StudySampler({middle, base->variables.end()}, groups, study.sampling,
                              s.repeats() + s.finalist_repeats() + unseen, study.seed);
  } catch (const std::invalid_argument& error) {
    throw InputError(study.file + ": " + error.what());
  }
  study::complete_task(s.task, base);
  s.objective = static_cast<std::size_t>(std::find(s.task.outputs.begin(), s.task.outputs.end(), s.request.objective) -
                                         s.task.outputs.begin());
}

StudyOptimiser::~StudyOptimiser() = default;
StudyOptimiser::StudyOptimiser(StudyOptimiser&&) noexcept = default;
const StudyTask& StudyOptimiser::task() const { return state_->task; }

OptimiseResult StudyOptimiser::run(const StudyRun& run, StudyJournal& journal) const {
  const State& s = *state_;
  OptimiseResult result;
  result.method = s.method;
  study::SearchSpace space;
  for (std::size_t v = 0; v < s.chosen; ++v) {
    space.variables.push_back(s.task.sampler.variables()[v]);
    result.chosen_names.push_back(space.variables.back().name);
  }
  space.seed = s.study.seed;
  space.runs = s.request.runs;
  StudyRun batch = run;
  batch.progress = nullptr;
  Tried tried(s.task, batch, journal);
  std::vector<std::vector<Sample>> of_designs;
  const auto attempt = [&](std::vector<std::vector<StudyValue>> designs) {
    std::vector<Sample> samples;
    const std::uint64_t first = result.designs.size();
    for (std::size_t d = 0; d < designs.size(); ++d)
      for (std::uint64_t r = 0; r < s.repeats(); ++r)
        samples.push_back(s.asked((first + d) * s.repeats() + r, r, designs[d]));
    std::vector<StudyDesign> done;
    if (!tried.compute(samples)) return done;
    for (std::size_t d = 0; d < designs.size(); ++d) {
      const auto from = samples.begin() + static_cast<std::ptrdiff_t>(d * s.repeats());
      of_designs.emplace_back(from, from + static_cast<std::ptrdiff_t>(s.repeats()));
      done.push_back(s.judged(first + d, std::move(designs[d]), of_designs.back()));
      result.designs.push_back(done.back());
      if (result.designs.size() == 1 || s.better(done.back(), result.best)) result.best = done.back();
    }
    if (run.progress) run.progress(result.designs.size(), static_cast<std::uint64_t>(s.request.runs));
    return done;
  };
  const auto better = [&](const StudyDesign& a, const StudyDesign& b) { return s.better(a, b); };
  if (s.method == "cross-entropy")
    study::cross_entropy(space, attempt, better);
  else if (s.method == "random")
    study::random_search(space, attempt);
  else
    study::nlopt_search(
        space, s.method, attempt,
        [&](const StudyDesign& design) { return s.request.greatest ? -design.objective : design.objective; },
        [&](const StudyDesign& design) {
          std::vector<double> all;
          for (std::size_t b = 0; b < s.request.subject_to.size(); ++b) all.push_back(s.excess(design, b));
          return all;
        },
        s.request.subject_to.size());
  if ((run.stopped && run.stopped()) || result.designs.empty()) return result;
  if (!s.choose_finalist(tried, of_designs, result)) return result;
  for (std::uint64_t u = 0; u < static_cast<std::uint64_t>(s.request.unseen); ++u)
    result.unseen.push_back(s.asked(s.first_unseen() + u, s.repeats() + s.finalist_repeats() + u, result.best.chosen));
  result.finished = tried.compute(result.unseen);
  if (!result.finished) result.unseen.clear();
  journal.sync();
  return result;
}

}  // namespace topple::structure
