// What a base factor would have to correct, and what that costs.
#include <algorithm>

#include "reanalysis/base_factor.h"

namespace topple::solver {
namespace {

/// Operations that one entry of the factor costs in a triangular solve of one column, where memory sets the pace, and
/// for each further column; and those of a small dense solver, which runs at a fraction of the factorisation's rate.
constexpr double shared_entry_cost = 10, path_product_cost = 3, dense_operation_cost = 2;
/// For each entry of the small dense solver, whose condition is estimated by a few solves.
constexpr double condition_cost = 20;
/// For each row that two columns share on their paths, when their product is made.
constexpr double pair_product_cost = 3;

double operations_of(const CorrectionWork& work) {
  return path_product_cost * work.path_products + pair_product_cost * work.pair_products +
         shared_entry_cost * work.shared_entries +
         dense_operation_cost * (work.rank * work.rank * work.rank - work.kept * work.kept * work.kept) +
         condition_cost * work.rank * work.rank;
}

}  // namespace

BaseFactor::Plan BaseFactor::plan() {
  Plan plan;
  if (!changes_.compare()) return plan;
  plan.possible = true;
  CorrectionWork& work = plan.work;
  std::vector<int> new_rows;
  double before = 0;  // active places so far
  for (const auto& [place, change] : changes_.all()) {
    if (!change.active()) continue;
    const auto columns = static_cast<double>(change.D.cols());
    plan.rank += static_cast<int>(columns);
    ++before;
    if (number_.contains(place)) continue;
    const ElementModes& m = planned_.try_emplace(place, changes_.modes(place)).first->second;
    const EliminationPath path = solver_->path(m.rows);
    ++work.places;
    work.path_blocks += static_cast<double>(path.block.size());
    work.path_products += columns * solver_->entries(path);
    work.pairs += before;
    work.pair_products += columns * path.rows() * plan.rank;
    work.column_entries += columns * path.rows();
    new_rows.insert(new_rows.end(), m.rows.begin(), m.rows.end());
  }
  // Blocks that several paths share are read once.
  if (work.places > 0) work.shared_entries = solver_->entries_on_paths(new_rows, marked_);
  work.column_entries += correction_->entries();
  work.rank = plan.rank;
  work.kept = correction_->active_rank();
  for (const auto& [place, number] : number_)
    if (!changes_.extracted(place)) work.kept = std::min<double>(work.kept, correction_->rank_before(number));
  work.kept = std::min(work.kept, work.rank);
  work.solve = {solver_->entries(), static_cast<double>(solver_->blocks())};
  plan.operations = operations_of(work) + solve_operations();
  return plan;
}

}  // namespace topple::solver
