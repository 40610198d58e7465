#include "topple/solver/static_analysis.h"

#include <chrono>
#include <cmath>
#include <future>
#include <optional>
#include <stdexcept>

#include "assembly/frame_loads.h"
#include "assembly/frame_recovery.h"
#include "assembly/frame_system.h"
#include "assembly/mechanism.h"
#include "assembly/refinement.h"
#include "factor/factor.h"
#include "topple/solver/case_sums.h"
#include "topple/solver/kept_equations.h"
#include "topple/solver/parallel_for.h"

namespace topple::solver {
namespace {

/// Adds the time between construction and destruction to a figure of the statistics.
class Stopwatch {
 public:
  explicit Stopwatch(double& seconds) : seconds_(seconds) {}
  ~Stopwatch() { seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& seconds_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// A frame's equations with their factor.
struct Prepared {
  FrameSystem system;
  AnalysisOptions options;
  AnalysisStatistics statistics;
  Stability stability;
  std::unique_ptr<Factor> factor;

  Prepared(FrameModel model, const AnalysisOptions& given) : system(std::move(model)), options(given) {}
  void assemble();
  void order();
  void factorise();
  [[nodiscard]] Eigen::MatrixXd right_hand_sides(std::span<const LoadVector> vectors) const;
  [[nodiscard]] LinearSolve linear_solve() const {
    return [this](Eigen::Ref<Eigen::MatrixXd> b) { factor->solve(b); };
  }
};

void Prepared::assemble() {
  const Stopwatch watch(statistics.assemble_seconds);
  system.assemble();
  statistics.freedoms = static_cast<std::size_t>(system.dofs().equations);
  statistics.matrix_entries = system.matrix().row.size();
}

void Prepared::order() {
  const Stopwatch watch(statistics.order_seconds);
  factor =
      std::make_unique<Factor>(system.matrix(), system.elimination_order(), options.factorisation, options.threads);
  statistics.ordering = "node graph METIS";
  statistics.factorisation = factor->name();
  statistics.factor_entries = factor->entries();
  statistics.factor_operations = factor->operations();
}

void Prepared::factorise() {
  const Stopwatch watch(statistics.factor_seconds);
  stability = factorise_and_judge(system, *factor, options);
  require_none(stability.defect);
}

/// The estimate of the condition: solves one after the other that keep one processor busy, so that answers are found
/// beside it where there is a second one.
class ConditionBeside {
 public:
  explicit ConditionBeside(Prepared& prepared) : prepared_(prepared) {
    if (prepared.stability.condition != 0 || !prepared.factor) return;
    // CHOLMOD's factors have one workspace for all solves.
    const bool beside = prepared.options.threads > 1 && prepared.factor->kind() == Factorisation::automatic;
    condition_ = std::async(beside ? std::launch::async : std::launch::deferred, [this] {
      const Stopwatch watch(prepared_.statistics.condition_seconds);
      return estimate_condition(prepared_.system.matrix(), prepared_.linear_solve());
    });
  }

  /// Brings it home.
  void finish() {
    Stability& stability = prepared_.stability;
    if (condition_.valid()) judge_condition(prepared_.options, condition_.get(), stability);
    prepared_.statistics.nearly_unstable = stability.nearly_unstable;
    if (stability.condition > 0)
      prepared_.statistics.digits_left = std::clamp(16 - std::log10(stability.condition), 0.0, 16.0);
  }

 private:
  Prepared& prepared_;
  std::future<double> condition_;
};

/// Scaled; each in a column.
Eigen::MatrixXd Prepared::right_hand_sides(std::span<const LoadVector> vectors) const {
  const Eigen::Index n = system.dofs().equations;
  const Eigen::Map<const Eigen::VectorXd> scale(system.scale().data(), n);
  Eigen::MatrixXd b(n, static_cast<Eigen::Index>(vectors.size()));
  for (std::size_t j = 0; j < vectors.size(); ++j)
    b.col(static_cast<Eigen::Index>(j)) = vectors[j].force.head(n).cwiseProduct(scale);
  return b;
}

/// From the scaled displacements; condition and error bound are left to write_condition().
std::vector<StaticSolution> answers(const Prepared& prepared, std::vector<LoadVector> vectors,
                                    RefinedSolution refined) {
  const FrameSystem& system = prepared.system;
  refined.x.array().colwise() *= Eigen::Map<const Eigen::ArrayXd>(system.scale().data(), system.dofs().equations);
  std::vector<StaticSolution> solutions = recover_solutions(system, vectors, refined.x, prepared.options.threads);
  for (std::size_t j = 0; j < vectors.size(); ++j) solutions[j].quality = refined.quality[j];
  return solutions;
}

void write_condition(const Prepared& prepared, ConditionBeside& condition, std::vector<StaticSolution>& solutions) {
  condition.finish();
  for (StaticSolution& solution : solutions) {
    SolveQuality& quality = solution.quality;
    quality.condition = std::max(prepared.stability.condition, 1.0);
    quality.error_bound = forward_error_bound(quality.condition, quality.backward_error);
  }
}

std::unique_ptr<Prepared> prepare(FrameModel model, const AnalysisOptions& options) {
  double map_seconds = 0;  // numbering the freedoms and building the assembly map
  std::unique_ptr<Prepared> prepared;
  {
    const Stopwatch watch(map_seconds);
    prepared = std::make_unique<Prepared>(std::move(model), options);
  }
  prepared->statistics.assemble_seconds = map_seconds;
  // Ordering needs the pattern alone, which is there: it goes on beside the assembly.
  const bool any = prepared->system.dofs().equations > 0;
  std::future<void> ordering = std::async(options.threads > 1 ? std::launch::async : std::launch::deferred, [&] {
    if (any) prepared->order();
  });
  prepared->assemble();
  require_none(prepared->system.defect());
  ordering.get();
  if (any) prepared->factorise();
  return prepared;
}

/// The same equations with the numbers of another frame; false where they are others.
bool prepare_again(Prepared& prepared, FrameModel& model, const AnalysisOptions& options) {
  const AnalysisOptions& kept = prepared.options;
  if (kept.factorisation != options.factorisation || kept.threads != options.threads) return false;
  const AnalysisStatistics before = prepared.statistics;
  AnalysisStatistics& statistics = prepared.statistics = {};
  statistics.factor_entries = before.factor_entries;
  statistics.factor_operations = before.factor_operations;
  statistics.factorisation = before.factorisation;
  statistics.ordering = before.ordering;
  prepared.stability = {};
  prepared.options = options;
  {
    const Stopwatch watch(statistics.assemble_seconds);
    if (!prepared.system.replace_numbers(model)) return false;
  }
  prepared.assemble();
  require_none(prepared.system.defect());
  if (prepared.factor) prepared.factorise();
  return true;
}

std::vector<StaticSolution> solve_each(Prepared& prepared, std::span<const LoadSet> loads) {
  ConditionBeside condition(prepared);
  std::vector<StaticSolution> solutions;
  {
    const Stopwatch watch(prepared.statistics.solve_seconds);
    std::vector<LoadVector> vectors = load_vectors(prepared.system, loads);
    for (const LoadVector& vector : vectors) require_none(prepared.system.unbalanced_load(vector));
    const Eigen::MatrixXd b = prepared.right_hand_sides(vectors);
    RefinedSolution refined{b, std::vector<SolveQuality>(loads.size())};
    if (b.rows() > 0) refined = solve_refined(prepared.system.matrix(), prepared.linear_solve(), b);
    solutions = answers(prepared, std::move(vectors), std::move(refined));
  }
  write_condition(prepared, condition, solutions);
  return solutions;
}

LoadSet sum_of(std::span<const LoadSet> cases, const Eigen::VectorXd& factors) {
  LoadSet sum;
  for (std::size_t c = 0; c < cases.size(); ++c) {
    const double factor = factors(static_cast<Eigen::Index>(c));
    if (factor == 0) continue;
    for (NodeLoad load : cases[c].nodes) {
      load.load *= factor;
      sum.nodes.push_back(load);
    }
    for (BeamLoad load : cases[c].beams) {
      load.first *= factor;
      load.last *= factor;
      load.strain *= factor;
      load.curvature_y *= factor;
      load.curvature_z *= factor;
      sum.beams.push_back(load);
    }
    for (ShellLoad load : cases[c].shells) {
      load.traction *= factor;
      load.strain *= factor;
      sum.shells.push_back(load);
    }
    for (Settlement settlement : cases[c].settlements) {
      settlement.value *= factor;
      sum.settlements.push_back(settlement);
    }
  }
  return sum;
}

/// What recovery needs of a sum; none of the cases acts on a loose part.
LoadVector sum_of(std::span<const LoadVector> cases, const Eigen::VectorXd& factors) {
  LoadVector sum;
  sum.force = Eigen::VectorXd::Zero(cases.front().force.size());
  sum.held_displacement = Eigen::VectorXd::Zero(cases.front().held_displacement.size());
  const auto add = [](auto& to, const auto& from, double factor) {
    if (from.empty()) return;
    if (to.empty()) to.assign(from.size(), std::decay_t<decltype(from[0])>::Zero());
    for (std::size_t i = 0; i < from.size(); ++i) to[i] += factor * from[i];
  };
  for (std::size_t c = 0; c < cases.size(); ++c) {
    const double factor = factors(static_cast<Eigen::Index>(c));
    if (factor == 0) continue;
    sum.force += factor * cases[c].force;
    sum.held_displacement += factor * cases[c].held_displacement;
    add(sum.beam_fixed_end, cases[c].beam_fixed_end, factor);
    add(sum.shell_fixed, cases[c].shell_fixed, factor);
    add(sum.node_load, cases[c].node_load, factor);
  }
  return sum;
}

/// In more digits than the answers have: where cases cancel, what is left is right to its own last digit.
Eigen::MatrixXd sums_of(const OnceRefined& cases, const Eigen::MatrixXd& factors, int threads) {
  Eigen::MatrixXd sums(cases.x.rows(), factors.cols());
  parallel_for(factors.cols(), threads, [&](Eigen::Index j) {
    for (Eigen::Index i = 0; i < sums.rows(); ++i) {
      long double sum = 0;
      for (Eigen::Index c = 0; c < factors.rows(); ++c)
        if (const double factor = factors(c, j); factor != 0)
          sum += factor * (static_cast<long double>(cases.x(i, c)) + cases.rest(i, c));
      sums(i, j) = static_cast<double>(sum);
    }
  });
  return sums;
}

/// None where a case by itself acts on what gives way: the sums, in which it may cancel, have to be solved.
std::optional<std::vector<StaticSolution>> add_up(Prepared& prepared, std::span<const LoadSet> cases,
                                                  const Eigen::MatrixXd& factors) {
  ConditionBeside condition(prepared);
  std::vector<StaticSolution> solutions;
  {
    const Stopwatch watch(prepared.statistics.solve_seconds);
    const FrameSystem& system = prepared.system;
    const std::vector<LoadVector> vectors = load_vectors(system, cases);
    for (const LoadVector& vector : vectors)
      if (system.unbalanced_load(vector)) return std::nullopt;
    const int threads = prepared.options.threads;
    std::vector<LoadVector> sums(static_cast<std::size_t>(factors.cols()));
    parallel_for(factors.cols(), threads,
                 [&](Eigen::Index j) { sums[static_cast<std::size_t>(j)] = sum_of(vectors, factors.col(j)); });
    const ExtendedResidual residual(system.matrix(), threads);
    const OnceRefined of_cases = refine_once(residual, prepared.linear_solve(), prepared.right_hand_sides(vectors));
    RefinedSolution refined =
        refine(residual, prepared.linear_solve(), prepared.right_hand_sides(sums), sums_of(of_cases, factors, threads));
    solutions = answers(prepared, std::move(sums), std::move(refined));
  }
  write_condition(prepared, condition, solutions);
  return solutions;
}

}  // namespace

struct StaticAnalysis::State {
  std::unique_ptr<Prepared> prepared;
};

StaticAnalysis::StaticAnalysis(FrameModel model, const AnalysisOptions& options)
    : state_(std::make_unique<State>(State{prepare(std::move(model), options)})) {}
StaticAnalysis::~StaticAnalysis() = default;
StaticAnalysis::StaticAnalysis(StaticAnalysis&&) noexcept = default;
StaticAnalysis& StaticAnalysis::operator=(StaticAnalysis&&) noexcept = default;

std::vector<StaticSolution> StaticAnalysis::solve(std::span<const LoadSet> loads) {
  return solve_each(*state_->prepared, loads);
}

const FrameModel& StaticAnalysis::model() const { return state_->prepared->system.model; }
const AnalysisStatistics& StaticAnalysis::statistics() const { return state_->prepared->statistics; }

namespace {

void require_factors(std::span<const LoadSet> cases, const Eigen::MatrixXd& factors) {
  if (factors.rows() != static_cast<Eigen::Index>(cases.size()))
    throw std::invalid_argument("sums of load cases: " + std::to_string(factors.rows()) + " factors for " +
                                std::to_string(cases.size()) + " cases");
}

CaseSums sums_with(Prepared& prepared, std::span<const LoadSet> cases, const Eigen::MatrixXd& factors) {
  std::optional<std::vector<StaticSolution>> solutions;
  if (!cases.empty() && factors.rows() < factors.cols() && prepared.system.dofs().equations > 0)
    solutions = add_up(prepared, cases, factors);
  if (!solutions) {
    std::vector<LoadSet> sums;
    for (Eigen::Index j = 0; j < factors.cols(); ++j) sums.push_back(sum_of(cases, factors.col(j)));
    solutions = solve_each(prepared, sums);
  }
  return {std::move(*solutions), prepared.statistics};
}

}  // namespace

CaseSums solve_case_sums(FrameModel model, std::span<const LoadSet> cases, const Eigen::MatrixXd& factors,
                         const AnalysisOptions& options) {
  require_factors(cases, factors);
  return sums_with(*prepare(std::move(model), options), cases, factors);
}

struct KeptEquations::State {
  std::unique_ptr<Prepared> prepared;

  /// True where what is kept serves.
  bool prepare_for(FrameModel model, const AnalysisOptions& options) {
    if (prepared && prepare_again(*prepared, model, options)) return true;
    prepared.reset();
    prepared = prepare(std::move(model), options);
    return false;
  }
};

KeptEquations::KeptEquations() : state_(std::make_unique<State>()) {}
KeptEquations::~KeptEquations() = default;

std::vector<StaticSolution> KeptEquations::solve(FrameModel model, std::span<const LoadSet> loads,
                                                 const AnalysisOptions& options, AnalysisStatistics& statistics) {
  reused_ += state_->prepare_for(std::move(model), options) ? 1 : 0;
  std::vector<StaticSolution> solutions = solve_each(*state_->prepared, loads);
  statistics = state_->prepared->statistics;
  return solutions;
}

CaseSums KeptEquations::solve_case_sums(FrameModel model, std::span<const LoadSet> cases,
                                        const Eigen::MatrixXd& factors, const AnalysisOptions& options) {
  require_factors(cases, factors);
  reused_ += state_->prepare_for(std::move(model), options) ? 1 : 0;
  return sums_with(*state_->prepared, cases, factors);
}

}  // namespace topple::solver
