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
  [[nodiscard]] StaticSolution recover(const LoadVector& load, const Eigen::VectorXd& scaled) const;
};

void StaticAnalysis::State::assemble() {
  const Stopwatch watch(statistics.assemble_seconds);
  system.assemble();
  statistics.freedoms = static_cast<std::size_t>(system.dofs().equations);
  statistics.matrix_entries = system.matrix().row.size();
}

void StaticAnalysis::State::order() {
  const Stopwatch watch(statistics.order_seconds);
  factor = std::make_unique<Factor>(system.matrix(), system.elimination_order(), options.factorisation);
  statistics.ordering = "node graph METIS";
  statistics.factorisation = factor->kind() == Factorisation::supernodal ? "supernodal" : "simplicial";
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

StaticSolution StaticAnalysis::State::recover(const LoadVector& load, const Eigen::VectorXd& scaled) const {
  Eigen::VectorXd u(scaled.size());
  for (Eigen::Index i = 0; i < u.size(); ++i) u(i) = scaled(i) * system.scale()[static_cast<std::size_t>(i)];
  StaticSolution solution;
  solution.displacements = system.node_displacements(u, load.held_displacement);
  const std::size_t beams = system.model.beams.size();
  solution.beam_end_forces.reserve(beams);
  for (std::size_t i = 0; i < beams; ++i) {
    const Vec12 fixed = load.beam_fixed_end.empty() ? Vec12::Zero() : load.beam_fixed_end[i];
    solution.beam_end_forces.push_back(system.end_forces(static_cast<int>(i), solution.displacements, fixed));
  }
  for (std::size_t i = 0; i < system.model.shells.size(); ++i) {
    const Vec24 fixed = load.shell_fixed.empty() ? Vec24::Zero() : load.shell_fixed[i];
    solution.shell_corner_forces.push_back(system.corner_forces(static_cast<int>(i), solution.displacements, fixed));
  }
  solution.reactions =
      system.reactions(solution.displacements, solution.beam_end_forces, solution.shell_corner_forces, load.node_load);
  return solution;
}

std::vector<StaticSolution> StaticAnalysis::solve(std::span<const LoadSet> loads) {
  State& state = *state_;
  state.estimate();
  const Stopwatch watch(state.statistics.solve_seconds);
  std::vector<LoadVector> vectors;
  vectors.reserve(loads.size());
  const Eigen::Index n = state.system.dofs().equations;
  Eigen::MatrixXd b(n, static_cast<Eigen::Index>(loads.size()));
  for (const LoadSet& set : loads) {
    vectors.push_back(state.system.load_vector(set));
    require_stable(state.system.unbalanced_load(vectors.back()));
    const auto j = static_cast<Eigen::Index>(vectors.size()) - 1;
    for (Eigen::Index i = 0; i < n; ++i) {
      b(i, j) = vectors.back().force(i) * state.system.scale()[static_cast<std::size_t>(i)];
    }
  }
  RefinedSolution refined;
  if (n > 0) {
    refined = solve_refined(state.system.matrix(), state.linear_solve(), b);
  } else {
    refined.x = b;
    refined.quality.resize(loads.size());
  }
  std::vector<StaticSolution> solutions;
  solutions.reserve(loads.size());
  for (std::size_t j = 0; j < loads.size(); ++j) {
    solutions.push_back(state.recover(vectors[j], refined.x.col(static_cast<Eigen::Index>(j))));
    SolveQuality& quality = solutions.back().quality;
    quality = refined.quality[j];
    quality.condition = std::max(state.stability.condition, 1.0);
    quality.error_bound = forward_error_bound(quality.condition, quality.backward_error);
  }
  return solutions;
}

const FrameModel& StaticAnalysis::model() const { return state_->system.model; }
const AnalysisStatistics& StaticAnalysis::statistics() const { return state_->statistics; }

}  // namespace topple::solver
