// How a change is answered: by a low-rank update or by a new factor.
#include <algorithm>

#include "reanalysis/reanalysis_state.h"
#include "reanalysis/update_costs.h"
#include "reanalysis/work_count.h"

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
constexpr int most_columns = 1000;
/// Solves that the estimate of a new factor's condition takes, with the first answer's.
constexpr double solves_with_factor = 12;
/// Operations for each entry of the factor in one solve: where memory sets the pace, and where the factor is in cache.
constexpr double solve_cost = 20, cached_solve_cost = 6;
constexpr double cached_entries = 250000;

/// Of a correction's work that of the columns beyond so many, by themselves.
CorrectionWork added_alone(CorrectionWork work, double before) {
  const double share = std::max(0.0, work.rank - before) / std::max(1.0, work.rank);
  work.rank *= share;
  work.kept = 0;
  for (double* part : {&work.pairs, &work.pair_products, &work.column_entries}) *part *= share;
  return work;
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

std::optional<Defect> Reanalysis::State::update_structure(const std::vector<int>& touched) {
  const bool stood = structure_stands;
  structure_stands = false;
  count_work(changes_cost(static_cast<double>(touched.size())));
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
  tell_standing([&](BaseFactor& one) { one.touch(touched); });
  stale_nodes.insert(stale_nodes.end(), touched.begin(), touched.end());
  if (defect) return defect;
  if (system->dofs().equations == 0) {  // everything is held: nothing to factorise, every answer is exact
    structure_stands = factor_valid = true;
    return std::nullopt;
  }
  go_on_with_refresh();
  // Beyond what a correction can do, a factor that is under way comes sooner than one begun now.
  if (correct_factor(touched, defect) || (!needs_new_factor && switch_now() && correct_factor(touched, defect))) {
    structure_stands = !defect;
    if (structure_stands) begin_refresh_if_due();
    return defect;
  }
  defect = refactorise();
  structure_stands = !defect;
  return defect;
}

/// Where the last answer does not fit what stands now, and by how much. False: it is better found later.
bool Reanalysis::State::know_residual() {
  if (solution.size() != system->dofs().equations || !expected.empty()) return false;
  const bool partial = selective && selective->partial();
  if (partial && !watched) return false;  // the answer is made whole first
  scale_force(load.force, scaled_force);
  find_changed_rows(scaled_force);
  if (rows_to_change.empty()) return false;
  if (selective) {
    add_rows_of(loaded_nodes);
    std::sort(rows_to_change.begin(), rows_to_change.end());
    rows_to_change.erase(std::unique(rows_to_change.begin(), rows_to_change.end()), rows_to_change.end());
  }
  if (partial) (void)selective->begin(rows_to_change, {solution, displacements});
  rows->residual(system->matrix(), scaled_force, solution, rows_to_change, correction);
  return true;
}

void Reanalysis::State::update_correction(bool adds) {
  eliminated_along = adds && know_residual();
  if (eliminated_along) {
    standing->update(rows_to_change, correction);
  } else {
    standing->update();
  }
}

bool Reanalysis::State::correct_factor(const std::vector<int>& touched, std::optional<Defect>& defect) {
  eliminated_along = needs_new_factor = false;
  if (!standing || condition > ill_conditioned) return false;
  const BaseFactor::Plan plan = standing->plan();
  const double anew = predicted_cost(factor_work());
  const auto too_much = [anew](bool possible, const CorrectionWork& work) {
    return !possible || work.rank > most_columns || predicted_cost(work) > anew;
  };
  needs_new_factor = too_much(plan.possible, added_alone(plan.work, standing->rank()));
  if (too_much(plan.possible, plan.work)) return false;
  if (factor_operations() < refresh_rules.least_operations) {
    // What earlier changes go on to cost is borne until it has cost as much as a new factor (to rent or to buy).
    const double carried = carried_cost(plan.work);
    if (carried == 0) correction_paid = 0;
    correction_paid += carried;
    if (correction_paid > anew) return false;
  }
  update_correction(plan.work.places > 0);
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

FactorWork Reanalysis::State::factor_work() const {
  const TriangularSolver& triangles = standing->triangles();
  return {factor->operations(),
          static_cast<double>(triangles.size()),
          {triangles.entries(), static_cast<double>(triangles.blocks())}};
}

double Reanalysis::State::factor_operations() const {
  const auto entries = static_cast<double>(factor->entries());
  return factor->operations() +
         solves_with_factor * (entries < cached_entries ? cached_solve_cost : solve_cost) * entries;
}

std::optional<Defect> Reanalysis::State::refactorise() {
  complete(nullptr);
  drop_refresh();
  factor_valid = eliminated_along = false;
  selective.reset();
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
  operations += factor_operations();
  const Stability stability = factorise_and_judge(*system, *factor, options);
  if (stability.defect) return stability.defect;
  factor_valid = true;
  condition = stability.condition > 0 ? stability.condition : estimate_condition(system->matrix(), linear_solve());
  answer.nearly_unstable = stability.nearly_unstable || 1 / condition < options.warning_limit;
  refresh_failed = answer.nearly_unstable;
  if (!answer.nearly_unstable) {
    standing = std::make_unique<BaseFactor>(*system);
    standing->serve(*factor);
  }
  return std::nullopt;
}

}  // namespace topple::solver
