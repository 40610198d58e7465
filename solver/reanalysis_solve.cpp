// The ladder: which rung a change takes, and the answer over it.
#include <algorithm>
#include <cmath>

#include "reanalysis_state.h"

namespace topple::solver {
namespace {

/// A structure that became this much softer than the factor's in one motion may be a mechanism: rounding leaves a
/// singular correction at 1e10 and more.
constexpr double suspicious_softening = 1e7;
/// And from here on it is looked at whether the correction brought it into the warning band.
constexpr double remarkable_softening = 1e3;
/// From one softening to the next: the softest motion is the same, and about as stiff.
constexpr double alike = 1.25;
/// Factors of a matrix of this condition and worse are made anew rather than corrected.
constexpr double ill_conditioned = 1e12;
/// Columns that a correction may have at most.
constexpr int most_columns = 600;
/// An answer over a correction that refinement leaves above this is found again over a new factor.
constexpr double acceptable_error = 1e-12;
constexpr int most_refinements = 12;
/// Answers to unit forces weigh blows, which are known far less well.
constexpr double response_error = 1e-11;
constexpr double worthwhile = 0.5;  ///< a step that does not cut the error to this share of the last one is the last
/// Solves that the estimate of a new factor's condition takes, with the first answer's.
constexpr double solves_with_factor = 12;
/// Operations for each entry of the factor in one solve: where memory sets the pace, and where the factor is in cache.
constexpr double solve_cost = 20, cached_solve_cost = 6;
constexpr double cached_entries = 250000;

/// Rows in which v is not zero.
std::vector<int> rows_in(const Eigen::VectorXd& v) {
  std::vector<int> rows;
  for (Eigen::Index row = 0; row < v.size(); ++row)
    if (v(row) != 0) rows.push_back(static_cast<int>(row));
  return rows;
}

/// v'Kv / v'v.
double rayleigh_quotient(const SparseSymmetric& K, const Eigen::VectorXd& v) {
  double energy = 0;
  for (std::size_t column = 0; column < static_cast<std::size_t>(K.size); ++column) {
    const double vc = v(static_cast<Eigen::Index>(column));
    double sum = K.value[static_cast<std::size_t>(K.start[column])] * vc / 2;
    for (auto k = K.start[column] + 1; k < K.start[column + 1]; ++k)
      sum += K.value[static_cast<std::size_t>(k)] * v(K.row[static_cast<std::size_t>(k)]);
    energy += 2 * vc * sum;
  }
  return energy / v.squaredNorm();
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

std::optional<Defect> Reanalysis::State::update_structure(const std::vector<int>& touched) {
  const bool stood = structure_stands;
  structure_stands = false;
  if (!assembled) {
    system->assemble();
    assembled = true;
  } else if (!touched.empty()) {
    system->reassemble(touched);
  }
  std::optional<Defect> defect;
  if (stood && standing) {
    defect = system->defect(touched);
  } else {
    defect = system->defect();
  }
  tell_standing([&](StandingFactor& one) { one.touch(touched); });
  stale_nodes.insert(stale_nodes.end(), touched.begin(), touched.end());
  if (defect) return defect;
  if (system->dofs().equations == 0) {  // everything is held: nothing to factorise, every answer is exact
    structure_stands = factor_valid = true;
    return std::nullopt;
  }
  if (refresh && refresh_paid >= refresh_due) (void)take_refreshed();
  // Beyond what a correction can do, a factor that is under way comes sooner than one begun now.
  if (correct_factor(touched, defect) || (refresh && take_refreshed() && correct_factor(touched, defect))) {
    structure_stands = !defect;
    if (structure_stands) begin_refresh_if_due();
    return defect;
  }
  defect = refactorise();
  structure_stands = !defect;
  return defect;
}

bool Reanalysis::State::correct_factor(const std::vector<int>& touched, std::optional<Defect>& defect) {
  if (!standing || condition > ill_conditioned) return false;
  const StandingFactor::Plan plan = standing->plan();
  if (!plan.possible || plan.rank > most_columns || plan.operations > factor_operations()) return false;
  if (factor_operations() < refresh_rules.least_operations) {
    // What earlier changes go on to cost is borne until it has cost as much as a new factor (to rent or to buy).
    if (plan.carried == 0) correction_paid = 0;
    correction_paid += plan.carried;
    if (correction_paid > factor_operations()) return false;
  }
  standing->update();
  operations += plan.operations;
  const double softening = standing->softening();
  const bool remarkable = softening > remarkable_softening && softening * condition * options.warning_limit > 1;
  if (!remarkable) {
    answer.nearly_unstable = false;
    looked_at_softening = 0;
  }
  // What was looked at when it was as soft, and is far from a mechanism, need not be looked at again.
  const bool known = softening < suspicious_softening && softening > looked_at_softening / alike &&
                     softening < looked_at_softening * alike;
  if (remarkable && !known) {
    const Eigen::VectorXd motion = standing->softest_motion();
    if (!motion.allFinite() || !(motion.squaredNorm() > 0)) return false;
    const double stiffness = rayleigh_quotient(system->matrix(), motion);
    answer.nearly_unstable = stiffness < options.warning_limit * matrix_norm(system->matrix());
    looked_at_softening = softening;
    if (softening > suspicious_softening) {
      if (!(stiffness < options.singular_limit)) return false;
      defect = motion_defect(*system, motion);
    }
  }
  if (!touched.empty()) ++counters.low_rank;
  return true;
}

double Reanalysis::State::factor_operations() const {
  const auto entries = static_cast<double>(factor->entries());
  return factor->operations() +
         solves_with_factor * (entries < cached_entries ? cached_solve_cost : solve_cost) * entries;
}

std::optional<Defect> Reanalysis::State::refactorise() {
  complete(nullptr);
  drop_refresh();
  factor_valid = false;
  restricted.reset();
  standing.reset();
  correction_paid = looked_at_softening = 0;
  first_solution.resize(0);
  if (!factor) {
    order = system->elimination_order();
    factor = std::make_unique<Factor>(system->matrix(), order, options.factorisation, options.threads);
    rows = std::make_unique<MatrixRows>(system->matrix());
    ++counters.orderings;
  } else {
    ++counters.refactorisations;
  }
  operations += factor->operations();
  const Stability stability = factorise_and_judge(*system, *factor, options);
  if (stability.defect) return stability.defect;
  factor_valid = true;
  condition = stability.condition > 0 ? stability.condition : estimate_condition(system->matrix(), linear_solve());
  answer.nearly_unstable = stability.nearly_unstable || 1 / condition < options.warning_limit;
  refresh_failed = answer.nearly_unstable;
  if (!answer.nearly_unstable) {
    standing = std::make_unique<StandingFactor>(*system);
    standing->serve(*factor);
  }
  return std::nullopt;
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
  Eigen::VectorXd r, better;
  backward_error = rows->residual(system->matrix(), right_hand_side, x, r);
  for (int step = 0; step < most_refinements && backward_error > response_error; ++step) {
    standing->solve(r);
    better = x + r;
    const double error = rows->residual(system->matrix(), right_hand_side, better, r);
    const bool go_on = error <= worthwhile * backward_error;
    if (error < backward_error) {
      x.swap(better);
      backward_error = error;
    }
    if (!go_on) break;
  }
  return x.cwiseProduct(scale);
}

Eigen::VectorXd Reanalysis::State::solve_on_paths(const Eigen::VectorXd& force, std::vector<char>& known) const {
  const Eigen::Index n = system->dofs().equations;
  known.assign(static_cast<std::size_t>(n), 1);
  if (n == 0) return {};
  if (!standing) {
    double backward_error = 0;
    return solve_sparse(force, backward_error);
  }
  Eigen::VectorXd x;
  scale_force(force, x);
  standing->solve_on_paths(x, rows_in(x), known);
  return x.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(system->scale().data(), n));
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
    find_changed_rows(force);
    if (rows_to_change.empty()) {
      (void)rows->residual(K, force, solution, correction);
    } else {
      rows->residual(K, force, solution, rows_to_change, correction);
    }
  }
  improve(force, true);
  return 1 + answer.quality.refinements;
}

/// Solves for the residual in `correction` and adds it, again and again. On the `first` step there is no error known
/// yet, and the residual is that of rows_to_change alone when there are any.
void Reanalysis::State::improve(const Eigen::VectorXd& force, bool first) {
  const SparseSymmetric& K = system->matrix();
  SolveQuality& quality = answer.quality;
  for (int step = 0; step <= most_refinements; ++step) {
    if (first && !rows_to_change.empty()) {
      standing->solve(correction, &rows_to_change);
    } else {
      standing->solve(correction);
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
  if (restricted) restricted->forget_uses();
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

const ReanalysisAnswer& Reanalysis::State::solve(UseWatch* watch) {
  refresh_paid += operations;
  operations = 0;
  if (!pending()) {
    ++counters.unchanged;
    if (watch != nullptr && answer.stable) read_all_uses(*watch);
    return answer;
  }
  effort = {};
  // The uses of the present answer are what a restricted one starts from.
  if (watch != nullptr && restricted && !restricted->uses_known() && answered && answer.stable && structure_stands)
    read_all_uses(*watch);
  apply_changes();
  answered = true;
  const bool nearly_unstable = answer.nearly_unstable;  // a property of the factor, which may stay
  answer = ReanalysisAnswer();
  answer.nearly_unstable = nearly_unstable;
  reactions.clear();
  ++counters.solves;
  if (!touched_nodes.empty() || !assembled || !structure_stands) {
    if (const auto defect = update_structure(touched_nodes)) {
      give_up(*defect);
      return answer;
    }
  } else {
    ++counters.load_solves;
  }
  if (const auto defect = system->unbalanced_load(load, negligible_lever)) {
    give_up(*defect);
    return answer;
  }
  if (watch != nullptr && answer_in_part(*watch)) return answer;
  if (!solve_loads()) {
    if (const auto defect = refactorise()) {
      structure_stands = false;
      give_up(*defect);
      return answer;
    }
    (void)solve_loads();
  }
  if (watch != nullptr) read_all_uses(*watch);
  return answer;
}

}  // namespace topple::solver
