#pragma once
// What a low-rank update and a new factor cost, predicted from counts: the choice between them is by these, and the
// same on every machine. bench_update_or_refactor prints the counts beside measured times.

namespace topple::solver {

/// One forward and backward solve with a factor in blocks.
struct SolveWork {
  double entries = 0, blocks = 0;
};

/// A new factor with the estimate of its condition, taken into service, and one answer.
struct FactorWork {
  double operations = 0;  ///< of the elimination (squares of its columns' lengths)
  double freedoms = 0;
  SolveWork solve;
};

/// A low-rank correction brought up to date, and one answer over it.
struct CorrectionWork {
  double places = 0;          ///< elements changed for the first time
  double path_blocks = 0;     ///< on the paths of all of these
  double path_products = 0;   ///< entries of the blocks on each path, for each of its columns
  double shared_entries = 0;  ///< entries of the blocks on any of the paths
  double pairs = 0;           ///< of places whose columns are multiplied
  double pair_products = 0;   ///< rows of both, for each pair of columns
  double rank = 0, kept = 0;  ///< columns of the small dense matrix, of its part whose factor stays
  double column_entries = 0;  ///< of all columns, new ones included
  SolveWork solve;
};

/// Nanoseconds on the machine that the constants were measured on; only ratios count.
[[nodiscard]] double predicted_cost(const SolveWork& work);
/// Of one pass of a triangular solve, forward or backward: for each entry of a block, for each entry and further
/// column, for each block.
struct PassCost {
  double entry, further, block;
};
[[nodiscard]] PassCost pass_cost(double factor_entries);
/// Of a small dense matrix's factor, as far as it is new, and the estimate of its condition.
[[nodiscard]] double dense_cost(double rank, double kept);
/// Of the products of columns' entries, each with each.
[[nodiscard]] double product_cost(double products);
/// Of columns gone through twice and a small dense solve between, to correct one answer.
[[nodiscard]] double columns_cost(double column_entries, double rank, double places);
/// Of taking over what changed at so many nodes, before anything is solved for.
[[nodiscard]] double changes_cost(double nodes);
/// Of displacements of so many nodes from an answer.
[[nodiscard]] double nodes_cost(double nodes);
/// Of one product of a matrix (its lower entries) and a vector, with the sizes that a backward error takes.
[[nodiscard]] double residual_cost(double entries);
[[nodiscard]] double predicted_cost(const FactorWork& work);
[[nodiscard]] double predicted_cost(const CorrectionWork& work);
/// Of it what changes from before go on to cost, which a new factor would have in it.
[[nodiscard]] double carried_cost(const CorrectionWork& work);

}  // namespace topple::solver
