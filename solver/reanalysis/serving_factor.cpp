#include "reanalysis/serving_factor.h"

#include <algorithm>
#include <utility>

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
constexpr double condition_solves = 12;
/// Operations for each entry of the factor in one solve: where memory sets the pace, and where the factor is in cache.
constexpr double solve_cost = 20, cached_solve_cost = 6;
constexpr double entries_in_cache = 250000;

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

Stability ServingFactor::make(ReanalysisWork& work) {
  base_.reset();
  correction_paid_ = looked_at_softening_ = 0;
  if (!factor_) {
    order_ = system_.elimination_order();
    factor_ = std::make_unique<Factor>(system_.matrix(), order_, options_.factorisation, options_.threads);
    rows_ = std::make_unique<MatrixRows>(system_.matrix());
    ++work.counters.orderings;
  } else {
    ++work.counters.refactorisations;
  }
  work.operations += operations();
  values_ = system_.matrix().value;
  Stability verdict = factorise_and_judge(system_, *factor_, options_);
  if (verdict.defect) return verdict;
  condition_ = verdict.condition > 0 ? verdict.condition : estimate_condition(system_.matrix(), linear_solve());
  verdict.nearly_unstable = verdict.nearly_unstable || 1 / condition_ < options_.warning_limit;
  if (!verdict.nearly_unstable) {
    base_ = std::make_unique<BaseFactor>(system_);
    base_->install(*factor_);
  }
  return verdict;
}

FactorRefresh::Made ServingFactor::replace(FactorRefresh::Made made) {
  std::swap(factor_, made.factor);
  std::swap(base_, made.base);
  std::swap(condition_, made.condition);
  std::swap(values_, made.values);
  correction_paid_ = looked_at_softening_ = 0;
  return made;
}

ServingFactor::Choice ServingFactor::choose(const RefreshRules& rules) {
  Choice choice;
  if (!base_ || condition_ > ill_conditioned) return choice;
  choice.plan = base_->plan();
  const double anew = cost();
  const auto too_much = [&](const CorrectionWork& work) {
    return !choice.plan.possible || work.rank > most_columns || predicted_cost(work) > anew;
  };
  choice.last_alone_too_much = too_much(added_alone(choice.plan.work, base_->rank()));
  if (too_much(choice.plan.work)) return choice;
  if (operations() < rules.least_operations) {
    // What earlier changes go on to cost is borne until it has cost as much as a new factor (to rent or to buy).
    const double carried = carried_cost(choice.plan.work);
    if (carried == 0) correction_paid_ = 0;
    correction_paid_ += carried;
    if (correction_paid_ > anew) return choice;
  }
  choice.correction = true;
  return choice;
}

bool ServingFactor::judge_correction(Stability& verdict) {
  const double softening = base_->softening();
  const bool remarkable = softening > remarkable_softening && softening * condition_ * options_.warning_limit > 1;
  if (!remarkable) {
    verdict.nearly_unstable = false;
    looked_at_softening_ = 0;
  }
  // What was looked at when it was as soft, and is far from a mechanism, need not be looked at again.
  const bool known = softening < suspicious_softening && softening > looked_at_softening_ / alike &&
                     softening < looked_at_softening_ * alike;
  if (!remarkable || known) return true;
  const Eigen::VectorXd motion = base_->softest_motion();
  if (!motion.allFinite() || !(motion.squaredNorm() > 0)) return false;
  const double stiffness = rayleigh_quotient(system_.matrix(), motion);
  verdict.nearly_unstable = stiffness < options_.warning_limit * matrix_norm(system_.matrix());
  looked_at_softening_ = softening;
  if (softening > suspicious_softening) {
    if (!(stiffness < options_.singular_limit)) return false;
    verdict.defect = motion_defect(system_, motion);
  }
  return true;
}

double ServingFactor::condition() const { return condition_ * (base_ ? std::max(1.0, base_->softening()) : 1.0); }

FactorWork ServingFactor::factor_work() const {
  const TriangularSolver& triangles = base_->triangles();
  return {factor_->operations(),
          static_cast<double>(triangles.size()),
          {triangles.entries(), static_cast<double>(triangles.blocks())}};
}

double ServingFactor::operations() const {
  const auto entries = static_cast<double>(factor_->entries());
  return factor_->operations() +
         condition_solves * (entries < entries_in_cache ? cached_solve_cost : solve_cost) * entries;
}

}  // namespace topple::solver
