#include "topple/solver/static_analysis.h"

#include <chrono>
#include <cmath>

#include "factor.h"
#include "frame_system.h"
#include "mechanism.h"
#include "refinement.h"

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

void require_stable(const std::optional<Defect>& defect) {
  if (defect) throw Instability(defect->message, defect->motion);
}

}  // namespace

struct StaticAnalysis::State {
  FrameSystem system;
  AnalysisOptions options;
  AnalysisStatistics statistics;
  Stability stability;
  std::unique_ptr<Factor> factor;

  State(FrameModel model, const AnalysisOptions& given) : system(std::move(model)), options(given) {}
  void assemble();
  void order();
  void factorise();
  void estimate();
  [[nodiscard]] LinearSolve linear_solve() const {
    return [this](Eigen::Ref<Eigen::MatrixXd> b) { factor->solve(b); };
  }
};

void StaticAnalysis::State::assemble() {
  const Stopwatch watch(statistics.assemble_seconds);
  system.assemble();
  statistics.freedoms = static_cast<std::size_t>(system.dofs().equations);
  statistics.matrix_entries = system.matrix().row.size();
}

void StaticAnalysis::State::order() {
  const Stopwatch watch(statistics.order_seconds);
  factor =
      std::make_unique<Factor>(system.matrix(), system.elimination_order(), options.factorisation, options.threads);
  statistics.ordering = "node graph METIS";
  statistics.factorisation = factor->name();
  statistics.factor_entries = factor->entries();
  statistics.factor_operations = factor->operations();
}

void StaticAnalysis::State::factorise() {
  const Stopwatch watch(statistics.factor_seconds);
  stability = factorise_and_judge(system, *factor, options);
  require_stable(stability.defect);
}

void StaticAnalysis::State::estimate() {
  if (stability.condition == 0 && factor) {
    const Stopwatch watch(statistics.condition_seconds);
    judge_condition(options, estimate_condition(system.matrix(), linear_solve()), stability);
  }
  statistics.nearly_unstable = stability.nearly_unstable;
  if (stability.condition > 0) {
    statistics.digits_left = std::clamp(16 - std::log10(stability.condition), 0.0, 16.0);
  }
}

StaticAnalysis::StaticAnalysis(FrameModel model, const AnalysisOptions& options) {
  double map_seconds = 0;  // numbering the freedoms and building the scatter map
  {
    const Stopwatch watch(map_seconds);
    state_ = std::make_unique<State>(std::move(model), options);
  }
  state_->statistics.assemble_seconds = map_seconds;
  state_->assemble();
  require_stable(state_->system.defect());
  if (state_->system.dofs().equations == 0) return;
  state_->order();
  state_->factorise();
}
StaticAnalysis::~StaticAnalysis() = default;
StaticAnalysis::StaticAnalysis(StaticAnalysis&&) noexcept = default;
StaticAnalysis& StaticAnalysis::operator=(StaticAnalysis&&) noexcept = default;

std::vector<StaticSolution> StaticAnalysis::solve(std::span<const LoadSet> loads) {
  State& state = *state_;
  state.estimate();
  const Stopwatch watch(state.statistics.solve_seconds);
  const std::vector<LoadVector> vectors = state.system.load_vectors(loads);
  for (const LoadVector& vector : vectors) require_stable(state.system.unbalanced_load(vector));
  const Eigen::Index n = state.system.dofs().equations;
  const Eigen::Map<const Eigen::VectorXd> scale(state.system.scale().data(), n);
  Eigen::MatrixXd b(n, static_cast<Eigen::Index>(loads.size()));
  for (std::size_t j = 0; j < vectors.size(); ++j)
    b.col(static_cast<Eigen::Index>(j)) = vectors[j].force.head(n).cwiseProduct(scale);
  RefinedSolution refined;
  if (n > 0) {
    refined = solve_refined(state.system.matrix(), state.linear_solve(), b);
  } else {
    refined.x = b;
    refined.quality.resize(loads.size());
  }
  refined.x.array().colwise() *= scale.array();
  std::vector<StaticSolution> solutions = state.system.recover(vectors, refined.x);
  for (std::size_t j = 0; j < loads.size(); ++j) {
    SolveQuality& quality = solutions[j].quality;
    quality = refined.quality[j];
    quality.condition = std::max(state.stability.condition, 1.0);
    quality.error_bound = forward_error_bound(quality.condition, quality.backward_error);
  }
  return solutions;
}

const FrameModel& StaticAnalysis::model() const { return state_->system.model; }
const AnalysisStatistics& StaticAnalysis::statistics() const { return state_->statistics; }

}  // namespace topple::solver
