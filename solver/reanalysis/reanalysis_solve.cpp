// The answer by the way that was chosen for a change.
#include <algorithm>
#include <cmath>
#include <utility>

#include "reanalysis/reanalysis_state.h"
#include "reanalysis/update_costs.h"
#include "reanalysis/work_count.h"

namespace topple::solver {
namespace {

/// An answer over a correction that refinement leaves above this is found again over a new factor.
constexpr double acceptable_error = 1e-13;
constexpr int most_refinements = 12;
/// Answers to unit forces weigh blows, which are known far less well.
constexpr double response_error = 1e-11;
/// Over a structure that became this much softer than the factor's one refinement is made.
constexpr double soft = 1e3;
constexpr double worthwhile = 0.5;  ///< a step that does not cut the error to this share of the last one is the last

/// Rows in which v is not zero.
std::vector<int> rows_in(const Eigen::VectorXd& v) {
  std::vector<int> rows;
  for (Eigen::Index row = 0; row < v.size(); ++row)
    if (v(row) != 0) rows.push_back(static_cast<int>(row));
  return rows;
}

}  // namespace

LinearSolve Reanalysis::State::linear_solve() const {
  return [this](Eigen::Ref<Eigen::MatrixXd> b) {
    if (!standing || !standing->changed()) {
      factor->solve(b);
      return;
    }
    Eigen::VectorXd x;
    for (Eigen::Index j = 0; j < b.cols(); ++j) {
      x = b.col(j);
      standing->solve(x);
      b.col(j) = x;
    }
  };
}

double Reanalysis::State::current_condition() const {
  return condition * (standing ? std::max(1.0, standing->softening()) : 1.0);
}

void Reanalysis::State::scale_force(const Eigen::VectorXd& force, Eigen::VectorXd& result) const {
  const Eigen::Index n = system->dofs().equations;
  result = force.head(n).cwiseProduct(Eigen::Map<const Eigen::VectorXd>(system->scale().data(), n));
}

Eigen::VectorXd Reanalysis::State::solve_sparse(const Eigen::VectorXd& force, double& backward_error) const {
  const Eigen::Index n = system->dofs().equations;
  backward_error = 0;
  if (n == 0) return {};
  const Eigen::Map<const Eigen::VectorXd> scale(system->scale().data(), n);
  Eigen::VectorXd right_hand_side;
  scale_force(force, right_hand_side);
  Eigen::VectorXd x;
  if (!standing) {
    const RefinedSolution refined = solve_refined(system->matrix(), linear_solve(), right_hand_side);
    backward_error = refined.quality[0].backward_error;
    x = refined.x.col(0);
    return x.cwiseProduct(scale);
  }
  const std::vector<int> loaded = rows_in(right_hand_side);
  x = right_hand_side;
  standing->solve(x, &loaded);
  return refine_to(response_error, right_hand_side, std::move(x), backward_error).cwiseProduct(scale);
}

Eigen::VectorXd Reanalysis::State::refine_to(double limit, const Eigen::VectorXd& scaled, Eigen::VectorXd x,
                                             double& backward_error) const {
  Eigen::VectorXd r, better;
  backward_error = rows->residual(system->matrix(), scaled, x, r);
  for (int step = 0; step < most_refinements && backward_error > limit; ++step) {
    standing->solve(r);
    better = x + r;
    const double error = rows->residual(system->matrix(), scaled, better, r);
    const bool go_on = error <= worthwhile * backward_error;
    if (error < backward_error) {
      x.swap(better);
      backward_error = error;
    }
    if (!go_on) break;
  }
  return x;
}

/// Rows in which any column is not zero.
std::vector<int> Reanalysis::State::scale_columns(const Eigen::MatrixXd& force, Eigen::MatrixXd& scaled) const {
  const Eigen::Index n = system->dofs().equations;
  const Eigen::Map<const Eigen::VectorXd> scale(system->scale().data(), n);
  scaled = scale.asDiagonal() * force.topRows(n);
  std::vector<int> loaded;
  for (Eigen::Index row = 0; row < n; ++row)
    if ((scaled.row(row).array() != 0).any()) loaded.push_back(static_cast<int>(row));
  return loaded;
}

Eigen::MatrixXd Reanalysis::State::solve_sparse(const Eigen::MatrixXd& force, std::vector<double>& errors) const {
  const Eigen::Index n = system->dofs().equations, count = force.cols();
  errors.assign(static_cast<std::size_t>(count), 0.0);
  Eigen::MatrixXd X(n, count);
  if (!standing || n == 0 || count == 1) {
    for (Eigen::Index j = 0; j < count; ++j)
      X.col(j) = solve_sparse(Eigen::VectorXd(force.col(j)), errors[static_cast<std::size_t>(j)]);
    return X;
  }
  const Eigen::Map<const Eigen::VectorXd> scale(system->scale().data(), n);
  Eigen::MatrixXd scaled;
  const std::vector<int> loaded = scale_columns(force, scaled);
  X = scaled;
  standing->solve(X, loaded);
  for (Eigen::Index j = 0; j < count; ++j)
    X.col(j) =
        refine_to(response_error, scaled.col(j), X.col(j), errors[static_cast<std::size_t>(j)]).cwiseProduct(scale);
  return X;
}

/// On the paths of what is loaded, and of these nodes.
Eigen::MatrixXd Reanalysis::State::solve_on_paths(const Eigen::MatrixXd& force, std::span<const int> nodes,
                                                  std::vector<char>& known) const {
  const Eigen::Index n = system->dofs().equations;
  known.assign(static_cast<std::size_t>(n), 1);
  if (!standing || n == 0) {
    std::vector<double> errors;
    return solve_sparse(force, errors);
  }
  Eigen::MatrixXd X;
  std::vector<int> near = scale_columns(force, X);
  for (const int node : nodes)
    for (const int equation : system->dofs().number[static_cast<std::size_t>(node)])
      if (equation < n) near.push_back(equation);
  standing->solve_on_paths(X, near, known);
  return Eigen::Map<const Eigen::VectorXd>(system->scale().data(), n).asDiagonal() * X;
}

void Reanalysis::State::add_rows_of(const std::vector<int>& nodes) {
  const auto& first = system->dofs().first_equation;
  const auto add_vertex = [&](std::size_t v) {
    for (int e = first[v]; e < first[v + 1]; ++e) rows_to_change.push_back(e);
  };
  for (const int node : nodes) {
    add_vertex(static_cast<std::size_t>(node));
    const int d = system->dofs().diaphragm_of_node[static_cast<std::size_t>(node)];
    if (d >= 0) add_vertex(system->model.nodes.size() + static_cast<std::size_t>(d));
  }
}

/// Rows in which the last answer does not fit any longer; none when they are too many to tell apart.
void Reanalysis::State::find_changed_rows(const Eigen::VectorXd& force) {
  std::vector<int>& changed = rows_to_change;
  changed.clear();
  const std::size_t most = static_cast<std::size_t>(force.size()) / 4;
  add_rows_of(stale_nodes);
  for (Eigen::Index e = 0; e < force.size() && changed.size() <= most; ++e)
    if (force(e) != solved_force(e)) changed.push_back(static_cast<int>(e));
  if (changed.size() > most) changed.clear();
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
}

/// From the last answer on: what does not fit any longer is solved for and added, until the error is at rounding level.
int Reanalysis::State::refine(const Eigen::VectorXd& force) {
  if (take_expected(force)) return answer.quality.refinements;
  const SparseSymmetric& K = system->matrix();
  if (solution.size() != force.size()) {
    solution = Eigen::VectorXd::Zero(force.size());
    correction = force;
    rows_to_change.clear();
  } else {
    if (!eliminated_along) {
      find_changed_rows(force);
      if (rows_to_change.empty()) {
        (void)rows->residual(K, force, solution, correction);
      } else {
        rows->residual(K, force, solution, rows_to_change, correction);
      }
    }
  }
  improve(force, true);
  return 1 + answer.quality.refinements;
}

/// Solves for the residual in `correction`. When few rows are what refinement is for, for these alone: their
/// elimination paths are a part of the factor.
void Reanalysis::State::solve_for_rest(bool first) {
  constexpr double share_of_limit = 0.1;
  if (!first) rows->find_rows_above(share_of_limit * backward_error_limit, correction, rows_off);
  if (first || rows_off.size() > static_cast<std::size_t>(correction.size()) / 16) {
    standing->solve(correction);
    return;
  }
  improved.setZero(correction.size());
  for (const int row : rows_off) improved(row) = correction(row);
  correction.swap(improved);
  standing->solve(correction, &rows_off);
}

/// Solves for the residual in `correction` and adds it, again and again. On the `first` step there is no error known
/// yet, and the residual is that of rows_to_change alone when there are any.
void Reanalysis::State::improve(const Eigen::VectorXd& force, bool first) {
  const SparseSymmetric& K = system->matrix();
  SolveQuality& quality = answer.quality;
  for (int step = 0; step <= most_refinements; ++step) {
    if (first && std::exchange(eliminated_along, false)) {
      standing->solve_along(correction);
    } else if (first && !rows_to_change.empty()) {
      standing->solve(correction, &rows_to_change);
    } else {
      solve_for_rest(first);
    }
    improved = solution + correction;
    const double error = rows->residual(K, force, improved, correction);
    const bool go_on = first || error <= worthwhile * quality.backward_error;
    if (first || error < quality.backward_error) {
      solution.swap(improved);
      quality.backward_error = error;
      if (!first) ++quality.refinements;
    }
    first = false;
    if (!go_on || quality.backward_error <= backward_error_limit) break;
  }
}

bool Reanalysis::State::solve_loads() {
  const Eigen::Index n = system->dofs().equations;
  count_work(nodes_cost(static_cast<double>(displacements.size())));
  scale_force(load.force, scaled_force);
  const Eigen::VectorXd& force = scaled_force;
  if (n == 0) {
    answer.quality = {};
    answer.quality.converged = true;
    system->node_displacements_of_scaled(force, displacements);
    return true;
  }
  const bool as_factorised = standing && !standing->changed();
  complete(nullptr);
  if (selective) selective->forget_uses();
  if ((force.array() == 0).all()) {
    solution = force;
    answer.quality = {};
  } else if (as_factorised && first_solution.size() == n && first_force == force) {
    solution = first_solution;  // back to where the factor was made: the very same answer
    answer.quality = first_quality;
  } else if (!standing) {
    const RefinedSolution refined = solve_refined(system->matrix(), linear_solve(), force);
    solution = refined.x.col(0);
    answer.quality = refined.quality[0];
  } else {
    if (as_factorised && first_solution.size() != n) solution.resize(0);  // a new factor starts anew
    const double passes = refine(force);
    operations += passes * (standing->solve_operations() + 8.0 * static_cast<double>(system->matrix().row.size()));
    if (as_factorised && first_solution.size() != n) {
      first_solution = solution;
      first_force = force;
    }
  }
  solved_force = force;
  stale_nodes.clear();
  loaded_nodes.clear();
  answer.quality.converged = answer.quality.backward_error <= backward_error_limit;
  answer.quality.condition = current_condition();
  answer.quality.error_bound = forward_error_bound(answer.quality.condition, answer.quality.backward_error);
  if (as_factorised && first_force.size() == n && first_force == force) first_quality = answer.quality;
  system->node_displacements_of_scaled(solution, displacements);
  return as_factorised || !standing || answer.quality.backward_error <= acceptable_error;
}

void Reanalysis::State::give_up(const Defect& defect) {
  answer.stable = false;
  answer.mechanism = defect.motion;
}

void Reanalysis::State::apply_changes() {
  touched_nodes.clear();
  apply_supports(touched_nodes);
  apply_dropped_nodes(touched_nodes);
  apply_beams(touched_nodes);
  apply_shells(touched_nodes);
  update_load();
  node_loads_changed = false;
}

const ReanalysisAnswer& Reanalysis::solve() { return state_->solve(nullptr); }

/// From what is to become of the structure to its factor.
void Reanalysis::State::take_changes(UseWatch* watch) {
  effort = {};
  whole_known = false;
  // The uses of the present answer are what a selective one starts from.
  if (watch != nullptr && selective && !selective->uses_known() && answered && answer.stable && structure_stands)
    read_all_uses(*watch);
  watched = watch != nullptr;
  eliminated_along = false;
  apply_changes();
  answered = true;
  const bool nearly_unstable = answer.nearly_unstable;  // a property of the factor, which may stay
  answer = ReanalysisAnswer();
  answer.nearly_unstable = nearly_unstable;
  reactions.clear();
  mechanism.reset();
  const bool same_structure = touched_nodes.empty() && assembled && structure_stands;
  if (same_structure)
    ++counters.load_solves;
  else
    mechanism = update_structure(touched_nodes);
}

bool Reanalysis::State::is_soft() const { return standing->changed() && standing->softening() >= soft; }

void Reanalysis::State::solve_as_it_stands(Eigen::VectorXd& x) {
  if (x.size() == 0) return;
  if (!standing) {
    Eigen::MatrixXd columns = x;
    factor->solve(columns);
    x = columns.col(0);
    return;
  }
  if (!is_soft()) {
    standing->solve(x);
    count_answer(1);
    return;
  }
  const Eigen::VectorXd force = x;
  standing->solve(x);
  (void)rows->residual(system->matrix(), force, x, improved);
  standing->solve(improved);
  x += improved;
  count_answer(2);
}

const ReanalysisAnswer& Reanalysis::State::solve(UseWatch* watch) {
  operations = 0;
  if (!pending()) {
    ++counters.unchanged;
    if (watch != nullptr && answer.stable) read_all_uses(*watch);
    return answer;
  }
  const double before = counted_work();
  take_changes(watch);
  find_answer(watch);
  refresh_paid += counted_work() - before;
  return answer;
}

void Reanalysis::State::find_answer(UseWatch* watch) {
  ++counters.solves;
  if (mechanism) {
    give_up(*std::exchange(mechanism, std::nullopt));
    return;
  }
  if (const auto defect = system->unbalanced_load(load, negligible_lever)) {
    give_up(*defect);
    return;
  }
  if (watch != nullptr && answer_in_part(*watch)) return;
  if (!solve_loads()) {
    if (const auto defect = refactorise()) {
      structure_stands = false;
      give_up(*defect);
      return;
    }
    (void)solve_loads();
  }
  if (watch != nullptr) read_all_uses(*watch);
}

}  // namespace topple::solver
