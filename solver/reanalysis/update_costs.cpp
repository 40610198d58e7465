#include "reanalysis/update_costs.h"

namespace topple::solver {
namespace {

// Nanoseconds, each for one of what it is named after.
constexpr double factor_start = 5000, factor_operation = 0.03, factor_block = 900, factor_freedom = 150;
/// Solves that the estimate of a new factor's condition takes, with the first answer's.
constexpr double solves_with_factor = 9;
constexpr double solve_block = 130, cached_entry = 0.35, distant_entry = 1.0;
/// Factors of more entries than this come from beyond the second cache.
constexpr double cached_entries = 600000;
constexpr double place = 9000, path_block = 300, path_product = 0.06;
constexpr double pair = 300, pair_product = 0.12;
constexpr double dense_start = 3000, dense_square = 14, dense_cube = 0.06;
constexpr double column_entry = 0.4;

double entry_cost(const SolveWork& work) { return work.entries < cached_entries ? cached_entry : distant_entry; }

constexpr double residual_entry = 1.0, dense_entry = 1.0;
constexpr double changes_start = 40000, changed_node = 15000;
constexpr double answer_start = 25000, answered_node = 100, answered_place = 400;

}  // namespace

double dense_cost(double rank, double kept) {
  if (rank == kept) return 0;
  return dense_start + dense_square * rank * rank + dense_cube * (rank * rank * rank - kept * kept * kept);
}

PassCost pass_cost(double factor_entries) {
  return {entry_cost({factor_entries, 0}) / 2, path_product, solve_block / 2};
}
double product_cost(double products) { return pair_product * products; }
double columns_cost(double column_entries, double rank, double places) {
  return column_entry * column_entries + dense_entry * rank * rank + answered_place * places;
}
double changes_cost(double nodes) { return changes_start + changed_node * nodes; }
double nodes_cost(double nodes) { return answer_start + answered_node * nodes; }
double residual_cost(double entries) { return residual_entry * entries; }

double predicted_cost(const SolveWork& work) { return entry_cost(work) * work.entries + solve_block * work.blocks; }

double predicted_cost(const FactorWork& work) {
  return factor_start + factor_operation * work.operations + factor_block * work.solve.blocks +
         factor_freedom * work.freedoms + solves_with_factor * predicted_cost(work.solve);
}

double predicted_cost(const CorrectionWork& work) {
  return place * work.places + path_block * work.path_blocks + path_product * work.path_products +
         entry_cost(work.solve) / 2 * work.shared_entries + pair * work.pairs + pair_product * work.pair_products +
         dense_cost(work.rank, work.kept) + column_entry * work.column_entries + predicted_cost(work.solve);
}

double carried_cost(const CorrectionWork& work) {
  if (!(work.kept > 0)) return 0;
  return dense_cost(work.rank, work.kept) - dense_cost(work.rank - work.kept, 0) +
         column_entry * work.column_entries * work.kept / work.rank;
}

}  // namespace topple::solver
