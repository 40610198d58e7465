#pragma once
// Studies: many runs of one thing under changed inputs. What sample k is fed is a function of the study and k alone, so
// that samples may be computed in any order, by any number of threads or machines, and again after a restart, with the
// same bits. A study of a model or scenario comes from a file (docs/studies.md); one over a function of the host's own
// is made of a StudySampler and a SampleEvaluator.
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace topple::structure {

/// What a variable takes in a sample: a number, or any other JSON value as text.
struct StudyValue {
  double number = std::numeric_limits<double>::quiet_NaN();  ///< NaN: it is not a number
  std::string json;                                          ///< empty: it is the number
  /// Whether `number` holds.
  [[nodiscard]] bool is_number() const { return json.empty(); }
};

/// How a variable is spread. `low` and `high` cut a distribution off: it is what is left of it, drawn by the inverse of
/// its cumulative distribution, while `mean` and `sd` are those of the whole.
struct Distribution {
  /// Which shape; grid: each value in turn, for a full factorial design.
  enum class Kind { uniform, normal, lognormal, choice, grid };
  Kind kind = Kind::uniform;                              ///< which shape
  double low = -std::numeric_limits<double>::infinity();  ///< least value that is drawn
  double high = std::numeric_limits<double>::infinity();  ///< largest value that is drawn
  double mean = 0;                                        ///< of the variable itself
  double sd = 0;                   ///< normal and lognormal, of the variable itself (not of its logarithm)
  std::vector<StudyValue> values;  ///< choice and grid
  std::vector<double> weights;     ///< choice: of each value; empty: alike
  /// The value below which a share u of it lies, 0 < u < 1; of a grid the value of that share of its list.
  [[nodiscard]] StudyValue quantile(double u) const;
};

/// A variable by its name.
struct StudyVariable {
  std::string name;           ///< unique within the study
  Distribution distribution;  ///< how it is spread
};

/// Variables that depend on each other: the correlation of the standard normal numbers that they are made of (a
/// Gaussian copula; of normal variables their own correlation, of lognormal ones that of their logarithms).
struct CorrelatedGroup {
  std::vector<std::size_t> variables;  ///< into the sampler's variables
  std::vector<double> correlation;     ///< rows after each other; positive definite
};

/// `random`: independent numbers. `latin`: a Latin hypercube, each variable once in each of as many equal parts as
/// there are samples. `sobol`: a Sobol sequence, shifted by the seed. `saltelli`: d + 2 samples for each point of such
/// a sequence, from which Sobol indices follow (A. Saltelli et al., Variance based sensitivity analysis of model
/// output, Comput. Phys. Commun. 181, 2010).
enum class Sampling { random, latin, sobol, saltelli };

/// What each sample is fed.
class StudySampler {
 public:
  StudySampler() = default;
  /// `samples`: how many there are; 0: one for each combination of the grids. Throws std::invalid_argument for a
  /// correlation that is not positive definite, for more variables or samples than a Sobol sequence has, for a number
  /// of samples that is no multiple of the combinations of the grids (or, for `saltelli`, of d + 2).
  StudySampler(std::vector<StudyVariable> variables, std::vector<CorrelatedGroup> groups, Sampling sampling,
               std::uint64_t samples, std::uint64_t seed);
  /// How many samples there are.
  [[nodiscard]] std::uint64_t samples() const { return samples_; }
  /// How they are drawn.
  [[nodiscard]] Sampling sampling() const { return sampling_; }
  /// In their order.
  [[nodiscard]] const std::vector<StudyVariable>& variables() const { return variables_; }
  /// Value of each variable in sample k < samples(). May be called from several threads.
  [[nodiscard]] std::vector<StudyValue> values(std::uint64_t k) const;

 private:
  [[nodiscard]] double share(std::uint64_t k, std::size_t variable) const;
  [[nodiscard]] double point(std::uint64_t k, std::uint32_t dimension) const;

  struct Group {
    std::vector<std::size_t> variables;
    std::vector<double> factor;  ///< lower triangle of Cholesky, rows after each other
  };
  std::vector<StudyVariable> variables_;
  std::vector<Group> groups_;
  std::vector<std::uint64_t> grid_stride_;  ///< per variable; 0: no grid
  Sampling sampling_ = Sampling::random;
  std::uint64_t samples_ = 0, seed_ = 0;
};

/// One sample as it was computed.
struct Sample {
  std::uint64_t number = 0;        ///< from 0
  std::vector<StudyValue> inputs;  ///< one for each variable
  std::vector<double> outputs;     ///< NaN: it has no such number; empty when it failed
  std::string failed;              ///< the reason
  std::string parts;               ///< which parts fell and joints broke (StudyParts), or empty
  double seconds = 0;              ///< it took; no part of the journal
};

/// Computes samples; each thread has one of its own.
class SampleEvaluator {
 public:
  virtual ~SampleEvaluator() = default;
  /// Sets `outputs` (one for each of StudyTask::outputs) and `parts` of samples whose inputs are set. What it throws
  /// becomes the reason why a sample failed.
  virtual void evaluate(Sample& sample) = 0;
};

/// All that is needed to run samples.
struct StudyTask {
  StudySampler sampler;              ///< makes the inputs
  std::vector<std::string> outputs;  ///< names
  /// Of all that the samples depend on (files, program): the journal of another fingerprint is refused.
  std::uint64_t fingerprint = 0;
  std::function<std::unique_ptr<SampleEvaluator>()> make_evaluator;  ///< called on the thread that uses it
  /// Two samples must not be computed at once in one process (collapses: the collision engine has state that all of a
  /// process share): side by side they run in processes that are forked, each with one thread.
  bool apart = false;
};

/// Sample k of the task: its inputs, evaluated; never throws for a sample that fails.
[[nodiscard]] Sample run_sample(const StudyTask& task, SampleEvaluator& evaluator, std::uint64_t k);

/// Line of journal.jsonl, without its end: {"sample": ..., "inputs": {...}, "outputs": {...}} or `failed`, and `check`,
/// 64 bits over the rest of the line and the task's fingerprint.
[[nodiscard]] std::string journal_line(const StudyTask& task, const Sample& sample);
/// The sample of a line; none where the check does not hold.
[[nodiscard]] std::optional<Sample> read_journal_line(const StudyTask& task, std::string_view line);

/// The journal of a run in its folder: each sample is appended by one write as it ends, and is on the disk (fsync) a
/// second later. times.csv has the wall times.
class StudyJournal {
 public:
  /// What becomes of a journal that is there: it is refused; it is taken in, half a line at its end dropped; the same,
  /// but samples that failed count as missing, and of several lines of a sample the last one holds.
  enum class Found { refuse, resume, retry_failed };
  /// Opens or makes it. Throws InputError: for a journal of another study with the line.
  StudyJournal(const StudyTask& task, const std::filesystem::path& folder, Found found);
  StudyJournal(const StudyJournal&) = delete;
  StudyJournal& operator=(const StudyJournal&) = delete;
  ~StudyJournal();
  /// Samples found when it was opened, but for those that are to be tried again.
  [[nodiscard]] const std::vector<Sample>& found() const { return found_; }
  /// Whether the journal has this sample, failed ones included.
  [[nodiscard]] bool has(std::uint64_t sample) const;
  /// Throws std::runtime_error when it cannot be written.
  void add(const Sample& sample);
  /// `line` as journal_line() makes it; `where` it ran ("0", "rank 2").
  void add_line(std::uint64_t sample, std::string_view line, double seconds, std::string_view where);
  /// Everything onto the disk.
  void sync();

 private:
  void keep(Sample sample);

  const StudyTask& task_;
  std::filesystem::path folder_;
  std::vector<Sample> found_;
  std::vector<bool> has_;
  int file_ = -1, times_ = -1;
  double synced_at_ = 0;
};

/// Which samples are run, and who is told.
struct StudyRun {
  std::uint64_t from = 0;                                               ///< the first
  std::uint64_t to = ~std::uint64_t{0};                                 ///< samples from <= k < to
  int threads = 0;                                                      ///< 0: one for each processor
  std::function<bool()> stopped;                                        ///< true: no further sample is begun
  std::function<void(std::uint64_t done, std::uint64_t all)> progress;  ///< told after each sample
};
/// Computes what the journal lacks, on threads of this process, or in forked ones where samples must be apart.
void run_samples(const StudyTask& task, const StudyRun& run, StudyJournal& journal);
/// The same without a journal: all samples in their order.
[[nodiscard]] std::vector<Sample> run_samples(const StudyTask& task, const StudyRun& run = {});

/// A table: a line for each sample, its inputs and outputs; those of failed samples are empty.
[[nodiscard]] std::string samples_csv(const StudyTask& task, std::span<const Sample> samples);

// ---- Studies of models and scenarios ----

/// One entry of `vary`.
struct Variation {
  /// What is varied: a number in a file, joints' strengths, which member is lost, or the times of charges.
  enum class Target { pointer, joints, loss, charges };
  /// How the drawn value goes in: it replaces the number, is added to it, or multiplies it.
  enum class Change { replace, add, times };
  std::string name;                  ///< unique within the study
  Target target = Target::pointer;   ///< what is varied
  bool of_model = false;             ///< pointer: into the model, else into the scenario
  std::string pointer;               ///< JSON pointer (RFC 6901)
  Change change = Change::replace;   ///< how the value goes in
  std::string selector;              ///< joints, members that are lost: a group, name or pattern
  std::vector<std::string> charges;  ///< names or patterns of members
  bool each = false;                 ///< every joint, or every charge, a variable of its own
  Distribution distribution;         ///< of charges: when each goes off, s
  std::optional<Distribution> used;  ///< charges: whether each goes off at all
  std::string place;                 ///< in the study's file, for messages
};

/// An output: a number of a result file, or one by its name.
struct Recorded {
  /// Where the number comes from: summary.json, results.json, or by a name that needs no path.
  enum class From { summary, results, ready };
  std::string name;         ///< unique within the study
  From from = From::ready;  ///< which of the three
  std::string pointer;      ///< JSON pointer, or the name of a ready one
  std::string place;        ///< in the study's file, for messages
};

/// An output beyond bounds.
struct OutputBounds {
  std::string output;                                       ///< by its name
  double above = -std::numeric_limits<double>::infinity();  ///< it has to be above this
  double below = std::numeric_limits<double>::infinity();   ///< it has to be below this
  /// above < value < below, with a bound that is not given left out.
  [[nodiscard]] bool holds(double value) const { return value > above && value < below; }
};

/// What an optimisation looks for.
struct OptimiseRequest {
  bool greatest = false;                 ///< true: the largest is wanted
  std::string objective;                 ///< an output
  std::vector<OutputBounds> subject_to;  ///< each holds in the answer
  int runs = 0;                          ///< designs that are tried
  int repeats = 1;                       ///< samples of `vary` for each design; its outputs are their means
  int finalists = 0;                     ///< so many of the best designs are tried again before one is chosen: of many
                                         ///< noisy means the best is the luckiest
  int finalist_repeats = 0;              ///< samples of `vary` for each of them, which the search has not used
  int unseen = 32;                       ///< further samples that the answer is tried on at the end
  std::string method;                    ///< "cobyla", "isres" or "cross-entropy"; empty: by what is chosen
  std::vector<Variation> choose;         ///< what may be chosen; its distributions bound the search
};

/// What a study file says.
struct Study {
  std::string title;  ///< for a person
  std::string file;   ///< path that it was read from
  std::string text;   ///< of the file
  /// What is run: nothing of ours, an analysis, or a collapse.
  enum class Base { none, model, scenario };
  Base base = Base::none;                ///< what is run
  std::filesystem::path model;           ///< file; with Base::scenario the one that the scenario names
  std::filesystem::path scenario;        ///< file, for Base::scenario
  std::vector<std::string> analyse;      ///< options of `topple analyse`
  std::uint64_t samples = 0;             ///< how many; 0: one for each combination of the grids
  std::uint64_t seed = 1;                ///< of all that is drawn
  Sampling sampling = Sampling::random;  ///< how they are drawn
  std::vector<Variation> vary;           ///< what varies by chance
  /// Variables that depend on each other.
  struct Group {
    std::vector<std::string> of;  ///< names of entries of `vary`
    std::vector<double> matrix;   ///< empty: `alike` between any two
    double alike = 0;             ///< one correlation for all pairs, where there is no matrix
    std::string place;            ///< in the study's file, for messages
  };
  std::vector<Group> groups;                ///< sets of variables that depend on each other
  std::vector<Recorded> record;             ///< outputs that are kept
  std::vector<OutputBounds> collapse_if;    ///< any of them
  std::string fragility;                    ///< input that the probability of collapse is drawn over
  std::optional<OptimiseRequest> optimise;  ///< an optimisation, where one is asked for
};

/// Names of the outputs that need no path (docs/studies.md says what each is).
[[nodiscard]] std::span<const std::string_view> ready_outputs();

/// Throws InputError with file, place, what is wrong and what is accepted.
[[nodiscard]] Study read_study(const std::filesystem::path& file);
[[nodiscard]] Study parse_study(std::string_view text, const std::string& name, const std::filesystem::path& folder);
/// True when the file is a study (a JSON object with `base`).
[[nodiscard]] bool is_study(const std::filesystem::path& file);
/// A path, or a shipped one's name. Throws InputError.
[[nodiscard]] std::filesystem::path find_study(const std::string& name_or_path);

/// What a study of a file runs: reads its model and scenario, and finds what `vary` and `record` name in them. Throws
/// InputError.
[[nodiscard]] StudyTask study_task(const Study& study);

}  // namespace topple::structure
